// sampler.h — the numbers that a sample of a pixel is made of: a pure function
// of (seed, pixel, sample, dimension), like rng.h, but spread evenly over the
// samples of the pixel.

#ifndef SAMPLER_H
#define SAMPLER_H

#include "rng.h"
#include "sobol.h"
#include "vec.h"

#include <stdbool.h>

// Turned: of every eight dimensions from the third on, the first two are those
// of a direction, and the first four directions are a quarter turn apart.
typedef enum sampler_kind {
  SAMPLER_SOBOL,
  SAMPLER_RANDOM,
  SAMPLER_TURNED
} sampler_kind;

enum { SAMPLER_TURN_FROM = 2, SAMPLER_TURN_EACH = 8 };

// The first SAMPLER_JOINT dimensions are even jointly, the later ones in
// blocks of SAMPLER_BLOCK that are independent of each other.  Pairs that start
// at an even dimension are the most even.
enum { SAMPLER_JOINT = SOBOL_DIMENSIONS, SAMPLER_BLOCK = 4 };

// One sample on its way through its dimensions.  Key, index and kind say
// which; to go on elsewhere, keep those and call sampler_at.
typedef struct sampler {
  uint64_t key;        // of (seed, pixel); of the sample too when random
  uint32_t index;      // number of the sample
  uint32_t dimension;  // the next one
  sampler_kind kind;
} sampler;

// The sample of that number of a pixel (its index in the full film).
static inline sampler sampler_of(sampler_kind kind, uint64_t seed,
                                 uint64_t pixel, uint32_t sample) {
  uint32_t stream = kind == SAMPLER_RANDOM ? sample : 0;
  return (sampler){rng_of(seed, pixel, stream).key, sample, 0, kind};
}

// Make `dimension` the next one.
static inline void sampler_at(sampler *s, uint32_t dimension) {
  s->dimension = dimension;
}

// 32 random bits for each key and dimension: a bijection of the sum of the low
// half and the dimension.  Source: Wellons, "Hash Prospector", the constants 16
// 21f0aaad 15 d35a2d97 15.
static inline uint32_t sampler_seed(uint64_t key, uint32_t dimension) {
  uint32_t x = (uint32_t)key + 0x9e3779b9u * dimension;
  x = (x ^ (x >> 16)) * 0x21f0aaadu;
  x = (x ^ (x >> 15)) * 0xd35a2d97u;
  return x ^ (x >> 15) ^ (uint32_t)(key >> 32);
}

// The samples of a pixel in another order for each block: a scrambling of the
// index that leaves 0 alone, and so permutes each run from 2^k to 2^(k+1) - 1.
static inline uint32_t sampler_shuffle(uint32_t index, uint32_t seed) {
  uint32_t digits = sobol_scramble(sobol_reverse(index), seed);
  return sobol_reverse(digits ^ sobol_scramble(0, seed));
}

static inline bool sampler_turns(sampler_kind kind, uint32_t dimension) {
  return kind == SAMPLER_TURNED &&
         (dimension - SAMPLER_TURN_FROM) % SAMPLER_TURN_EACH < 2;
}

// The number of one dimension of one sample, uniform in [0, 1): a multiple of
// 2^-24.
static inline float sampler_even(const sampler *s, uint32_t dimension) {
  uint64_t key = s->key;
  uint32_t index = s->index, column = dimension;
  if (dimension >= SAMPLER_JOINT) {
    uint32_t block = (dimension - SAMPLER_JOINT) / SAMPLER_BLOCK;
    index = sampler_shuffle(index, sampler_seed(key, ~block));
    column = (dimension - SAMPLER_JOINT) % SAMPLER_BLOCK;
  }
  uint32_t seed = sampler_seed(key, dimension);
  uint32_t digits = sobol_digits(index, column);
  bool turns = sampler_turns(s->kind, dimension);
  return sobol_number(turns ? sobol_turn(digits, seed)
                            : sobol_scramble(digits, seed));
}

// The next dimension.
static inline float sampler_1(sampler *s) {
  uint32_t d = s->dimension++;
  if (s->kind != SAMPLER_RANDOM) return sampler_even(s, d);
  rng r = {s->key, d};
  return rng_next(&r);
}

// The next two.
static inline vec2 sampler_2(sampler *s) {
  float x = sampler_1(s);
  return (vec2){x, sampler_1(s)};
}

// The numbers of eight dimensions from `dimension` on, at once and the same:
// two to four times as fast as one by one.
void sampler_8(const sampler *s, uint32_t dimension, float out[8]);

#endif
