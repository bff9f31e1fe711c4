// wide_alike.h — whether sixteen rays go the same way.

#ifndef WIDE_ALIKE_H
#define WIDE_ALIKE_H

#include "wide_packet.h"
#include "wide_ready.h"

// The octant of a direction.
SIMD uint32_t octant_of(const ray *r) {
  uint32_t d[3];
  memcpy(d, &r->d, sizeof d);
  return d[0] >> 31 | d[1] >> 31 << 1 | d[2] >> 31 << 2;
}

// A look at four of 16 rays, which finds out most groups that are no packet.
SIMD bool packet_likely(const ray *rays) {
  uint32_t first = octant_of(&rays[0]);
  return octant_of(&rays[5]) == first && octant_of(&rays[10]) == first &&
         octant_of(&rays[15]) == first;
}

// Rays next to each other, number by number: origins, directions, ends.
typedef struct packet_rays {
  f8 v[2][8];
} packet_rays;

// The axis along which all 16 rays run fastest; -1 where they differ in it or
// in their octants, or where a ray is not finite, runs along a plane of the
// axes or has no span.
SIMD int packet_direction(packet *p, const packet_rays *r) {
  f8 most = f8_all(FLT_MAX), least = f8_all(FLT_MIN), zero = f8_all(0);
  uint32_t fine = 0xffff, x = 0, y = 0, back[3] = {0, 0, 0};
  for (int h = 0; h < 2; h++) {
    const f8 *v = r->v[h];
    f8 a[3];
    uint32_t good = f8_le(f8_max(v[RAY_MIN], zero), v[RAY_MAX]);
    for (int k = 0; k < 3; k++) {
      a[k] = f8_abs(v[RAY_D + k]);
      good &= f8_le(f8_abs(v[RAY_O + k]), most);
      good &= f8_le(a[k], most) & f8_le(least, a[k]);
      back[k] |= f8_lt(v[RAY_D + k], zero) << HALF * h;
    }
    fine &= good << HALF * h | 0xffu << HALF * (1 - h);
    uint32_t xy = f8_lt(a[1], a[0]), xz = f8_lt(a[2], a[0]);
    x |= (xy & xz) << HALF * h;
    y |= (~xy & f8_lt(a[2], a[1])) << HALF * h;
  }
  if (fine != 0xffff) return -1;
  for (int k = 0; k < 3; k++) {
    if (back[k] != 0 && back[k] != 0xffff) return -1;
    p->side[k] = back[k] & WIDE;
  }
  return x == 0xffff ? 0 : y == 0xffff ? 1 : (x | y) == 0 ? 2 : -1;
}

#endif
