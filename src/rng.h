// rng.h — random numbers as a pure function of (seed, pixel, sample,
// dimension): no state is shared, so threads, tiles and the total number of
// samples cannot change a picture.

#ifndef RNG_H
#define RNG_H

#include <stdint.h>

// One sample's stream: the key of (seed, pixel, sample) and the next dimension.
typedef struct rng {
  uint64_t key;
  uint32_t dimension;
} rng;

// A bijection of 64 bits in which every input bit moves every output bit with
// probability near 1/2.  Source: Stafford's mix 13, as in SplitMix64 (Steele,
// Lea, Flood 2014).
static inline uint64_t rng_mix(uint64_t z) {
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return z ^ (z >> 31);
}

// The stream of one sample of one pixel (its index in the full film).
static inline rng rng_of(uint64_t seed, uint64_t pixel, uint64_t sample) {
  uint64_t k = rng_mix(seed + UINT64_C(0x9e3779b97f4a7c15));
  k = rng_mix(k ^ (pixel + UINT64_C(0xd1b54a32d192ed03)));
  return (rng){rng_mix(k ^ (sample + UINT64_C(0x8cb92ba72f3d8dd7))), 0};
}

// The next dimension, uniform in [0, 1): the multiples of 2^-24.
static inline float rng_next(rng *r) {
  uint64_t z = rng_mix(r->key + UINT64_C(0x9e3779b97f4a7c15) * ++r->dimension);
  return (float)(z >> 40) * 0x1p-24f;
}

#endif
