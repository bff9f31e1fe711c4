// wide_box.h — a ray on its way, and the eight boxes of a node.
//
// Boxes may be tested in any arithmetic that is not narrower than slab.h.

#ifndef WIDE_BOX_H
#define WIDE_BOX_H

#include "simd_lanes.h"
#include "slab.h"
#include "triangle.h"
#include "wide_tree.h"

// What one ray needs on its way, in four rows of eight numbers.  The first is
// for triangles, and its axes are turned so that the longest is the last: o and
// the shear.  inv, enter and leave are slab_ray by axis; reach is no less
// than the t at the far side of the tree along the longest axis.
typedef struct wide_walk {
  float o[3], sx, sy, sz, tmin, tmax;
  float inv[3], reach, enter[3];
  float turn_x;  // -1 where x is the longest axis, else 1
  float leave[3];
  float turn_y;      // the same for y
  hit best;          // so far
  uint32_t side[3];  // from wide_node.plane[k][0] to where the ray enters
  uint32_t axis[3];  // the axes, turned
  float begin;       // tmin, or 0 when that is less or NaN: no hit has t < 0
  float large;       // of slab_ray
  const ray *r;
} wide_walk;

enum { ROWS = 4 };

_Static_assert(offsetof(wide_walk, r) == ROWS * 8 * sizeof(float), "rows");

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
