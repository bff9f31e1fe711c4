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

#include <float.h>

// A ray made ready for boxes.  Of each axis: the reciprocal of the direction,
// the origin moved a little for the plane where the ray enters and for the
// plane where it leaves, and whether it enters through hi.
typedef struct slab_ray {
  vec3 inv, o_enter, o_leave;
  bool high_x, high_y, high_z;
} slab_ray;

// The span of t in which a ray is inside a box; empty when near > far.
typedef struct slab_span {
  float near, far;
} slab_span;

// How far the origin is moved along one axis, in world units: reach is the
// largest distance of a plane from o along this axis, sheared the same along
// the longest axis times the slope of the ray, |o| the origin's magnitude.
// Chapter 4 derives the factors; u = 2^-24.
static inline float slab_margin(float reach, float sheared, float o) {
  return 0x6p-24f * (reach + sheared) + 0x2p-24f * fabsf(o) + FLT_MIN;
}

// The larger distance of the planes lo and hi from o.
static inline float slab_reach(float lo, float hi, float o) {
  float a = fabsf(lo - o), b = fabsf(hi - o);
  return a > b ? a : b;
}

// The ray from o along d, flushed, for boxes that lie inside `all`.
static inline slab_ray slab_ray_of(vec3 o, vec3 d, const aabb *all) {
  vec3 m = {slab_reach(all->lo.x, all->hi.x, o.x),
            slab_reach(all->lo.y, all->hi.y, o.y),
            slab_reach(all->lo.z, all->hi.z, o.z)};
  vec3 a = vec3_abs(d);
  // Reach along the longest axis, per unit of that axis.
  float k = a.x > a.y ? (a.x > a.z ? m.x / a.x : m.z / a.z)
                      : (a.y > a.z ? m.y / a.y : m.z / a.z);
  slab_ray s = {.inv = {1 / d.x, 1 / d.y, 1 / d.z}};
  s.high_x = s.inv.x < 0;
  s.high_y = s.inv.y < 0;
  s.high_z = s.inv.z < 0;
  float ex = slab_margin(m.x, a.x * k, o.x);
  float ey = slab_margin(m.y, a.y * k, o.y);
  float ez = slab_margin(m.z, a.z * k, o.z);
  s.o_enter =
      (vec3){s.high_x ? o.x - ex : o.x + ex, s.high_y ? o.y - ey : o.y + ey,
             s.high_z ? o.z - ez : o.z + ez};
  s.o_leave =
      (vec3){s.high_x ? o.x + ex : o.x - ex, s.high_y ? o.y + ey : o.y - ey,
             s.high_z ? o.z + ez : o.z - ez};
  return s;
}

// span cut down to where the ray is inside the box lo, hi.  A plane that gives
// 0 * infinity, NaN, cuts nothing: every comparison with it is false.
static inline slab_span slab_cut(const slab_ray *s, const vec3 *lo,
                                 const vec3 *hi, slab_span span) {
  float x0 = ((s->high_x ? hi->x : lo->x) - s->o_enter.x) * s->inv.x;
  float y0 = ((s->high_y ? hi->y : lo->y) - s->o_enter.y) * s->inv.y;
  float z0 = ((s->high_z ? hi->z : lo->z) - s->o_enter.z) * s->inv.z;
  float x1 = ((s->high_x ? lo->x : hi->x) - s->o_leave.x) * s->inv.x;
  float y1 = ((s->high_y ? lo->y : hi->y) - s->o_leave.y) * s->inv.y;
  float z1 = ((s->high_z ? lo->z : hi->z) - s->o_leave.z) * s->inv.z;
  if (x0 > span.near) span.near = x0;
  if (y0 > span.near) span.near = y0;
  if (z0 > span.near) span.near = z0;
  if (x1 < span.far) span.far = x1;
  if (y1 < span.far) span.far = y1;
  if (z1 < span.far) span.far = z1;
  return span;
}

// The least and the largest of three floats that are not NaN.
static inline float slab_least(float a, float b, float c) {
  float m = a < b ? a : b;
  return m < c ? m : c;
}

static inline float slab_most(float a, float b, float c) {
  float m = a > b ? a : b;
  return m > c ? m : c;
}

// h, a hit of the triangle p0 p1 p2, with its t moved into the span of the
// triangle's own box; false when that is empty or t leaves tmin..tmax of r.
// The t of a triangle seen edge-on can be wrong by more than any margin.  Held
// to the box, it can no longer be less than the t at which any box around the
// triangle is entered: a tree that skips boxes finds what a list would find.
static inline bool slab_hold(const slab_ray *s, const ray *r, const vec3 p[3],
                             hit *h) {
  vec3 lo = {slab_least(p[0].x, p[1].x, p[2].x),
             slab_least(p[0].y, p[1].y, p[2].y),
             slab_least(p[0].z, p[1].z, p[2].z)};
  vec3 hi = {slab_most(p[0].x, p[1].x, p[2].x),
             slab_most(p[0].y, p[1].y, p[2].y),
             slab_most(p[0].z, p[1].z, p[2].z)};
  slab_span box = slab_cut(s, &lo, &hi, (slab_span){-INFINITY, INFINITY});
  if (h->t < box.near) h->t = box.near;
  if (h->t > box.far) h->t = box.far;
  return box.near <= box.far && h->t >= r->tmin && h->t <= r->tmax;
}

#endif
