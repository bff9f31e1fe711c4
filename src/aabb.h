// aabb.h — axis-aligned boxes.

#ifndef AABB_H
#define AABB_H

#include "ray.h"

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

// Half the surface area of b, 0 for the empty box.  The SAH needs only ratios
// of areas, so the factor 2 is left out.
static inline float aabb_half_area(aabb b) {
  vec3 d = vec3_sub(b.hi, b.lo);
  if (!(d.x >= 0)) return 0;
  return d.x * d.y + d.y * d.z + d.z * d.x;
}

#endif
