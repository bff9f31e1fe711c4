// build_lanes.h — a box of the builder in eight lanes: lo, and hi negated.
//
// One minimum then grows all of it.  Lanes 3 and 7 are left for a number of
// triangles and for 0.

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

// The sum of the halves of a, that of the halves of b.
SIMD f8 f8_fold(f8 a, f8 b) {
  return (f8){_mm256_add_ps(_mm256_permute2f128_ps(a.v, b.v, 0x20),
                            _mm256_permute2f128_ps(a.v, b.v, 0x31))};
}

// Lanes 3 and 7 of b, the others of a.
SIMD f8 f8_fourth(f8 a, f8 b) {
  return (f8){_mm256_blend_ps(a.v, b.v, 0x88)};
}

// The sign of what is in the upper half turned.
SIMD f8 f8_turn_high(f8 a) {
  const __m256 sign = _mm256_set_m128(_mm_set1_ps(-0.0f), _mm_setzero_ps());
  return (f8){_mm256_xor_ps(a.v, sign)};
}

#else

SIMD f8 f8_halves(f4 a, f4 b) {
  return (f8){a, b};
}

SIMD f4 f8_low(f8 a) {
  return a.a;
}

SIMD f4 f8_high(f8 a) {
  return a.b;
}

SIMD f8 f8_fold(f8 a, f8 b) {
  return (f8){a.a + a.b, b.a + b.b};
}

SIMD f8 f8_fourth(f8 a, f8 b) {
  const i4 three = {-1, -1, -1, 0};
  return (f8){f4_pick(three, a.a, b.a), f4_pick(three, a.b, b.b)};
}

SIMD f8 f8_turn_high(f8 a) {
  const i4 sign = {INT32_MIN, INT32_MIN, INT32_MIN, INT32_MIN};
  return (f8){a.a, (f4)((i4)a.b ^ sign)};
}

#endif

SIMD f8 box8_load(const sah_box *from) {
  return f8_turn_high(f8_load(from->lo));
}

SIMD void box8_store(sah_box *to, f8 b) {
  f8_store(to->lo, f8_turn_high(b));
}

SIMD f8 box8_empty(void) {
  return f8_all(INFINITY);
}

// a grown to hold b.
SIMD f8 box8_join(f8 a, f8 b) {
#if defined(__AVX2__)
  return (f8){_mm256_min_ps(b.v, a.v)};
#else
  return (f8){sah_min(b.a, a.a), sah_min(b.b, a.b)};
#endif
}

// hi - lo.
SIMD f4 box8_sides(f8 b) {
  return -(f8_low(b) + f8_high(b));
}

// A box with the number of its triangles in lane 3 and 0 in lane 7: of none; of
// one more; of those of two.
SIMD f8 slice_empty(void) {
  return f8_fourth(box8_empty(), f8_all(0));
}

SIMD f8 slice_add(f8 s, f8 box) {
  const f8 one = f8_halves((f4){0, 0, 0, 1}, (f4){0});
  return f8_fourth(box8_join(s, box), f8_add(s, one));
}

SIMD f8 slice_join(f8 s, f8 t) {
  return f8_fourth(box8_join(s, t), f8_add(s, t));
}

#endif
