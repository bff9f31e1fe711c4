// simd_lanes.h — numbers that change their lanes.

#ifndef SIMD_LANES_H
#define SIMD_LANES_H

#include "simd.h"

// The same 32 bits, not a float perhaps, in all lanes.
SIMD f8 f8_bits(uint32_t bits) {
  float x;
  memcpy(&x, &bits, sizeof x);
  return f8_all(x);
}

#if defined(__AVX2__)

// Lane k: the lane of `a` with number at[k].
SIMD f8 f8_choose(f8 a, const uint32_t at[8]) {
  __m256i i = _mm256_loadu_si256((const __m256i *)(const void *)at);
  return (f8){_mm256_permutevar8x32_ps(a.v, i)};
}

// Bit k: whether lane k of eight numbers is x.
SIMD uint32_t lanes_equal(const uint32_t v[8], uint32_t x) {
  __m256i a = _mm256_loadu_si256((const __m256i *)(const void *)v);
  __m256i e = _mm256_cmpeq_epi32(a, _mm256_set1_epi32((int)x));
  return (uint32_t)_mm256_movemask_ps(_mm256_castsi256_ps(e));
}

// Two of the three rounds of a transposition, on four of the rows.
SIMD void f8_mix(f8 to[4], f8 a, f8 b, f8 c, f8 d) {
  __m256 ab = _mm256_unpacklo_ps(a.v, b.v), ba = _mm256_unpackhi_ps(a.v, b.v);
  __m256 cd = _mm256_unpacklo_ps(c.v, d.v), dc = _mm256_unpackhi_ps(c.v, d.v);
  to[0].v = _mm256_shuffle_ps(ab, cd, 0x44);
  to[1].v = _mm256_shuffle_ps(ab, cd, 0xee);
  to[2].v = _mm256_shuffle_ps(ba, dc, 0x44);
  to[3].v = _mm256_shuffle_ps(ba, dc, 0xee);
}

// Row k becomes column k.
SIMD void f8_transpose(f8 v[8]) {
  f8 a[4], b[4];
  f8_mix(a, v[0], v[1], v[2], v[3]);
  f8_mix(b, v[4], v[5], v[6], v[7]);
  v[0].v = _mm256_permute2f128_ps(a[0].v, b[0].v, 0x20);
  v[1].v = _mm256_permute2f128_ps(a[1].v, b[1].v, 0x20);
  v[2].v = _mm256_permute2f128_ps(a[2].v, b[2].v, 0x20);
  v[3].v = _mm256_permute2f128_ps(a[3].v, b[3].v, 0x20);
  v[4].v = _mm256_permute2f128_ps(a[0].v, b[0].v, 0x31);
  v[5].v = _mm256_permute2f128_ps(a[1].v, b[1].v, 0x31);
  v[6].v = _mm256_permute2f128_ps(a[2].v, b[2].v, 0x31);
  v[7].v = _mm256_permute2f128_ps(a[3].v, b[3].v, 0x31);
}

#else

SIMD uint32_t lanes_equal(const uint32_t v[8], uint32_t x) {
  uint32_t m = 0;
  for (int k = 0; k < 8; k++)
    m |= (uint32_t)(v[k] == x) << k;
  return m;
}

SIMD f8 f8_choose(f8 a, const uint32_t at[8]) {
  float from[8], to[8];
  memcpy(from, &a, sizeof from);
  for (int k = 0; k < 8; k++)
    to[k] = from[at[k]];
  return f8_load(to);
}

SIMD void f8_transpose(f8 v[8]) {
  float from[8][8], to[8][8];
  memcpy(from, v, sizeof from);
  for (int i = 0; i < 8; i++)
    for (int k = 0; k < 8; k++)
      to[k][i] = from[i][k];
  memcpy(v, to, sizeof to);
}

#endif

// Eight floats of each of eight rows, `at` bytes from its beginning, column by
// column.
SIMD void f8_columns(f8 v[8], const char *const row[8], size_t at) {
  v[0] = f8_load((const float *)(const void *)(row[0] + at));
  v[1] = f8_load((const float *)(const void *)(row[1] + at));
  v[2] = f8_load((const float *)(const void *)(row[2] + at));
  v[3] = f8_load((const float *)(const void *)(row[3] + at));
  v[4] = f8_load((const float *)(const void *)(row[4] + at));
  v[5] = f8_load((const float *)(const void *)(row[5] + at));
  v[6] = f8_load((const float *)(const void *)(row[6] + at));
  v[7] = f8_load((const float *)(const void *)(row[7] + at));
  f8_transpose(v);
}

// Columns, row by row.
SIMD void f8_store_rows(float to[8][8], f8 v[8]) {
  f8_transpose(v);
  f8_store(to[0], v[0]);
  f8_store(to[1], v[1]);
  f8_store(to[2], v[2]);
  f8_store(to[3], v[3]);
  f8_store(to[4], v[4]);
  f8_store(to[5], v[5]);
  f8_store(to[6], v[6]);
  f8_store(to[7], v[7]);
}

#endif
