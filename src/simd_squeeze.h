// simd_squeeze.h — some of eight lanes, side by side.

#ifndef SIMD_SQUEEZE_H
#define SIMD_SQUEEZE_H

#include "simd.h"

#if defined(__AVX2__)

// Which lanes f8_squeeze writes.
typedef __m256i f8_lanes;

// Those of mask m: their numbers, a byte each, without those that stay behind.
SIMD f8_lanes f8_lanes_of(uint32_t m) {
  uint64_t all = _pdep_u64(m, UINT64_C(0x0101010101010101)) * 255;
  uint64_t at = _pext_u64(UINT64_C(0x0706050403020100), all);
  return _mm256_cvtepu8_epi32(_mm_cvtsi64_si128((int64_t)at));
}

// Write the chosen lanes of a, and up to eight floats in all.
SIMD void f8_squeeze(void *to, f8 a, f8_lanes lanes) {
  _mm256_storeu_ps((float *)to, _mm256_permutevar8x32_ps(a.v, lanes));
}

#else

typedef struct f8_lanes {
  uint32_t at[8], count;
} f8_lanes;

SIMD f8_lanes f8_lanes_of(uint32_t m) {
  f8_lanes to;
  for (to.count = 0; m != 0; m &= m - 1)
    to.at[to.count++] = (uint32_t)__builtin_ctz(m);
  return to;
}

SIMD void f8_squeeze(void *to, f8 a, f8_lanes lanes) {
  float from[8];
  memcpy(from, &a, sizeof from);
  for (uint32_t k = 0; k < lanes.count; k++)
    memcpy((char *)to + k * sizeof(float), &from[lanes.at[k]], sizeof(float));
}

#endif

#endif
