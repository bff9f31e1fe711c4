// departures.h — rays that leave the surface of a solid, at random.

#ifndef DEPARTURES_H
#define DEPARTURES_H

#include "rng.h"
#include "solids.h"
#include "surface.h"

// Uniform in [-1, 1).
static inline float random_signed(rng *r) {
  return 2 * rng_next(r) - 1;
}

static inline vec3 random_vector(rng *r) {
  float x = random_signed(r), y = random_signed(r);
  return (vec3){x, y, random_signed(r)};
}

// Uniform over the sphere.
static inline vec3 random_direction(rng *r) {
  for (;;) {
    vec3 v = random_vector(r);
    float l2 = vec3_dot(v, v);
    if (l2 > 1e-4f && l2 <= 1) return vec3_unit(v);
  }
}

// A hit that is uniform over a random triangle of n.
static inline hit random_hit(rng *r, uint32_t n) {
  float root = sqrtf(rng_next(r)), b = rng_next(r);
  uint32_t t = (uint32_t)(rng_next(r) * (float)n);
  return (hit){.t = 1, .b1 = root * (1 - b), .b2 = root * b, .triangle = t};
}

// What rays that leave a closed convex shape do: outwards they must hit
// nothing, inwards something.
typedef struct departures {
  long self_hits, leaks;
} departures;

static inline departures depart(const solid *s, long rays, rng *r) {
  arena mem = {0};
  scene w = solid_scene(s, false);
  bvh tree = solid_tree(s, &mem);
  departures d = {0, 0};
  for (long i = 0; i < rays; i++) {
    hit h = random_hit(r, s->triangles), other;
    vec3 out = random_direction(r);
    surface at = surface_at(&w, &h, out);
    if (vec3_dot(out, at.ng) < 0) out = vec3_neg(out);
    ray q = surface_ray(&at, out);
    d.self_hits += bvh_closest(&tree, &q, &other);
    q = surface_ray(&at, vec3_neg(out));
    d.leaks += !bvh_closest(&tree, &q, &other);
  }
  arena_free(&mem);
  return d;
}

// An icosphere, a cube or a tetrahedron, turned so that no face lies along an
// axis, of that size, at that distance from the origin.
enum { DEPARTURE_SOLIDS = 3 };
static inline solid solid_number(int i, float size, float far, arena *mem) {
  solid s = i == 0   ? solid_icosphere(mem, 2)
            : i == 1 ? solid_cube(mem)
                     : solid_tetrahedron(mem);
  if (i > 0) solid_turn(&s);
  solid_place(&s, size, (vec3){far, 0.7f * far, -0.9f * far});
  return s;
}

// Long double holds sums and products of floats with bits to spare.
typedef struct exact3 {
  long double x, y, z;
} exact3;

static inline exact3 exact3_sub(vec3 a, vec3 b) {
  return (exact3){(long double)a.x - (long double)b.x,
                  (long double)a.y - (long double)b.y,
                  (long double)a.z - (long double)b.z};
}

static inline exact3 exact3_cross(exact3 a, exact3 b) {
  return (exact3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z,
                  a.x * b.y - a.y * b.x};
}

static inline long double exact3_dot(exact3 a, exact3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

// The angle between ng and the exact normal of a triangle, in radians, as a
// sine; 2 where it points the other way, NaN where there is none.
static inline double normal_error(const vec3 p[3], vec3 ng) {
  exact3 exact = exact3_cross(exact3_sub(p[1], p[0]), exact3_sub(p[2], p[0]));
  exact3 n = exact3_sub(ng, (vec3){0, 0, 0}), c = exact3_cross(exact, n);
  if (exact3_dot(exact, n) < 0) return 2;
  return (double)sqrtl(exact3_dot(c, c) / exact3_dot(exact, exact));
}

#endif
