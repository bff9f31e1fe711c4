// wide_push.h — the children that a ray enters, sorted and put on its stack.
//
// A stack is two arrays, of keys and of children.  A key is where the ray
// enters, at least 0, as the bits of a float, which sort as integers do; the
// last four make room: 8 for a child that is there, plus its lane.

#ifndef WIDE_PUSH_H
#define WIDE_PUSH_H

#include "simd_squeeze.h"
#include "wide_box.h"

// Where the ray enters by a key, rounded down: never too late.
SIMD float key_near(uint32_t key) {
  float t;
  key &= ~15u;
  memcpy(&t, &key, sizeof t);
  return t;
}

#if defined(__AVX2__)

// One layer of a sorting network: each lane is compared with the same lane of
// `shuffled`, its partner; the smaller key goes where `least` has a bit.
#define SORT_LAYER(v, shuffled, least) \
  do { \
    __m256i other = (shuffled); \
    (v) = _mm256_blend_epi32(_mm256_max_epu32((v), other), \
                             _mm256_min_epu32((v), other), (least)); \
  } while (0)

// Eight keys, the largest first: the bitonic network, six layers.
SIMD __m256i sort_keys(__m256i v) {
  SORT_LAYER(v, _mm256_shuffle_epi32(v, 0xb1), 0xaa);
  SORT_LAYER(v, _mm256_shuffle_epi32(v, 0x1b), 0xcc);
  SORT_LAYER(v, _mm256_shuffle_epi32(v, 0xb1), 0xaa);
  __m256i swap = _mm256_permute4x64_epi64(v, 0x4e);
  SORT_LAYER(v, _mm256_shuffle_epi32(swap, 0x1b), 0xf0);
  SORT_LAYER(v, _mm256_shuffle_epi32(v, 0x4e), 0xcc);
  SORT_LAYER(v, _mm256_shuffle_epi32(v, 0xb1), 0xaa);
  return v;
}

// Put the children of mask m on a stack, the nearest last, and return how many
// there are.  Writes eight places.
SIMD uint32_t push_children(uint32_t *key, uint32_t *child,
                            const uint32_t from[WIDE], uint32_t m, f8 near) {
  const __m256i lane = _mm256_setr_epi32(8, 9, 10, 11, 12, 13, 14, 15);
  __m256i v = _mm256_castps_si256(near.v);
  v = _mm256_or_si256(_mm256_and_si256(v, _mm256_set1_epi32(~15)), lane);
#if defined(__AVX512VL__)
  v = _mm256_maskz_mov_epi32((__mmask8)m, v);
#else
  const __m256i bit = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
  __m256i in = _mm256_and_si256(_mm256_set1_epi32((int)m), bit);
  v = _mm256_and_si256(v, _mm256_cmpeq_epi32(in, bit));
#endif
  v = sort_keys(v);
  __m256i c = _mm256_loadu_si256((const __m256i *)(const void *)from);
  _mm256_storeu_si256((__m256i *)(void *)key, v);
  _mm256_storeu_si256((__m256i *)(void *)child,
                      _mm256_permutevar8x32_epi32(c, v));
  return (uint32_t)__builtin_popcount(m);
}

#else

SIMD uint32_t push_children(uint32_t *key, uint32_t *child,
                            const uint32_t from[WIDE], uint32_t m, f8 near) {
  uint32_t bits[8], count = 0;
  memcpy(bits, &near, sizeof bits);
  for (; m != 0; m &= m - 1) {
    uint32_t i = (uint32_t)__builtin_ctz(m), at = count++;
    for (; at > 0 && key[at - 1] < bits[i]; at--) {
      key[at] = key[at - 1];
      child[at] = child[at - 1];
    }
    key[at] = bits[i];
    child[at] = from[i];
  }
  return count;
}

#endif

// The same in whatever order, for rays that stop at any hit: they need no key.
SIMD uint32_t push_unsorted(uint32_t *child, const wide_node *n, uint32_t m) {
  f8 c = f8_load((const float *)(const void *)n->child);
  f8_squeeze(child, c, f8_lanes_of(m));
  return (uint32_t)__builtin_popcount(m);
}

#endif
