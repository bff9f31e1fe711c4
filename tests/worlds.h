// worlds.h — small scenes built by hand, for tests of what light does in them.

#ifndef WORLDS_H
#define WORLDS_H

#include "bvh.h"
#include "path_naive.h"
#include "render.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

// Room for what a test builds; no test needs more.
enum { WORLD_VERTICES = 200000, WORLD_TRIANGLES = 200000, WORLD_MATERIALS = 8 };

// Triangles with a normal of their own at every vertex or none at all.
typedef struct world {
  arena mem;
  scene scene;
  material materials[WORLD_MATERIALS];
  light lights[4];
  bvh tree;
  path_world path;
} world;

static inline long shortened(long n) {
  return getenv("FACET_QUICK") != NULL ? (n / 50 > 1 ? n / 50 : 1) : n;
}

static inline material world_material(material_kind kind, vec3 kd, vec3 ks) {
  return (material){
      .name = "test", .kind = kind, .kd = kd, .ks = ks, .d = 1, .ni = 1.5f};
}

// Empty and dark; the caller fills what it wants before world_ready.
static inline world *world_new(void) {
  world *w = calloc(1, sizeof *w);
  mesh *m = &w->scene.mesh;
  m->positions = ARENA_NEW(&w->mem, vec3, WORLD_VERTICES);
  m->normals = ARENA_NEW(&w->mem, vec3, WORLD_VERTICES);
  m->position_index = ARENA_NEW(&w->mem, uint32_t, 3 * WORLD_TRIANGLES);
  m->normal_index = ARENA_NEW(&w->mem, uint32_t, 3 * WORLD_TRIANGLES);
  w->scene.material_of = ARENA_NEW(&w->mem, uint32_t, WORLD_TRIANGLES);
  w->scene.materials = w->materials;
  w->scene.lights = w->lights;
  w->scene.env = (env){.kind = ENV_NONE, .scale = 1};
  return w;
}

static inline uint32_t world_vertex(world *w, vec3 p) {
  mesh *m = &w->scene.mesh;
  assert_true(m->position_count < WORLD_VERTICES);
  m->positions[m->position_count] = p;
  return (uint32_t)m->position_count++;
}

// Counter-clockwise seen from the front; flat.
static inline void world_triangle(world *w, const uint32_t v[3], uint32_t of) {
  mesh *m = &w->scene.mesh;
  assert_true(m->triangle_count < WORLD_TRIANGLES);
  for (size_t i = 0; i < 3; i++) {
    m->position_index[3 * m->triangle_count + i] = v[i];
    m->normal_index[3 * m->triangle_count + i] = MESH_NONE;
  }
  w->scene.material_of[m->triangle_count++] = of;
}

// The parallelogram p, p + u, p + u + v, p + v; front along u x v.
static inline void world_quad(world *w, vec3 p, vec3 u, vec3 v, uint32_t of) {
  uint32_t a = world_vertex(w, p), b = world_vertex(w, vec3_add(p, u));
  uint32_t c = world_vertex(w, vec3_add(vec3_add(p, u), v));
  uint32_t d = world_vertex(w, vec3_add(p, v));
  world_triangle(w, (uint32_t[]){a, b, c}, of);
  world_triangle(w, (uint32_t[]){a, c, d}, of);
}

// A box; its faces look out, or in.
static inline void world_box(world *w, vec3 lo, vec3 hi, bool in, uint32_t of) {
  vec3 d = vec3_sub(hi, lo), x = {d.x, 0, 0}, y = {0, d.y, 0}, z = {0, 0, d.z};
  vec3 from[6] = {lo, vec3_add(lo, x), lo, vec3_add(lo, y),
                  lo, vec3_add(lo, z)};
  vec3 u[6] = {z, y, x, z, y, x}, v[6] = {y, z, z, x, x, y};
  for (int i = 0; i < 6; i++)
    world_quad(w, from[i], in ? v[i] : u[i], in ? u[i] : v[i], of);
}

