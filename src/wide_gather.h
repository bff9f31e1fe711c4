// wide_gather.h — sixteen rays made ready together, if they are neighbours.

#ifndef WIDE_GATHER_H
#define WIDE_GATHER_H

#include "wide_alike.h"

// Rays of a packet may differ by so much in slope, and their origins by so
// much of the tree's longest side.
#define PACKET_SLOPE 0.25f
#define PACKET_ORIGIN 0x1p-5f

// What a packet knows of half of its rays.
SIMD void packet_half(packet *p, const wide_tree *t, const f8 v[8], int h) {
  ready_rays q;
  ready_columns(&q, t, v);
  int at = HALF * h;
  for (int k = 0; k < 3; k++) {
    packet_axis *x = &p->axis[k];
    f8_store(p->o[k] + at, q.column[0][k]);
    f8_store(x->inv + at, q.column[1][k]);
    f8_store(x->enter + at, q.column[1][4 + k]);
    f8_store(x->leave + at, q.column[2][k]);
  }
  f8_store(p->sx + at, q.column[0][3]);
  f8_store(p->sy + at, q.column[0][4]);
  f8_store(p->sz + at, q.column[0][5]);
  f8_store(p->tmin + at, v[RAY_MIN]);
  f8_store(p->tmax + at, v[RAY_MAX]);
  f8_store(p->reach + at, q.column[1][3]);
  f8_store(p->begin + at, q.column[3][6]);
  f8_store(p->until + at, v[RAY_MAX]);
  for (int i = at; i < at + HALF; i++)
    p->best[i] = (hit){.t = p->rays[i].tmax, .triangle = HIT_NONE};
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
  const char *row[PACKET];
  for (int i = 0; i < PACKET; i++)
    row[i] = (const char *)&rays[i];
  f8_columns(r.v[0], row, 0);
  f8_columns(r.v[1], row + HALF, 0);
  int kz = packet_direction(p, &r);
  if (kz < 0) return false;
  memcpy(p->turned, turned[kz], sizeof p->turned);
  p->rays = rays;
  packet_half(p, t, r.v[0], 0);
  packet_half(p, t, r.v[1], 1);
  p->large = t->large;
  p->alive = 0xffff;
  return packet_bound(p, 0x1p8f * t->large);
}

#endif
