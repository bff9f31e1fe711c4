// wide_packet.h — sixteen neighbouring rays that go down the tree together.

#ifndef WIDE_PACKET_H
#define WIDE_PACKET_H

#include "wide_box.h"

// Rays of a packet, and of half of one.
enum { PACKET = 16, HALF = 8 };

// What a packet needs of an axis: slab_ray of each ray; `inv` lies between
// least and most, and first and last are the corrected origins for which a
// plane is entered first and left last.
typedef struct packet_axis {
  float inv[PACKET], enter[PACKET], leave[PACKET];
  float least, most, first, last;
} packet_axis;

// Rays that run along the same axis kz and into the same octant, in the terms
// of wide_walk.  `begin` and `until` of all are the least and the most of
// those that are alive.
typedef struct packet {
  packet_axis axis[3];
  float o[3][PACKET];  // the origins, axes turned by the shear
  float sx[PACKET], sy[PACKET], sz[PACKET];
  float tmin[PACKET], tmax[PACKET], reach[PACKET];
  float begin[PACKET], until[PACKET];
  hit best[PACKET];
  float all_begin, all_until;
  uint32_t side[3], turned[3];  // as wide_walk: side and axis
  uint32_t alive;               // bit i: ray i goes on
  float large;
  const ray *rays;
} packet;

SIMD float f8_least(f8 a) {
  float v[8];
  f8_store(v, a);
  float w = v[0] < v[4] ? v[0] : v[4], x = v[1] < v[5] ? v[1] : v[5];
  float y = v[2] < v[6] ? v[2] : v[6], z = v[3] < v[7] ? v[3] : v[7];
  w = w < y ? w : y;
  x = x < z ? x : z;
  return w < x ? w : x;
}

SIMD float f8_most(f8 a) {
  float v[8];
  f8_store(v, a);
  float w = v[0] > v[4] ? v[0] : v[4], x = v[1] > v[5] ? v[1] : v[5];
  float y = v[2] > v[6] ? v[2] : v[6], z = v[3] > v[7] ? v[3] : v[7];
  w = w > y ? w : y;
  x = x > z ? x : z;
  return w > x ? w : x;
}

SIMD float packet_least(const float v[PACKET]) {
  return f8_least(f8_min(f8_load(v), f8_load(v + HALF)));
}

SIMD float packet_most(const float v[PACKET]) {
  return f8_most(f8_max(f8_load(v), f8_load(v + HALF)));
}

// Ray i as one that goes alone, as leaf_one wants it.
SIMD wide_walk packet_walk(const packet *p, uint32_t i) {
  wide_walk w = {.sx = p->sx[i], .sy = p->sy[i], .sz = p->sz[i]};
  for (int k = 0; k < 3; k++) {
    w.inv[k] = p->axis[k].inv[i];
    w.enter[k] = p->axis[k].enter[i];
    w.leave[k] = p->axis[k].leave[i];
    w.side[k] = p->side[k];
    w.axis[k] = p->turned[k];
  }
  w.large = p->large;
  w.r = &p->rays[i];
  return w;
}

#endif
