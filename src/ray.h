// ray.h — rays, hits, and what traces them.

#ifndef RAY_H
#define RAY_H

#include "vec.h"

#include <float.h>
#include <stddef.h>
#include <stdint.h>

// The points o + t d with tmin <= t <= tmax.  d need not have unit length;
// -0 and zero components are fine, denormal ones count as 0.
typedef struct ray {
  vec3 o, d;
  float tmin, tmax;
} ray;

// No triangle.
#define HIT_NONE UINT32_MAX

// Where a ray met a triangle: its number in the mesh, the distance in units of
// |d|, and the barycentric weights of its second and third corner.
typedef struct hit {
  float t, b1, b2;
  uint32_t triangle;
} hit;

// A ray with tmin 0 and no end.
static inline ray ray_from(vec3 o, vec3 d) {
  return (ray){o, d, 0, INFINITY};
}

// d with every component smaller than FLT_MIN replaced by 0.  The reciprocal
// of a denormal overflows, so all that divides by a component asks this first:
// the triangle test and the box test then speak of the same line.
static inline vec3 ray_flush(vec3 d) {
  return (vec3){fabsf(d.x) < FLT_MIN ? 0 : d.x, fabsf(d.y) < FLT_MIN ? 0 : d.y,
                fabsf(d.z) < FLT_MIN ? 0 : d.z};
}

// The least cosine between a ray and a normal that it climbs along.
#define RAY_CLIMB 0x1p-4f

// Whether a ray of unit direction d climbs away from a facet of unit normal n,
// if it begins in it or straight above.
static inline bool ray_climbs(vec3 d, vec3 n) {
  return vec3_dot(d, n) > RAY_CLIMB;
}

// Something that can be asked for hits: a list, a tree, a wider tree.  closest
// returns false and leaves *h alone on a miss; of hits at equal t it gives the
// lowest triangle number.  any says whether anything lies in [tmin, tmax].
// The other two ask the same of n rays at once, for trees that gain by it, and
// may be NULL: hits[i] is t = tmax and HIT_NONE where ray i misses.  left[i],
// where left is not NULL, is the triangle that ray i climbs away from (see
// ray_climbs), so that a tree may look elsewhere, or HIT_NONE.
typedef struct tracer {
  const void *tree;
  bool (*closest)(const void *tree, const ray *r, hit *h);
  bool (*any)(const void *tree, const ray *r);
  void (*closest_many)(const void *tree, const ray *rays, const uint32_t *left,
                       hit *hits, size_t n);
  void (*any_many)(const void *tree, const ray *rays, bool *blocked, size_t n);
} tracer;

#endif
