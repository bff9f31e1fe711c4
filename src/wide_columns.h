// wide_columns.h — what eight rays need on their way, column by column.

#ifndef WIDE_COLUMNS_H
#define WIDE_COLUMNS_H

#include "wide_box.h"

// The numbers of a ray, one after the other in memory.
enum { RAY_O = 0, RAY_D = 3, RAY_MIN = 6, RAY_MAX = 7 };

_Static_assert(sizeof(ray) == 8 * sizeof(float), "a row");

// wide_walk of eight rays, column by column, and bit k of `can`: whether ray k
// can hit anything at all; the same ones as for a bvh.
typedef struct ready_rays {
  f8 column[ROWS][8];
  uint32_t can;
} ready_rays;

// Three numbers of each ray by axis, turned so that the longest comes last.
SIMD void turn_axes(f8 out[3], const f8 in[3], f8 turn_x, f8 turn_y) {
  f8 zero = f8_all(0);
  out[0] =
      f8_where_lt(turn_x, zero, in[1], f8_where_lt(turn_y, zero, in[2], in[0]));
  out[1] =
      f8_where_lt(turn_x, zero, in[2], f8_where_lt(turn_y, zero, in[0], in[1]));
  out[2] =
      f8_where_lt(turn_x, zero, in[0], f8_where_lt(turn_y, zero, in[1], in[2]));
}

// slab_ray_of along axis k, of origin o and |d| a: `far` is the farthest that
// the tree lies from o along it.
SIMD void ready_axis(ready_rays *q, int k, f8 o, f8 a, f8 far) {
  f8 *inv = q->column[1], *enter = inv + 4, *leave = q->column[2];
  f8 e = f8_mul(f8_all(0x10p-24f), f8_mul(a, inv[3]));
  e = f8_add(f8_mul(f8_all(0x6p-24f), far), e);
  e = f8_add(e, f8_mul(f8_all(0x2p-24f), f8_abs(o)));
  e = f8_add(e, f8_all(FLT_MIN));
  f8 zero = f8_all(0), up = f8_add(o, e), down = f8_sub(o, e);
  enter[k] = f8_where_lt(inv[k], zero, down, up);
  leave[k] = f8_where_lt(inv[k], zero, up, down);
  q->column[3][k] = f8_where_lt(inv[k], zero, f8_bits(WIDE), f8_bits(0));
}

// d of axis k without what is denormal, and |d|.  *odd learns which rays have
// a number that is not finite, *some which have a direction.
SIMD f8 ready_direction(f8 d[3], const f8 v[8], int k, uint32_t *odd,
                        uint32_t *some) {
  f8 a = f8_abs(v[RAY_D + k]), least = f8_all(FLT_MIN);
  d[k] = f8_where_lt(a, least, f8_all(0), v[RAY_D + k]);
  *odd |= ~(f8_le(a, f8_all(FLT_MAX)) &
            f8_le(f8_abs(v[RAY_O + k]), f8_all(FLT_MAX)));
  *some |= f8_le(least, a);
  return f8_abs(d[k]);
}

// The farthest that the tree lies from the origins along axis k.
SIMD f8 ready_far(const wide_tree *t, const f8 v[8], int k) {
  f8 lo = f8_abs(f8_sub(f8_all(t->lo[k]), v[RAY_O + k]));
  f8 hi = f8_abs(f8_sub(f8_all(t->hi[k]), v[RAY_O + k]));
  return f8_max(lo, hi);
}

#endif
