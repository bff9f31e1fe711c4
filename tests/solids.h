// solids.h — closed meshes by formula, for tests and pictures of surfaces.

#ifndef SOLIDS_H
#define SOLIDS_H

#include "bvh.h"
#include "scene.h"

// A mesh whose normals, one per position, may be left out of the scene.
typedef struct solid {
  vec3 *p, *n;
  uint32_t *index;
  uint32_t vertices, triangles;
} solid;

// Room for an icosphere of the level, the largest solid here.
static inline solid solid_new(arena *mem, int level) {
  uint32_t triangles = 20u << (2 * level);
  return (solid){.p = ARENA_NEW(mem, vec3, triangles / 2 + 2),
                 .n = ARENA_NEW(mem, vec3, triangles / 2 + 2),
                 .index = ARENA_NEW(mem, uint32_t, 3 * triangles)};
}

static inline uint32_t solid_vertex(solid *s, vec3 p) {
  s->p[s->vertices] = p;
  s->n[s->vertices] = vec3_unit(p);
  return s->vertices++;
}

static inline void solid_triangle(solid *s, uint32_t a, uint32_t b,
                                  uint32_t c) {
  uint32_t *i = s->index + 3 * (size_t)s->triangles++;
  i[0] = a;
  i[1] = b;
  i[2] = c;
}

// The convex hull of n points whose faces are all triangles, by trying every
// triple; counter-clockwise from outside, which is away from the origin.
static inline solid solid_hull(arena *mem, int level, const vec3 *p,
                               uint32_t n) {
  solid s = solid_new(mem, level);
  for (uint32_t i = 0; i < n; i++)
    solid_vertex(&s, p[i]);
  for (uint32_t a = 0; a < n; a++)
    for (uint32_t b = 0; b < n; b++)
      for (uint32_t c = 0; c < n; c++) {
        if (a >= b || a >= c || b == c) continue;
        vec3 m = vec3_cross(vec3_sub(p[b], p[a]), vec3_sub(p[c], p[a]));
        bool outside = vec3_dot(m, m) > 0;
        for (uint32_t k = 0; k < n; k++)
          outside = outside && vec3_dot(m, vec3_sub(p[k], p[a])) < 1e-3f;
        if (outside) solid_triangle(&s, a, b, c);
      }
  return s;
}

static inline solid solid_tetrahedron(arena *mem) {
  const vec3 p[4] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  return solid_hull(mem, 0, p, 4);
}

// The corners are (+-1, +-1, +-1), the normals there point along them.
static inline solid solid_cube(arena *mem) {
  static const uint32_t face[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                      {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  solid s = solid_new(mem, 0);
  for (int i = 0; i < 8; i++)
    solid_vertex(&s, (vec3){i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1});
  for (int f = 0; f < 6; f++) {
    solid_triangle(&s, face[f][0], face[f][1], face[f][2]);
    solid_triangle(&s, face[f][0], face[f][2], face[f][3]);
  }
  return s;
}

// The vertex halfway between a and b, pushed out to the unit sphere: the one
// that is there already, or a new one.
static inline uint32_t solid_midpoint(solid *s, uint32_t a, uint32_t b,
                                      uint32_t *seen) {
  vec3 m = vec3_unit(vec3_add(s->p[a], s->p[b]));
  uint32_t lo = a < b ? a : b, hi = a < b ? b : a;
  // Each vertex has at most 6 neighbours, so at most 6 edges begin at it.
  for (uint32_t *e = seen + 12 * (size_t)lo; e < seen + 12 * (size_t)lo + 12;
       e += 2) {
    if (e[1] != 0 && e[0] == hi) return e[1];
    if (e[1] != 0) continue;
    e[0] = hi;
    e[1] = solid_vertex(s, m);
    return e[1];
  }
  return 0;
}

// An icosahedron whose triangles are cut into four `level` times, as modelling
// programs do it: 20 * 4^level triangles.
static inline solid solid_icosphere(arena *mem, int level) {
  const float g = 1.618034f;
  vec3 p[12];
  for (uint32_t i = 0; i < 4; i++) {
    float u = i & 1 ? 1 : -1, v = i & 2 ? g : -g;
    p[3 * i] = vec3_unit((vec3){0, u, v});
    p[3 * i + 1] = vec3_unit((vec3){u, v, 0});
    p[3 * i + 2] = vec3_unit((vec3){v, 0, u});
  }
  solid s = solid_hull(mem, level, p, 12);
  for (int l = 0; l < level; l++) {
    uint32_t old = s.triangles;
    uint32_t *from = ARENA_NEW(mem, uint32_t, 3 * (size_t)old);
    uint32_t *seen = ARENA_NEW(mem, uint32_t, 12 * (size_t)s.vertices);
    for (uint32_t i = 0; i < 3 * old; i++)
      from[i] = s.index[i];
    s.triangles = 0;
    for (uint32_t t = 0; t < old; t++) {
      const uint32_t *v = from + 3 * (size_t)t;
      uint32_t ab = solid_midpoint(&s, v[0], v[1], seen);
      uint32_t bc = solid_midpoint(&s, v[1], v[2], seen);
      uint32_t ca = solid_midpoint(&s, v[2], v[0], seen);
      solid_triangle(&s, v[0], ab, ca);
      solid_triangle(&s, ab, v[1], bc);
      solid_triangle(&s, ca, bc, v[2]);
      solid_triangle(&s, ab, bc, ca);
    }
  }
  return s;
}

// Turn the solid by a fixed odd rotation, then scale it and move it.
static inline void solid_turn(solid *s) {
  const vec3 x = {0.48f, 0.6f, 0.64f}, y = {-0.8f, 0.6f, 0.0376f};
  vec3 z = vec3_unit(vec3_cross(x, y));
  vec3 u = vec3_cross(y, z), v = vec3_unit(y);
  u = vec3_unit(u);
  for (uint32_t i = 0; i < s->vertices; i++) {
    vec3 p = s->p[i], n = s->n[i];
    s->p[i] = vec3_mad(vec3_mad(vec3_scale(u, p.x), p.y, v), p.z, z);
    s->n[i] = vec3_mad(vec3_mad(vec3_scale(u, n.x), n.y, v), n.z, z);
  }
}

static inline void solid_place(solid *s, float scale, vec3 at) {
  for (uint32_t i = 0; i < s->vertices; i++)
    s->p[i] = vec3_mad(at, scale, s->p[i]);
}

// A scene of this solid alone, without materials.
static inline scene solid_scene(const solid *s, bool smooth) {
  scene w = {.env = {.kind = ENV_SKY, .scale = 1}};
  w.mesh = (mesh){.positions = s->p,
                  .position_count = s->vertices,
                  .position_index = s->index,
                  .triangle_count = s->triangles};
  if (!smooth) return w;
  w.mesh.normals = s->n;
  w.mesh.normal_count = s->vertices;
  w.mesh.normal_index = s->index;
  return w;
}

static inline bvh solid_tree(const solid *s, arena *mem) {
  bvh tree;
  bvh_build(&tree, s->p, s->index, s->triangles, BVH_SAH, mem, NULL);
  return tree;
}

#endif
