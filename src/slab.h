// slab.h — where a ray is inside a box, never too early and never too late.
//
// All trees share this arithmetic.  It is monotone: a larger box gives a
// longer interval, to the bit, because rounding never swaps two numbers.  And
// it is conservative: a ray that triangle_hit lets through a triangle is
// inside the triangle's box.

#ifndef SLAB_H
#define SLAB_H

#include "aabb.h"
#include "ray.h"

// A box as the nodes of trees hold it: two corners, 16 bytes apart, and room
// for two numbers.
typedef struct slab_box {
  vec3 lo;
  uint32_t first;
  vec3 hi;
  uint32_t second;
} slab_box;

// A ray made ready for boxes.  Of each axis: the reciprocal of the direction;
// the origin moved a little, for the plane where the ray enters and for the
// plane where it leaves; and at which byte of a slab_box the plane is where it
// enters.  The plane where it leaves is at that ^ 16.  `large` is slab_large.
typedef struct slab_ray {
  vec3 inv, o_enter, o_leave;
  uint32_t x, y, z;
  float large;
} slab_ray;

// The span of t in which a ray is inside a box; empty when near > far.
typedef struct slab_span {
  float near, far;
} slab_span;

// A triangle is large when its box is longer than this in a mesh that fills
// `all`; never in one whose size is no finite float.
static inline float slab_large(const aabb *all) {
  vec3 side = vec3_sub(all->hi, all->lo);
  return 0x1p-8f * vec3_peak(side);
}

// The ray from o along d, flushed and not 0, for boxes inside `all`.
slab_ray slab_ray_of(vec3 o, vec3 d, const aabb *all);

// The float at an offset into a box.
static inline float slab_plane(const void *box, uint32_t offset) {
  return *(const float *)((const char *)box + offset);
}

// span cut down to where the ray is inside a box: a slab_box, or what begins
// like one.  A plane that gives 0 * infinity, NaN, cuts nothing: every
// comparison with it is false.
static inline slab_span slab_cut(const slab_ray *s, const void *box,
                                 slab_span span) {
  float x0 = (slab_plane(box, s->x) - s->o_enter.x) * s->inv.x;
  float y0 = (slab_plane(box, s->y) - s->o_enter.y) * s->inv.y;
  float z0 = (slab_plane(box, s->z) - s->o_enter.z) * s->inv.z;
  float x1 = (slab_plane(box, s->x ^ 16) - s->o_leave.x) * s->inv.x;
  float y1 = (slab_plane(box, s->y ^ 16) - s->o_leave.y) * s->inv.y;
  float z1 = (slab_plane(box, s->z ^ 16) - s->o_leave.z) * s->inv.z;
  if (x0 > span.near) span.near = x0;
  if (y0 > span.near) span.near = y0;
  if (z0 > span.near) span.near = z0;
  if (x1 < span.far) span.far = x1;
  if (y1 < span.far) span.far = y1;
  if (z1 < span.far) span.far = z1;
  return span;
}

// h, a hit of triangle p[0..2] by r, with its t moved into the span of the
// triangle's own box, or of a large triangle's point that is hit; false when
// that is empty or t leaves tmin..tmax of r.  The t of a triangle seen edge-on
// can be wrong by more than any margin.  Held to the box, it is never less than
// the t at which a box around the triangle is entered: a tree that skips boxes
// finds what a list would find.  Held to the point, it is never less than where
// a box around that part of the triangle is entered, for trees that part large
// triangles.
bool slab_hold(const slab_ray *s, const ray *r, const vec3 p[3], hit *h);

#endif
