// shapes.h — meshes for the tests of trees, friendly and not.

#ifndef SHAPES_H
#define SHAPES_H

#include "arena.h"
#include "vec.h"

#include <stdint.h>
#include <stdlib.h>

// Rays of a comparison with the list, fewer under a sanitizer.
static inline uint32_t many(uint32_t n) {
  return getenv("FACET_QUICK") != NULL ? n / 50 : n;
}

// A mesh that grows while it is made.
typedef struct shape {
  const char *name;
  vec3 *positions;
  uint32_t *index;
  uint32_t vertices, triangles;
} shape;

// The next of a sequence of numbers in [0, 1): xorshift64*.
static inline float shape_random(uint64_t *state) {
  *state ^= *state >> 12;
  *state ^= *state << 25;
  *state ^= *state >> 27;
  return (float)((*state * UINT64_C(0x2545f4914f6cdd1d)) >> 40) * 0x1p-24f;
}

// A point uniform in the cube -1..1.
static inline vec3 shape_point(uint64_t *state) {
  float x = shape_random(state), y = shape_random(state);
  return (vec3){2 * x - 1, 2 * y - 1, 2 * shape_random(state) - 1};
}

static inline shape shape_new(arena *mem, const char *name, uint32_t vertices,
                              uint32_t triangles) {
  return (shape){name, ARENA_NEW(mem, vec3, vertices),
                 ARENA_NEW(mem, uint32_t, 3 * (size_t)triangles), 0, 0};
}

static inline uint32_t shape_vertex(shape *s, vec3 p) {
  s->positions[s->vertices] = p;
  return s->vertices++;
}

static inline void shape_triangle(shape *s, uint32_t a, uint32_t b,
                                  uint32_t c) {
  uint32_t *v = s->index + 3 * (size_t)s->triangles++;
  v[0] = a;
  v[1] = b;
  v[2] = c;
}

static inline void shape_three(shape *s, vec3 a, vec3 b, vec3 c) {
  uint32_t i = shape_vertex(s, a), j = shape_vertex(s, b);
  shape_triangle(s, i, j, shape_vertex(s, c));
}

// Every vertex p becomes move + scale p.
static inline shape shape_moved(shape s, const char *name, vec3 scale,
                                vec3 move) {
  s.name = name;
  for (uint32_t i = 0; i < s.vertices; i++)
    s.positions[i] = vec3_add(move, vec3_mul(scale, s.positions[i]));
  return s;
}

// Needles from wall to wall, 1 / width times as long as wide.
static inline shape shape_needles(arena *mem, uint32_t n, float width) {
  shape s = shape_new(mem, "needles", 3 * n, n);
  uint64_t state = 5;
  for (uint32_t i = 0; i < n; i++) {
    vec3 a = shape_point(&state), b = shape_point(&state);
    shape_three(&s, a, b, vec3_mad(b, width, shape_point(&state)));
  }
  return s;
}

// A unit sphere: an octahedron whose faces are n x n triangles.  Closed:
// neighbours share their vertices.
static inline shape shape_sphere(arena *mem, uint32_t n) {
  shape s = shape_new(mem, "sphere", 4 * n * n + 2, 8 * n * n);
  uint32_t old = 0;
  // Rings from the north pole to the south; ring k has 4 min(k, 2n-k) points.
  for (uint32_t k = 0; k <= 2 * n; k++) {
    uint32_t m = k < n ? k : 2 * n - k, first = s.vertices;
    for (uint32_t i = 0; i < (m > 0 ? 4 * m : 1); i++) {
      float q = m > 0 ? (float)(i % m) / (float)m : 0;
      float r = (float)m / (float)n, z = 1 - (float)k / (float)n;
      uint32_t side = m > 0 ? i / m : 0;
      float a = r * (1 - q), b = r * q;
      vec3 p = side == 0   ? (vec3){a, b, z}
               : side == 1 ? (vec3){-b, a, z}
               : side == 2 ? (vec3){-a, -b, z}
                           : (vec3){b, -a, z};
      shape_vertex(&s, vec3_unit(p));
    }
    uint32_t before = k <= n ? m - 1 : m + 1;
    for (uint32_t side = 0; k > 0 && side < 4; side++) {
      uint32_t big = k <= n ? m : before, small = k <= n ? before : m;
      uint32_t at_big = k <= n ? first : old, at_small = k <= n ? old : first;
      uint32_t nb = 4 * big, ns = small > 0 ? 4 * small : 1;
      for (uint32_t i = 0; i < big; i++) {
        uint32_t b0 = at_big + (side * big + i) % nb;
        uint32_t b1 = at_big + (side * big + i + 1) % nb;
        uint32_t s0 = at_small + (side * small + i) % ns;
        uint32_t s1 = at_small + (side * small + i + 1) % ns;
        // Counter-clockwise from outside in either half.
        bool up = k <= n;
        shape_triangle(&s, up ? b0 : b1, up ? b1 : b0, s0);
        if (i + 1 < big) shape_triangle(&s, s0, up ? b1 : s1, up ? s1 : b1);
      }
    }
    old = first;
  }
  return s;
}

#endif
