// wide_interval.h — the rays of a packet and the boxes of a node.

#ifndef WIDE_INTERVAL_H
#define WIDE_INTERVAL_H

#include "wide_packet.h"

// cut_axis for the interval of all rays.  Rounding keeps order, so that no ray
// enters later or leaves earlier than the interval.
SIMD void packet_cut_axis(f8 *near, f8 *far, const packet *p,
                          const wide_node *n, int k) {
  const packet_axis *x = &p->axis[k];
  f8 base = f8_all(n->base[k]), scale = f8_all(n->scale[k]);
  f8 least = f8_all(x->least), most = f8_all(x->most);
  const uint8_t *lower = n->plane[k][0];
  f8 a = f8_mad(f8_of_bytes(lower + p->side[k]), scale, base);
  f8 b = f8_mad(f8_of_bytes(lower + (p->side[k] ^ WIDE)), scale, base);
  a = f8_sub(a, f8_all(x->first));
  b = f8_sub(b, f8_all(x->last));
  *near = f8_max(f8_min(f8_mul(a, least), f8_mul(a, most)), *near);
  *far = f8_min(f8_max(f8_mul(b, least), f8_mul(b, most)), *far);
}

// Which children any ray may enter, and where the first does.
SIMD uint32_t packet_cut_node(const packet *p, const wide_node *n, f8 *near) {
  f8 a = f8_all(p->all_begin), b = f8_all(p->all_until);
  packet_cut_axis(&a, &b, p, n, 0);
  packet_cut_axis(&a, &b, p, n, 1);
  packet_cut_axis(&a, &b, p, n, 2);
  *near = a;
  return f8_le(a, b) & n->valid;
}

// cut_axis for one child and every ray.
SIMD void packet_child_axis(f8 near[2], f8 far[2], const packet *p,
                            const wide_node *n, uint32_t i, int k) {
  const packet_axis *x = &p->axis[k];
  const uint8_t *lower = n->plane[k][0];
  float base = n->base[k], scale = n->scale[k];
  f8 a = f8_all(base + (float)lower[p->side[k] + i] * scale);
  f8 b = f8_all(base + (float)lower[(p->side[k] ^ WIDE) + i] * scale);
  for (int h = 0; h < 2; h++) {
    f8 inv = f8_load(x->inv + HALF * h);
    f8 enter = f8_load(x->enter + HALF * h),
       leave = f8_load(x->leave + HALF * h);
    near[h] = f8_max(f8_mul(f8_sub(a, enter), inv), near[h]);
    far[h] = f8_min(f8_mul(f8_sub(b, leave), inv), far[h]);
  }
}

// Which rays enter child i.
SIMD uint32_t packet_cut_child(const packet *p, const wide_node *n,
                               uint32_t i) {
  f8 near[2] = {f8_load(p->begin), f8_load(p->begin + HALF)};
  f8 far[2] = {f8_load(p->until), f8_load(p->until + HALF)};
  packet_child_axis(near, far, p, n, i, 0);
  packet_child_axis(near, far, p, n, i, 1);
  packet_child_axis(near, far, p, n, i, 2);
  uint32_t m = f8_le(near[0], far[0]) | f8_le(near[1], far[1]) << HALF;
  return m & p->alive;
}

#endif
