// groves.h — meshes with their trees and rays at them, for tests that compare
// what finds triangles.

#ifndef GROVES_H
#define GROVES_H

#include "bvh.h"
#include "num.h"
#include "shapes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static inline shape shape_one(arena *mem) {
  shape s = shape_new(mem, "one", 3, 1);
  shape_three(&s, (vec3){0, 0, 0}, (vec3){1, 0, 0.5f}, (vec3){0, 1, 0.25f});
  return s;
}

static inline shape shape_quad(arena *mem) {
  shape s = shape_new(mem, "two", 4, 2);
  for (int i = 0; i < 4; i++)
    shape_vertex(&s, (vec3){i & 1 ? 1 : -1, i & 2 ? 1 : -1, 0});
  shape_triangle(&s, 0, 1, 2);
  shape_triangle(&s, 3, 2, 1);
  return s;
}

// Triangles about one centre, so that no cut tells them apart.
static inline shape shape_concentric(arena *mem) {
  shape s = shape_new(mem, "concentric", 900, 300);
  for (int i = 0; i < 300; i++) {
    float r = 0.01f * (float)(i + 1);
    shape_three(&s, (vec3){-r, -r, -r}, (vec3){r, r, i & 1 ? r : -r},
                (vec3){-r, i & 2 ? r : 0, r});
  }
  return s;
}

static inline shape shape_soup(arena *mem, uint32_t n, float size) {
  shape s = shape_new(mem, "soup", 3 * n, n);
  uint64_t state = 11;
  for (uint32_t i = 0; i < n; i++) {
    vec3 p = shape_point(&state);
    vec3 a = vec3_mad(p, size, shape_point(&state));
    shape_three(&s, p, a, vec3_mad(p, size, shape_point(&state)));
  }
  return s;
}

