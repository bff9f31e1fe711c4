// simd_avx2.h — eight floats in one register of 256 bits.  See simd.h.

#ifndef SIMD_AVX2_H
#define SIMD_AVX2_H

#include "simd_base.h"

#if defined(__AVX2__)

// Eight floats.
typedef struct f8 {
  __m256 v;
} f8;

SIMD f8 f8_load(const float *p) {
  return (f8){_mm256_loadu_ps(p)};
}

SIMD f8 f8_all(float x) {
  return (f8){_mm256_set1_ps(x)};
}

SIMD void f8_store(float *p, f8 a) {
  _mm256_storeu_ps(p, a.v);
}

SIMD f8 f8_of_bytes(const uint8_t *p) {
  __m128i b = _mm_loadl_epi64((const __m128i *)(const void *)p);
  return (f8){_mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(b))};
}

// a b + c, rounded once; asked only where a b is exact, so that it does not
// matter.
SIMD f8 f8_mad(f8 a, f8 b, f8 c) {
#if defined(__FMA__)
  return (f8){_mm256_fmadd_ps(a.v, b.v, c.v)};
#else
  return (f8){_mm256_add_ps(_mm256_mul_ps(a.v, b.v), c.v)};
#endif
}

SIMD f8 f8_add(f8 a, f8 b) {
  return (f8){_mm256_add_ps(a.v, b.v)};
}

SIMD f8 f8_sub(f8 a, f8 b) {
  return (f8){_mm256_sub_ps(a.v, b.v)};
}

SIMD f8 f8_mul(f8 a, f8 b) {
  return (f8){_mm256_mul_ps(a.v, b.v)};
}

SIMD f8 f8_div(f8 a, f8 b) {
  return (f8){_mm256_div_ps(a.v, b.v)};
}

SIMD f8 f8_abs(f8 a) {
  return (f8){_mm256_andnot_ps(_mm256_set1_ps(-0.0f), a.v)};
}

SIMD f8 f8_max(f8 a, f8 b) {
  return (f8){_mm256_max_ps(a.v, b.v)};
}

SIMD f8 f8_min(f8 a, f8 b) {
  return (f8){_mm256_min_ps(a.v, b.v)};
}

SIMD f8 f8_where_lt(f8 a, f8 b, f8 x, f8 y) {
  return (f8){_mm256_blendv_ps(y.v, x.v, _mm256_cmp_ps(a.v, b.v, _CMP_LT_OQ))};
}

SIMD uint32_t f8_le(f8 a, f8 b) {
  return (uint32_t)_mm256_movemask_ps(_mm256_cmp_ps(a.v, b.v, _CMP_LE_OQ));
}

SIMD uint32_t f8_lt(f8 a, f8 b) {
  return (uint32_t)_mm256_movemask_ps(_mm256_cmp_ps(a.v, b.v, _CMP_LT_OQ));
}

#endif

#endif