// The point of the unit sphere above step (x, y) of n on the face abc.  Equal
// points of neighbouring faces are equal to the bit: two terms are not 0.
static inline vec3 world_on_face(const vec3 abc[3], int n, int x, int y) {
  double z = n - x - y;
  const vec3 *a = &abc[0], *b = &abc[1], *c = &abc[2];
  vec3 p = {(float)((double)a->x * z + (double)b->x * x + (double)c->x * y),
            (float)((double)a->y * z + (double)b->y * x + (double)c->y * y),
            (float)((double)a->z * z + (double)b->z * x + (double)c->z * y)};
  return vec3_unit(p);
}

// An icosphere of 20 * 4^level triangles with front outside; `smooth` gives it
// the sphere's normals.
static inline void world_ball(world *w, vec3 center, float radius, int level,
                              bool smooth, uint32_t of) {
  mesh *m = &w->scene.mesh;
  size_t first = m->triangle_count;
  static const uint32_t face[20][3] = {
      {0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
      {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
      {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
      {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  const float g = 1.618034f;
  const vec3 corner[12] = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                           {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                           {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  const int n = 1 << level;
  for (int f = 0; f < 20; f++) {
    const vec3 abc[3] = {corner[face[f][0]], corner[face[f][1]],
                         corner[face[f][2]]};
    for (int i = 0; i < n; i++)
      for (int k = 0; k < n - i; k++) {
        uint32_t v[4];
        for (int q = 0; q < 4; q++) {
          int y = i + q / 2, x = k + q % 2;
          vec3 p = world_on_face(abc, n, x, y);
          v[q] = world_vertex(w, vec3_mad(center, radius, p));
          m->normals[v[q]] = p;
        }
        world_triangle(w, (uint32_t[]){v[0], v[1], v[2]}, of);
        if (k < n - i - 1)
          world_triangle(w, (uint32_t[]){v[1], v[3], v[2]}, of);
      }
  }
  for (size_t t = first; t < m->triangle_count && smooth; t++)
    for (size_t i = 3 * t; i < 3 * t + 3; i++)
      m->normal_index[i] = m->position_index[i];
}

// Build the tree; everything in w->materials and w->lights is in force.
static inline void world_ready(world *w, size_t lights) {
  scene *s = &w->scene;
  s->material_count = WORLD_MATERIALS;
  s->light_count = lights;
  s->mesh.normal_count = s->mesh.position_count;
  mesh_bounds(&s->mesh, &s->lo, &s->hi);
  bvh_build(&w->tree, s->mesh.positions, s->mesh.position_index,
            (uint32_t)s->mesh.triangle_count, BVH_SAH, &w->mem, NULL);
  w->path = (path_world){
      .scene = s, .tracer = bvh_tracer(&w->tree), .lights = lights > 0};
  w->path.dfg = matter_table(s, PBR_GGX, &w->mem, NULL);
}

static inline void world_free(world *w) {
  arena_free(&w->mem);
  free(w);
}

// Mean of the red channel of n samples along one ray, and the standard error
// of that mean.
typedef struct estimate {
  double mean, error;
} estimate;

static inline estimate world_radiance(const world *w, ray r, long n,
                                      uint64_t seed) {
  double sum = 0, sum2 = 0;
  path_stats stats = {0};
  for (long i = 0; i < n; i++) {
    rng random = rng_of(seed, 0, (uint64_t)i);
    double x = (double)path_naive_radiance(&w->path, r, &random, &stats).x;
    sum += x;
    sum2 += x * x;
  }
  double mean = sum / (double)n;
  double variance = fmax(sum2 / (double)n - mean * mean, 0);
  return (estimate){mean, sqrt(variance / (double)n)};
}

// Share of the hemisphere's projected solid angle of the rectangle a x b at
// height h with a corner straight above.
static inline double corner_factor(double a, double b, double h) {
  double x = a / h, y = b / h, p = sqrt(1 + x * x), q = sqrt(1 + y * y);
  return (x / p * atan(y / p) + y / q * atan(x / q)) / (2 * 3.141592653589793);
}

static inline camera_view world_view(vec3 eye, vec3 target, float fov, int w,
                                     int h) {
  camera c = {.eye = eye, .target = target, .up = {0, 1, 0}, .fov_deg = fov};
  camera_view v;
  error err;
  assert_true(camera_view_of(&v, &c, w, h, &err));
  return v;
}

#endif