// Cubes of 12 triangles in a grid, side by side: many coplanar faces, and
// every face plane is a face of boxes.
static inline shape shape_cubes(arena *mem, int n) {
  shape s = shape_new(mem, "cubes", 8 * (uint32_t)(n * n * n),
                      12 * (uint32_t)(n * n * n));
  static const uint32_t faces[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6,
                                     0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7,
                                     0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  for (int c = 0; c < n * n * n; c++) {
    vec3 o = {(float)(c % n), (float)(c / n % n), (float)(c / n / n)};
    uint32_t first = s.vertices;
    for (int k = 0; k < 8; k++)
      shape_vertex(&s, (vec3){o.x + (k & 1 ? 1 : 0), o.y + (k & 2 ? 1 : 0),
                              o.z + (k & 4 ? 1 : 0)});
    for (int k = 0; k < 36; k += 3)
      shape_triangle(&s, first + faces[k], first + faces[k + 1],
                     first + faces[k + 2]);
  }
  return s;
}

// A flat square of n x n cells in the plane y = 0.
static inline shape shape_flat(arena *mem, uint32_t n) {
  shape s = shape_new(mem, "flat", (n + 1) * (n + 1), 2 * n * n);
  for (uint32_t i = 0; i < (n + 1) * (n + 1); i++)
    shape_vertex(&s, (vec3){2 * (float)(i % (n + 1)) / (float)n - 1, 0,
                            2 * (float)(i / (n + 1)) / (float)n - 1});
  for (uint32_t i = 0; i < n * n; i++) {
    uint32_t a = i / n * (n + 1) + i % n;
    shape_triangle(&s, a, a + n + 1, a + 1);
    shape_triangle(&s, a + 1, a + n + 1, a + n + 2);
  }
  return s;
}

// The soup with triangles that cannot be hit between its own.
static inline shape shape_broken(arena *mem) {
  shape from = shape_soup(mem, 400, 0.5f);
  shape s = shape_new(mem, "broken", 1200, 400);
  for (uint32_t t = 0; t < 400; t++) {
    vec3 *p = from.positions + 3 * (size_t)t;
    if (t % 4 == 1) p[t % 3].y = NAN;
    if (t % 8 == 2) p[t % 3].z = t & 16 ? INFINITY : -INFINITY;
    if (t % 8 == 6) p[2] = t & 16 ? p[0] : vec3_lerp(p[0], p[0], 0.5f);
    shape_three(&s, p[0], p[1], p[2]);
  }
  return s;
}

// The first third of a mesh of single triangles three times.
static inline shape shape_thrice(shape s, const char *name) {
  s.name = name;
  for (uint32_t i = 0; i < 3 * s.triangles; i++)
    s.index[i] = i % s.triangles;
  return s;
}

// Sizes and distances in a geometric row from 2^-60 to 2^60: a cut by cost
// takes off one or two at a time.
static inline shape shape_row(arena *mem) {
  shape s = shape_new(mem, "row", 3 * 484, 484);
  for (int i = 0; i < 484; i++) {
    float f = ldexpf(1 + 0.25f * (float)(i % 4), i / 4 - 60);
    shape_three(&s, (vec3){f, 0, 0}, (vec3){f, 0.1f * f, 0},
                (vec3){f, 0, 0.1f * f});
  }
  return s;
}

enum { SHAPES = 19 };

// All of them; the spheres at other places and sizes share the rays' making.
static inline void shapes_all(shape out[SHAPES], arena *mem) {
  const vec3 one = {1, 1, 1}, zero = {0, 0, 0};
  int n = 0;
  out[n++] = shape_new(mem, "none", 0, 0);
  out[n++] = shape_one(mem);
  out[n++] = shape_quad(mem);
  out[n++] = shape_sphere(mem, 7);
  out[n++] = shape_cubes(mem, 3);
  out[n++] = shape_soup(mem, 400, 0.3f);
  out[n++] = shape_moved(shape_soup(mem, 300, 2), "large soup", one, zero);
  out[n++] = shape_flat(mem, 12);
  out[n++] = shape_needles(mem, 300, 1e-6f);
  out[n++] = shape_concentric(mem);
  out[n++] = shape_broken(mem);
  out[n++] = shape_thrice(shape_soup(mem, 600, 0.5f), "thrice");
  out[n++] = shape_thrice(shape_needles(mem, 300, 1e-6f), "slivers thrice");
  out[n++] = shape_row(mem);
  out[n++] = shape_moved(shape_sphere(mem, 6), "huge", vec3_all(1e12f), zero);
  out[n++] = shape_moved(shape_sphere(mem, 6), "tiny", vec3_all(1e-12f), zero);
  out[n++] = shape_moved(shape_sphere(mem, 6), "far", vec3_all(100),
                         (vec3){1e6f, -1e6f, 1e6f});
  out[n++] = shape_moved(shape_sphere(mem, 6), "speck far away",
                         vec3_all(1e-6f), (vec3){1, 1, 1});
  out[n++] =
      shape_moved(shape_sphere(mem, 6), "plate", (vec3){1, 1e-5f, 1}, zero);
  assert_int_equal(n, SHAPES);
}

// A mesh, its tree, and the box that rays are made in.
typedef struct grove {
  shape s;
  bvh b;
  vec3 lo, extent;
  uint32_t wrong;
} grove;

static inline void grove_plant(grove *g, shape s, arena *mem,
                               bvh_method method) {
  *g = (grove){.s = s, .extent = {1, 1, 1}};
  bvh_build(&g->b, s.positions, s.index, s.triangles, method, mem, NULL);
  if (g->b.nodes == NULL) return;
  g->lo = g->b.nodes[0].lo;
  g->extent = vec3_sub(g->b.nodes[0].hi, g->lo);
}

// A point in the box grown by half, or on one of its faces, or a vertex.
static inline vec3 point_near(const grove *g, uint64_t *state) {
  float pick = shape_random(state);
  vec3 u = vec3_mad(vec3_all(0.5f), 0.75f, shape_point(state));
  if (pick < 0.15f && g->s.vertices > 0) {
    vec3 p =
        g->s.positions[(uint32_t)(shape_random(state) * (float)g->s.vertices)];
    if (vec3_finite(p)) return p;
  }
  if (pick > 0.9f) u.x = pick > 0.95f ? 0 : 1;
  if (pick > 0.8f) u.y = pick > 0.85f ? 0 : 1;
  return vec3_add(g->lo, vec3_mul(u, g->extent));
}

// A ray along the first edge of some triangle, as near as rounding allows:
// the triangle is seen edge-on, and its t is mostly rounding.
static inline ray ray_edge_on(const grove *g, uint64_t *state) {
  uint32_t t = (uint32_t)(shape_random(state) * (float)g->s.triangles);
  vec3 a = g->s.positions[g->s.index[3 * t]];
  vec3 d = vec3_sub(g->s.positions[g->s.index[3 * t + 1]], a);
  float size = 1e-6f * vec3_peak(vec3_abs(d)) * shape_random(state);
  vec3 o = vec3_mad(a, -2 * shape_random(state), d);
  return ray_from(vec3_mad(o, 0.5f * size, shape_point(state)),
                  vec3_mad(d, size, shape_point(state)));
}

// Between two points near; some along an axis, some nearly so, some of limited
// length, some along an edge.
static inline ray ray_near(const grove *g, uint64_t *state) {
  vec3 o = point_near(g, state), d = vec3_sub(point_near(g, state), o);
  float pick = shape_random(state);
  if (pick < 0.3f) d.x = pick < 0.1f ? 0 : pick < 0.2f ? -0.0f : 1e-39f;
  if (pick < 0.25f && pick > 0.05f) d.z = pick > 0.15f ? 0 : 1e-20f * d.z;
  ray r = ray_from(o, d);
  if (pick > 0.3f && pick < 0.5f && g->s.triangles > 0)
    r = ray_edge_on(g, state);
  if (pick > 0.8f) r.tmax = shape_random(state) * 2;
  if (pick > 0.9f) r.tmin = shape_random(state);
  if (pick > 0.99f) r.tmin = -1;
  return r;
}

#endif
