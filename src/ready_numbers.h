// ready_numbers.h — sampler_8 of sixteen samplers that are at the same
// dimension, in vectors of sixteen whole numbers.

#ifndef READY_NUMBERS_H
#define READY_NUMBERS_H

#include "ready_work.h"
#include "simd.h"

#include <string.h>

typedef uint32_t sixteen __attribute__((vector_size(4 * LANES)));

// The functions of sobol.h and sampler.h, lane by lane.
SIMD void sixteen_scramble(sixteen *digits, const sixteen *seed) {
  sixteen d = *digits;
  d ^= d * 0x3d20adeau;
  d += *seed;
  d *= (*seed >> 16) | 1;
  d ^= d * 0x05526c56u;
  d ^= d * 0x53a22864u;
  *digits = d;
}

SIMD void sixteen_turn(sixteen *digits, const sixteen *seed) {
  sixteen d = *digits, rest = d & ~3u, same = rest ^ (rest - 1);
  sixteen_scramble(digits, seed);
  *digits = (*digits & ~same) | ((d ^ *seed) & same);
}

SIMD void sixteen_reverse(sixteen *v) {
  sixteen x = *v;
  x = (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
  x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
  x = (x & 0x0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0fu);
  x = (x & 0x00ff00ffu) << 8 | (x >> 8 & 0x00ff00ffu);
  *v = x << 16 | x >> 16;
}

// Keys, in halves, and the numbers of the samples.
typedef struct sixteen_keys {
  sixteen lo, hi, index;
  uint32_t bits;  // all that any index has
  sampler_kind kind;
} sixteen_keys;

SIMD void sixteen_seed(const sixteen_keys *k, uint32_t dimension,
                       sixteen *seed) {
  sixteen x = k->lo + 0x9e3779b9u * dimension;
  x = (x ^ (x >> 16)) * 0x21f0aaadu;
  x = (x ^ (x >> 15)) * 0xd35a2d97u;
  *seed = x ^ (x >> 15) ^ k->hi;
}

// sampler_shuffle of the block that a dimension is in.
SIMD void sixteen_shuffle(const sixteen_keys *k, uint32_t dimension,
                          sixteen *index) {
  *index = k->index;
  if (dimension < SAMPLER_JOINT) return;
  sixteen seed, zero = {0};
  sixteen_seed(k, ~((dimension - SAMPLER_JOINT) / SAMPLER_BLOCK), &seed);
  sixteen_reverse(index);
  sixteen_scramble(index, &seed);
  sixteen_scramble(&zero, &seed);
  *index ^= zero;
  sixteen_reverse(index);
}

// One dimension of all, given their shuffled indices.
SIMD void sixteen_number(const sixteen_keys *k, uint32_t dimension,
                         const sixteen *number, float *out) {
  uint32_t column = dimension < SAMPLER_JOINT
                        ? dimension
                        : (dimension - SAMPLER_JOINT) % SAMPLER_BLOCK;
  sixteen digits = {0}, index = *number, seed;
  const uint32_t *row = &SOBOL_COLUMNS[0][column];
  for (uint32_t left = k->bits; left != 0; left >>= 1, row += SOBOL_ROW) {
    digits ^= *row & (0 - (index & 1));
    index >>= 1;
  }
  sixteen_seed(k, dimension, &seed);
  if (sampler_turns(k->kind, dimension))
    sixteen_turn(&digits, &seed);
  else
    sixteen_scramble(&digits, &seed);
  sixteen_reverse(&digits);
  digits >>= 8;
  int32_t bits[LANES];
  memcpy(bits, &digits, sizeof bits);
  for (int i = 0; i < LANES; i++)
    out[i] = (float)bits[i] * 0x1p-24f;
}

// Those of bits `uses`; the others are as they were.
static inline void ready_numbers(ready_work *w, sampler_kind kind,
                                 uint32_t dimension, uint32_t uses) {
  sixteen_keys k = {.kind = kind};
  memcpy(&k.lo, w->key_lo, sizeof k.lo);
  memcpy(&k.hi, w->key_hi, sizeof k.hi);
  memcpy(&k.index, w->index, sizeof k.index);
  for (int i = 0; i < LANES; i++)
    k.bits |= w->index[i];
  sixteen index = {0};
  uint32_t block = UINT32_MAX;
  for (uint32_t i = 0; i < USES; i++) {
    uint32_t d = dimension + i;
    if ((uses >> i & 1) == 0) continue;
    if (d / SAMPLER_BLOCK != block) sixteen_shuffle(&k, d, &index);
    block = d / SAMPLER_BLOCK;
    sixteen_number(&k, d, &index, w->r.u[i]);
  }
}

#endif
