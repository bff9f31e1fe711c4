// build_lanes.h — a box of the builder in eight lanes: lo, and hi negated, so
// that one minimum grows all of it.  For AVX2.

#ifndef BUILD_LANES_H
#define BUILD_LANES_H

#include "sah_box.h"
#include "simd_lanes.h"

#if defined(__AVX2__)

SIMD f8 f8_halves(f4 a, f4 b) {
  return (f8){_mm256_set_m128(b, a)};
}

SIMD f4 f8_low(f8 a) {
  return _mm256_castps256_ps128(a.v);
}

SIMD f4 f8_high(f8 a) {
  return _mm256_extractf128_ps(a.v, 1);
}

// The lower halves of a and b; the upper ones.
SIMD f8 f8_lows(f8 a, f8 b) {
  return (f8){_mm256_permute2f128_ps(a.v, b.v, 0x20)};
}

SIMD f8 f8_highs(f8 a, f8 b) {
  return (f8){_mm256_permute2f128_ps(a.v, b.v, 0x31)};
}

// Lanes 3 and 7 of b, the others of a.
SIMD f8 f8_fourths(f8 a, f8 b) {
  return (f8){_mm256_blend_ps(a.v, b.v, 0x88)};
}

SIMD f8 f8_negate_high(f8 a) {
  return (f8){_mm256_xor_ps(a.v, f8_halves((f4){0}, -(f4){0}).v)};
}

SIMD f8 box_load(const sah_box *from) {
  return f8_negate_high(f8_load(from->lo));
}

SIMD void box_store(sah_box *to, f8 b) {
  f8_store(to->lo, f8_negate_high(b));
}

SIMD f8 box_empty(void) {
  return f8_all(INFINITY);
}

// a grown to hold b.  Of zeros that differ in sign a's stay, as in sah_grow.
SIMD f8 box_join(f8 a, f8 b) {
  return f8_min(b, a);
}

// hi - lo.
SIMD f4 box_sides(f8 b) {
  return -(f8_low(b) + f8_high(b));
}

// What lies in a slice: a box that has the number of its triangles in lane 3,
// exact up to 2^24, and 0 in lane 7.
SIMD f8 slice_empty(void) {
  return f8_fourths(box_empty(), f8_all(0));
}

SIMD f8 slice_add(f8 s, f8 box) {
  const f8 one = f8_halves((f4){0, 0, 0, 1}, (f4){0});
  return f8_fourths(box_join(s, box), f8_add(s, one));
}

SIMD f8 slice_join(f8 s, f8 t) {
  return f8_fourths(box_join(s, t), f8_add(s, t));
}

#endif

#endif
