// sampler.c — four dimensions at a time, in the lanes of a vector register.

#include "sampler.h"

#include <string.h>

typedef uint32_t four __attribute__((vector_size(16)));
typedef int32_t signed_four __attribute__((vector_size(16)));
typedef float float_four __attribute__((vector_size(16)));

// Lanes a to d of v.
#define SPREAD(v, a, b, c, d) ((four){(v)[a], (v)[b], (v)[c], (v)[d]})

// Eight dimensions, from the first up.
typedef struct eight {
  four lo, hi;
} eight;

static four seeds_of(uint64_t key, four dimension) {
  four x = (uint32_t)key + 0x9e3779b9u * dimension;
  x = (x ^ (x >> 16)) * 0x21f0aaadu;
  x = (x ^ (x >> 15)) * 0xd35a2d97u;
  return x ^ (x >> 15) ^ (uint32_t)(key >> 32);
}

static four scramble(four digits, four seed) {
  digits ^= digits * 0x3d20adeau;
  digits += seed;
  digits *= (seed >> 16) | 1;
  digits ^= digits * 0x05526c56u;
  digits ^= digits * 0x53a22864u;
  return digits;
}

static four reverse(four x) {
  x = (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
  x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
  x = (x & 0x0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0fu);
  x = (x & 0x00ff00ffu) << 8 | (x >> 8 & 0x00ff00ffu);
  return x << 16 | x >> 16;
}

// The number of the point in four blocks, from that of `dimension` on.
static four shuffled(const sampler *s, uint32_t dimension) {
  uint32_t block = dimension / SAMPLER_BLOCK;
  four blocks = {block, block + 1, block + 2, block + 3};
  uint32_t in_order = sobol_reverse(s->index);
  four digits = {in_order, in_order, in_order, in_order}, zero = {0};
  four seed = seeds_of(s->key, ~(blocks - SAMPLER_JOINT / SAMPLER_BLOCK));
  four index = reverse(scramble(digits, seed) ^ scramble(zero, seed));
  four joint = (four)(blocks < SAMPLER_JOINT / SAMPLER_BLOCK);
  return (index & ~joint) | (s->index & joint);
}

// The number of the point for each of eight dimensions.
static eight indices_of(const sampler *s, uint32_t dimension) {
  if (dimension + 8 <= SAMPLER_JOINT)
    return (eight){s->index + (four){0}, s->index + (four){0}};
  four of = shuffled(s, dimension);
  switch (dimension % SAMPLER_BLOCK) {
  case 0: return (eight){SPREAD(of, 0, 0, 0, 0), SPREAD(of, 1, 1, 1, 1)};
  case 1: return (eight){SPREAD(of, 0, 0, 0, 1), SPREAD(of, 1, 1, 1, 2)};
  case 2: return (eight){SPREAD(of, 0, 0, 1, 1), SPREAD(of, 1, 1, 2, 2)};
  default: return (eight){SPREAD(of, 0, 1, 1, 1), SPREAD(of, 1, 2, 2, 2)};
  }
}

// Every shuffled index is below the same power of two as the first.
static eight digits_of(const sampler *s, uint32_t dimension) {
  eight index = indices_of(s, dimension), row, digits = {{0}, {0}};
  uint32_t column = dimension < SAMPLER_JOINT
                        ? dimension
                        : SAMPLER_JOINT + dimension % SAMPLER_BLOCK;
  const uint32_t *from = &SOBOL_COLUMNS[0][column];
  for (uint32_t left = s->index; left != 0; left >>= 1) {
    memcpy(&row, from, sizeof row);
    digits.lo ^= row.lo & (0 - (index.lo & 1));
    digits.hi ^= row.hi & (0 - (index.hi & 1));
    index.lo >>= 1;
    index.hi >>= 1;
    from += SOBOL_ROW;
  }
  return digits;
}

// sobol_turn.
static four turn(four digits, four seed) {
  four rest = digits & ~3u, same = rest ^ (rest - 1);
  return (scramble(digits, seed) & ~same) | ((digits ^ seed) & same);
}

static void numbers_of(sampler_kind kind, four dimension, four digits,
                       four seed, float *out) {
  four turns = (four)((dimension - SAMPLER_TURN_FROM) % SAMPLER_TURN_EACH < 2);
  if (kind != SAMPLER_TURNED) turns = (four){0};
  four bits = (scramble(digits, seed) & ~turns) | (turn(digits, seed) & turns);
  bits = reverse(bits) >> 8;
  float_four numbers =
      __builtin_convertvector((signed_four)bits, float_four) * 0x1p-24f;
  memcpy(out, &numbers, sizeof numbers);
}

static void sobol_8(const sampler *s, uint32_t dimension, float out[8]) {
  eight digits = digits_of(s, dimension);
  four d = {dimension, dimension + 1, dimension + 2, dimension + 3};
  numbers_of(s->kind, d, digits.lo, seeds_of(s->key, d), out);
  numbers_of(s->kind, d + 4, digits.hi, seeds_of(s->key, d + 4), out + 4);
}

// SSE 4.1 multiplies four integers at once, x86-64 alone cannot.
#if defined(__x86_64__)
static void sobol_8_sse41(const sampler *s, uint32_t dimension, float out[8])
    __attribute__((target("sse4.1"), flatten));

static void sobol_8_sse41(const sampler *s, uint32_t dimension, float out[8]) {
  sobol_8(s, dimension, out);
}
#endif

static void sobol_8_best(const sampler *s, uint32_t dimension, float out[8]) {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("sse4.1")) {
    sobol_8_sse41(s, dimension, out);
    return;
  }
#endif
  sobol_8(s, dimension, out);
}

void sampler_8(const sampler *s, uint32_t dimension, float out[8]) {
  if (s->kind != SAMPLER_RANDOM) {
    sobol_8_best(s, dimension, out);
    return;
  }
  sampler one = *s;
  sampler_at(&one, dimension);
  for (int i = 0; i < 8; i++)
    out[i] = sampler_1(&one);
}
