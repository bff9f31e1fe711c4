// wide_box.h — a ray on its way, and the eight boxes of a node.
//
// Boxes may be tested in any arithmetic that is not narrower than slab.h.

#ifndef WIDE_BOX_H
#define WIDE_BOX_H

#include "simd.h"
#include "slab.h"
#include "triangle.h"
#include "wide_tree.h"

// What one ray needs on its way.
typedef struct wide_walk {
  float inv[4], enter[4], leave[4];  // slab_ray by axis
  uint32_t side[4];  // from wide_node.plane[k][0] to where the ray enters
  float begin;       // tmin, or 0 when that is less or NaN: no hit has t < 0
  float large;       // of slab_ray
  float reach;       // t, at most, to the far side of the tree along axis kz
  hit best;
  uint32_t axis[3];  // the axes, turned by the shear
  float o[3];        // and the origin
  ray_shear shear;
  ray r;
} wide_walk;

// The axis along which |d| is largest, as ray_shear_of chooses it; without
// anything to guess for the processor.
SIMD int longest_axis(const float a[4]) {
  int xy = a[0] > a[1], xz = a[0] > a[2], yz = a[1] > a[2];
  return 2 - 2 * (xy & xz) - (~xy & yz);
}

// slab_ray_of for three axes at once; a is |d|, `kz` where it is largest.
SIMD void start_slab(wide_walk *w, const wide_tree *t, f4 o, f4 d, f4 a,
                     int kz) {
  const f4 one = {1, 1, 1, 1}, two = 0x2p-24f * one;
  const f4 six = 0x6p-24f * one, sixteen = 0x10p-24f * one;
  f4 lo, hi, inv = one / d, m;
  memcpy(&lo, t->lo, sizeof lo);
  memcpy(&hi, t->hi, sizeof hi);
  lo = f4_abs(lo - o);
  hi = f4_abs(hi - o);
  m = f4_pick(lo > hi, lo, hi);
  float reach[4], far[4];
  memcpy(reach, &m, sizeof reach);
  memcpy(far, &a, sizeof far);
  float k = reach[kz] / far[kz];
  f4 e = six * m + sixteen * (a * (f4){k, k, k, k});
  e = e + two * f4_abs(o) + FLT_MIN * one;
  i4 back = (i4)inv < 0;
  e = f4_pick(back, -e, e);
  f4 enter = o + e, leave = o - e;
  i4 side = back & WIDE;
  w->reach = k;
  memcpy(w->inv, &inv, sizeof inv);
  memcpy(w->enter, &enter, sizeof enter);
  memcpy(w->leave, &leave, sizeof leave);
  memcpy(w->side, &side, sizeof side);
}

// False for a ray that can hit nothing; the same ones as for a bvh.  Of o and
// d the fourth lane is what follows in the ray, and means nothing.
SIMD bool walk_start(wide_walk *w, const wide_tree *t, const ray *r) {
  static const uint32_t turned[3][3] = {{1, 2, 0}, {2, 0, 1}, {0, 1, 2}};
  const f4 most = {FLT_MAX, FLT_MAX, FLT_MAX, 0};
  f4 o, d;
  memcpy(&o, (const char *)r + offsetof(ray, o), sizeof o);
  memcpy(&d, (const char *)r + offsetof(ray, d), sizeof d);
  i4 small = f4_abs(d) < FLT_MIN;
  d = (f4)((i4)d & ~small);
  f4 a = f4_abs(d);
  uint32_t finite = i4_bits((f4_abs(o) <= most) & (a <= most));
  if ((finite & 7) != 7 || (i4_bits(small) & 7) == 7 || t->nodes == NULL)
    return false;
  float length[4], origin[4], along[4];
  memcpy(length, &a, sizeof a);
  memcpy(origin, &o, sizeof o);
  int kz = longest_axis(length);
  start_slab(w, t, o, d, a, kz);
  memcpy(along, &d, sizeof d);
  float dz = along[kz];
  f4 slope = d / (f4){dz, dz, dz, dz};
  memcpy(along, &slope, sizeof slope);
  memcpy(w->axis, turned[kz], sizeof w->axis);
  for (int k = 0; k < 3; k++)
    w->o[k] = origin[w->axis[k]];
  w->shear = (ray_shear){kz, along[w->axis[0]], along[w->axis[1]], w->inv[kz]};
  w->begin = r->tmin > 0 ? r->tmin : 0;
  w->large = t->large;
  w->best = (hit){.t = r->tmax, .triangle = HIT_NONE};
  w->r = *r;
  return true;
}

// Cut the spans of eight boxes along one axis.
SIMD void cut_axis(f8 *near, f8 *far, const wide_walk *w, const wide_node *n,
                   int k) {
  f8 base = f8_all(n->base[k]), scale = f8_all(n->scale[k]);
  f8 inv = f8_all(w->inv[k]);
  const uint8_t *lower = n->plane[k][0];
  f8 a = f8_mad(f8_of_bytes(lower + w->side[k]), scale, base);
  f8 b = f8_mad(f8_of_bytes(lower + (w->side[k] ^ WIDE)), scale, base);
  a = f8_mul(f8_sub(a, f8_all(w->enter[k])), inv);
  b = f8_mul(f8_sub(b, f8_all(w->leave[k])), inv);
  *near = f8_max(a, *near);
  *far = f8_min(b, *far);
}

// Which children the ray enters before its best hit, and where.
SIMD uint32_t cut_node(const wide_walk *w, const wide_node *n, f8 *near) {
  f8 a = f8_all(w->begin), b = f8_all(w->best.t);
  cut_axis(&a, &b, w, n, 0);
  cut_axis(&a, &b, w, n, 1);
  cut_axis(&a, &b, w, n, 2);
  *near = a;
  return f8_le(a, b) & n->valid;
}

#endif
