// simd_lanes.h — numbers that change their lanes.

#ifndef SIMD_LANES_H
#define SIMD_LANES_H

#include "simd.h"

#if defined(__AVX2__)

// Lane k: the lane of `a` with number at[k].
SIMD f8 f8_choose(f8 a, const uint32_t at[8]) {
  __m256i i = _mm256_loadu_si256((const __m256i *)(const void *)at);
  return (f8){_mm256_permutevar8x32_ps(a.v, i)};
}

// Eight rows of eight floats in memory, column by column.
SIMD void f8_columns(f8 out[8], const float *rows) {
  __m256 a[8], b[8];
  for (int i = 0; i < 8; i++)
    a[i] = _mm256_loadu_ps(rows + 8 * i);
  for (int i = 0; i < 8; i += 2) {
    b[i] = _mm256_unpacklo_ps(a[i], a[i + 1]);
    b[i + 1] = _mm256_unpackhi_ps(a[i], a[i + 1]);
  }
  for (int i = 0; i < 8; i += 4)
    for (int k = 0; k < 2; k++) {
      a[i + 2 * k] = _mm256_shuffle_ps(b[i + k], b[i + k + 2], 0x44);
      a[i + 2 * k + 1] = _mm256_shuffle_ps(b[i + k], b[i + k + 2], 0xee);
    }
  for (int i = 0; i < 4; i++) {
    out[i].v = _mm256_permute2f128_ps(a[i], a[i + 4], 0x20);
    out[i + 4].v = _mm256_permute2f128_ps(a[i], a[i + 4], 0x31);
  }
}

#else

SIMD f8 f8_choose(f8 a, const uint32_t at[8]) {
  float from[8], to[8];
  memcpy(from, &a, sizeof from);
  for (int k = 0; k < 8; k++)
    to[k] = from[at[k]];
  return f8_load(to);
}

SIMD void f8_columns(f8 out[8], const float *rows) {
  float v[8][8];
  for (int i = 0; i < 8; i++)
    for (int k = 0; k < 8; k++)
      v[k][i] = rows[8 * i + k];
  for (int k = 0; k < 8; k++)
    out[k] = f8_load(v[k]);
}

#endif

#endif
