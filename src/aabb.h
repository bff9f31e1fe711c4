// aabb.h — axis-aligned boxes.

#ifndef AABB_H
#define AABB_H

#include "vec.h"

// An axis-aligned box; empty when any lo component exceeds its hi.
typedef struct aabb {
  vec3 lo, hi;
} aabb;

// The empty box, the identity of aabb_join.
#define AABB_EMPTY \
  ((aabb){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}})

// The smallest box holding both a and b.
static inline aabb aabb_join(aabb a, aabb b) {
  return (aabb){vec3_min(a.lo, b.lo), vec3_max(a.hi, b.hi)};
}

// The smallest box holding a and the point p.
static inline aabb aabb_add(aabb a, vec3 p) {
  return (aabb){vec3_min(a.lo, p), vec3_max(a.hi, p)};
}

// Half the surface area of b, 0 for the empty box; the SAH needs only ratios.
// In double, where neither a mesh of size 1e30 nor one of 1e-30 leaves the
// range.
static inline double aabb_half_area(aabb b) {
  double x = (double)b.hi.x - (double)b.lo.x;
  double y = (double)b.hi.y - (double)b.lo.y;
  double z = (double)b.hi.z - (double)b.lo.z;
  return x >= 0 ? x * y + y * z + z * x : 0;
}

#endif
