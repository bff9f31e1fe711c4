// slab.c — what is done once a ray or once a hit, not once a box.

#include "slab.h"

#include "triangle.h"

#include <float.h>

// The larger distance of the planes lo and hi from o.
static float reach_of(float lo, float hi, float o) {
  float a = fabsf(lo - o), b = fabsf(hi - o);
  return a > b ? a : b;
}

// How far the origin is moved along one axis: reach is the farthest that a
// box lies from o along it, sheared what the ray covers along this axis while
// it covers the reach of its longest.  Chapter 4 derives the factors.
static float margin_of(float reach, float sheared, float o) {
  return 0x6p-24f * reach + 0x10p-24f * sheared + 0x2p-24f * fabsf(o) + FLT_MIN;
}

slab_ray slab_ray_of(vec3 o, vec3 d, const aabb *all) {
  vec3 m = {reach_of(all->lo.x, all->hi.x, o.x),
            reach_of(all->lo.y, all->hi.y, o.y),
            reach_of(all->lo.z, all->hi.z, o.z)};
  vec3 a = vec3_abs(d);
  float k = a.x > a.y ? (a.x > a.z ? m.x / a.x : m.z / a.z)
                      : (a.y > a.z ? m.y / a.y : m.z / a.z);
  slab_ray s = {.inv = {1 / d.x, 1 / d.y, 1 / d.z}, .large = slab_large(all)};
  bool back_x = s.inv.x < 0, back_y = s.inv.y < 0, back_z = s.inv.z < 0;
  s.x = back_x ? 16 : 0;
  s.y = back_y ? 20 : 4;
  s.z = back_z ? 24 : 8;
  float ex = margin_of(m.x, a.x * k, o.x) * (back_x ? -1.0f : 1.0f);
  float ey = margin_of(m.y, a.y * k, o.y) * (back_y ? -1.0f : 1.0f);
  float ez = margin_of(m.z, a.z * k, o.z) * (back_z ? -1.0f : 1.0f);
  s.o_enter = (vec3){o.x + ex, o.y + ey, o.z + ez};
  s.o_leave = (vec3){o.x - ex, o.y - ey, o.z - ez};
  return s;
}

// The least and the largest of three floats that are not NaN.
static float least_of(float a, float b, float c) {
  float m = a < b ? a : b;
  return m < c ? m : c;
}

static float most_of(float a, float b, float c) {
  float m = a > b ? a : b;
  return m > c ? m : c;
}

// The neighbouring floats between which x lies, or x itself twice, within
// *lo..*hi.
static void hold_between(float *lo, float *hi, double x) {
  x = x < (double)*lo ? (double)*lo : x > (double)*hi ? (double)*hi : x;
  float near = (float)x;
  *lo = (double)near > x ? nextafterf(near, -INFINITY) : near;
  *hi = (double)near < x ? nextafterf(near, INFINITY) : near;
}

// own, the box of triangle p, shrunk to the point where r meets it.
static void shrink_to_point(slab_box *own, const ray *r, const vec3 p[3]) {
  double w[3];
  ray_shear shear = ray_shear_of(r->d);
  if (!triangle_weights(r, &shear, p, w)) return;
  hold_between(&own->lo.x, &own->hi.x,
               w[0] * (double)p[0].x + w[1] * (double)p[1].x +
                   w[2] * (double)p[2].x);
  hold_between(&own->lo.y, &own->hi.y,
               w[0] * (double)p[0].y + w[1] * (double)p[1].y +
                   w[2] * (double)p[2].y);
  hold_between(&own->lo.z, &own->hi.z,
               w[0] * (double)p[0].z + w[1] * (double)p[1].z +
                   w[2] * (double)p[2].z);
}

bool slab_hold(const slab_ray *s, const ray *r, const vec3 p[3], hit *h) {
  slab_box own = {
      .lo = {least_of(p[0].x, p[1].x, p[2].x), least_of(p[0].y, p[1].y, p[2].y),
             least_of(p[0].z, p[1].z, p[2].z)},
      .hi = {most_of(p[0].x, p[1].x, p[2].x), most_of(p[0].y, p[1].y, p[2].y),
             most_of(p[0].z, p[1].z, p[2].z)}};
  if (vec3_peak(vec3_sub(own.hi, own.lo)) > s->large)
    shrink_to_point(&own, r, p);
  slab_span box = slab_cut(s, &own, (slab_span){-INFINITY, INFINITY});
  if (h->t < box.near) h->t = box.near;
  if (h->t > box.far) h->t = box.far;
  return box.near <= box.far && h->t >= r->tmin && h->t <= r->tmax;
}
