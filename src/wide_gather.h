// wide_gather.h — sixteen rays made ready together, if they are neighbours.

#ifndef WIDE_GATHER_H
#define WIDE_GATHER_H

#include "wide_alike.h"

// Rays of a packet may differ by so much in slope, and their origins by so
// much of the tree's longest side.
#define PACKET_SLOPE 0.25f
#define PACKET_ORIGIN 0x1p-5f

// start_slab for half a packet.
SIMD void packet_slab(packet *p, const wide_tree *t, const f8 v[8], int h,
                      int kz) {
  f8 far[3], a[3];
  for (int k = 0; k < 3; k++) {
    f8 lo = f8_abs(f8_sub(f8_all(t->lo[k]), v[RAY_O + k]));
    f8 hi = f8_abs(f8_sub(f8_all(t->hi[k]), v[RAY_O + k]));
    far[k] = f8_max(lo, hi);
    a[k] = f8_abs(v[RAY_D + k]);
  }
  f8 reach = f8_div(far[kz], a[kz]);
  f8_store(p->reach + HALF * h, reach);
  for (int k = 0; k < 3; k++) {
    packet_axis *x = &p->axis[k];
    f8 o = v[RAY_O + k];
    f8 e = f8_mul(f8_all(0x10p-24f), f8_mul(a[k], reach));
    e = f8_add(f8_mul(f8_all(0x6p-24f), far[k]), e);
    e = f8_add(e, f8_mul(f8_all(0x2p-24f), f8_abs(o)));
    e = f8_add(e, f8_all(FLT_MIN));
    f8 up = f8_add(o, e), down = f8_sub(o, e);
    f8_store(x->inv + HALF * h, f8_div(f8_all(1), v[RAY_D + k]));
    f8_store(x->enter + HALF * h, p->side[k] ? down : up);
    f8_store(x->leave + HALF * h, p->side[k] ? up : down);
  }
}

// The rest of what a packet knows of half of its rays.
SIMD void packet_shear(packet *p, const f8 v[8], int h, int kz) {
  const uint32_t *turned = p->turned;
  f8 dz = v[RAY_D + kz];
  for (int k = 0; k < 3; k++)
    f8_store(p->o[k] + HALF * h, v[RAY_O + turned[k]]);
  f8_store(p->sx + HALF * h, f8_div(v[RAY_D + turned[0]], dz));
  f8_store(p->sy + HALF * h, f8_div(v[RAY_D + turned[1]], dz));
  f8_store(p->sz + HALF * h, f8_load(p->axis[kz].inv + HALF * h));
  f8_store(p->tmin + HALF * h, v[RAY_MIN]);
  f8_store(p->tmax + HALF * h, v[RAY_MAX]);
  f8_store(p->begin + HALF * h, f8_max(v[RAY_MIN], f8_all(0)));
  f8_store(p->until + HALF * h, v[RAY_MAX]);
  for (uint32_t i = 0; i < HALF; i++) {
    uint32_t at = HALF * (uint32_t)h + i;
    p->best[at] = (hit){.t = p->rays[at].tmax, .triangle = HIT_NONE};
  }
}

// What holds for all rays; whether they are close enough to each other.
SIMD bool packet_bound(packet *p, float size) {
  bool close = packet_most(p->sx) - packet_least(p->sx) <= PACKET_SLOPE &&
               packet_most(p->sy) - packet_least(p->sy) <= PACKET_SLOPE;
  for (int k = 0; k < 3; k++) {
    packet_axis *x = &p->axis[k];
    float low = packet_least(p->o[k]), high = packet_most(p->o[k]);
    close &= high - low <= PACKET_ORIGIN * size;
    bool back = p->side[k] != 0;
    x->least = packet_least(x->inv);
    x->most = packet_most(x->inv);
    x->first = back ? packet_least(x->enter) : packet_most(x->enter);
    x->last = back ? packet_most(x->leave) : packet_least(x->leave);
  }
  p->all_begin = packet_least(p->begin);
  p->all_until = packet_most(p->until);
  return close;
}

// Make 16 rays ready; false where they are no packet.
SIMD bool packet_start(packet *p, const wide_tree *t, const ray *rays) {
  static const uint32_t turned[3][3] = {{1, 2, 0}, {2, 0, 1}, {0, 1, 2}};
  packet_rays r;
  if (t->nodes == NULL || !packet_likely(rays)) return false;
  f8_columns(r.v[0], &rays[0].o.x);
  f8_columns(r.v[1], &rays[HALF].o.x);
  p->kz = packet_direction(p, &r);
  if (p->kz < 0) return false;
  memcpy(p->turned, turned[p->kz], sizeof p->turned);
  p->rays = rays;
  for (int h = 0; h < 2; h++) {
    packet_slab(p, t, r.v[h], h, p->kz);
    packet_shear(p, r.v[h], h, p->kz);
  }
  p->large = t->large;
  p->alive = 0xffff;
  return packet_bound(p, 0x1p8f * t->large);
}

#endif
