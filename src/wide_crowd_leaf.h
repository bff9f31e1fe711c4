// wide_crowd_leaf.h — a crowd at a leaf.

#ifndef WIDE_CROWD_LEAF_H
#define WIDE_CROWD_LEAF_H

#include "wide_crowd_settle.h"

// The lanes whose triangle lies behind the ray, so far that no rounding of t
// matters: t_error of triangle.c is at most 171 roundings of the cube of the
// largest coordinate over det, and -t is more than twice that.  The constant
// added is for what underflows.
SIMD uint32_t leaf_behind(const leaf_shear *c, f8 sz) {
  const f8 z[3] = {f8_mul(sz, c->z[0]), f8_mul(sz, c->z[1]),
                   f8_mul(sz, c->z[2])};
  f8 zero = f8_all(0), det = f8_add(f8_add(c->e[0], c->e[1]), c->e[2]);
  f8 t = f8_add(f8_mul(c->e[0], z[0]), f8_mul(c->e[1], z[1]));
  t = f8_add(t, f8_mul(c->e[2], z[2]));
  f8 most = f8_max(f8_max(f8_peak(c->x), f8_peak(c->y)), f8_peak(z));
  f8 error = f8_mul(f8_mul(most, most), f8_mul(most, f8_all(0x1.8p-16f)));
  error = f8_add(error, f8_all(0x1p-80f));
  return f8_lt(error, f8_where_lt(det, zero, t, f8_sub(zero, t)));
}

// The rays of a part at its leaf.
SIMD void crowd_leaf(crowd *q, const crowd_part *at) {
  uint32_t n = wide_leaf_count(at->child);
  const uint32_t *leaf =
      q->s->t->triangles + 10 * (size_t)wide_leaf_first(at->child);
  pending *p = &q->pending;
  for (uint32_t i = at->first; i < at->first + at->count; i++) {
    const crowd_shear *s = &q->at_leaf[q->leaves.ray[i]];
    leaf_corners corners;
    leaf_shear c;
    leaf_rays r = {{f8_all(s->o[0]), f8_all(s->o[1]), f8_all(s->o[2])},
                   f8_all(s->sx),
                   f8_all(s->sy)};
    corners_load(&corners, leaf, n, turned_axes[s->kz]);
    uint32_t m = leaf_edges(&c, &r, &corners) & ((1u << n) - 1);
    if (m == 0) continue;
    m &= ~leaf_behind(&c, f8_all(s->sz));
    if (m == 0) continue;
    f8 who = f8_bits(q->leaves.ray[i]);
    memcpy(p->flight + p->count, &who, sizeof who);
    p->count = pending_add(p, p->count, &corners, leaf + 9 * n, m);
    if (p->count > PENDING - 16) crowd_settle(q);
  }
}

#endif
