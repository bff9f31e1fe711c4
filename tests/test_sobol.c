// test_sobol.c — laws of the points that pictures are sampled with.

#include "sampler.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

// Primitive polynomials and first direction numbers of dimensions 1 to 15, as
// Joe and Kuo write them: degree, inner coefficients, m.
static const struct {
  int degree;
  uint32_t inner, m[6];
} POLYNOMIALS[SOBOL_DIMENSIONS - 1] = {
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
    {5, 4, {1, 1, 5, 5, 5}},
    {5, 7, {1, 1, 7, 11, 19}},
    {5, 11, {1, 1, 5, 1, 1}},
    {5, 13, {1, 1, 1, 3, 11}},
    {5, 14, {1, 3, 5, 5, 31}},
    {6, 1, {1, 3, 3, 9, 7, 49}},
    {6, 13, {1, 1, 1, 15, 21, 21}},
    {6, 16, {1, 3, 1, 13, 27, 49}}};

// Direction number k + 1 of a dimension, by the recurrence of its polynomial.
static uint32_t direction(int dimension, int k) {
  if (dimension == 0) return 1;
  int s = POLYNOMIALS[dimension - 1].degree;
  uint32_t inner = POLYNOMIALS[dimension - 1].inner, m[SOBOL_BITS];
  for (int i = 0; i <= k; i++) {
    if (i < s) {
      m[i] = POLYNOMIALS[dimension - 1].m[i];
      continue;
    }
    m[i] = m[i - s] ^ m[i - s] << s;
    for (int j = 1; j < s; j++)
      if (inner >> (s - 1 - j) & 1) m[i] ^= m[i - j] << j;
  }
  return m[k];
}

// The table is what the polynomials say.
static void columns_follow_their_polynomials(void **state) {
  (void)state;
  for (int d = 0; d < SOBOL_DIMENSIONS; d++)
    for (int k = 0; k < SOBOL_BITS; k++) {
      uint32_t column = sobol_reverse(direction(d, k) << (SOBOL_BITS - 1 - k));
      assert_int_equal(SOBOL_COLUMNS[d][k], column);
    }
}

// The digits of point i of a dimension, scrambled by seed if there is one.
static uint32_t point(uint32_t i, int dimension, uint32_t seed) {
  uint32_t digits = sobol_digits(i, (uint32_t)dimension);
  return seed == 0 ? digits : sobol_scramble(digits, seed);
}

// How full the fullest box is, of 2^bits that cut [0, 1)^2 into 2^across
// columns, by 2^bits points of two dimensions from number `first` on.
static int fullest(int a, int b, int bits, int across, uint32_t first,
                   const uint32_t seed[2]) {
  static uint16_t count[1 << 12];
  int most = 0, down = bits - across;
  for (int i = 0; i < 1 << bits; i++)
    count[i] = 0;
  for (uint32_t i = first; i < first + (1u << bits); i++) {
    uint32_t x = point(i, a, seed[0]) & ((1u << across) - 1);
    uint32_t y = point(i, b, seed[1]) & ((1u << down) - 1);
    int n = ++count[x << down | y];
    if (n > most) most = n;
  }
  return most;
}

// Each aligned run of 2^m points of the first two dimensions has one point in
// each box of size 2^-m, whatever its shape, scrambled or not.
static void boxes_hold_one_point_each(void **state) {
  (void)state;
  for (uint32_t seed = 0; seed < 20; seed++)
    for (int bits = 0; bits <= 12; bits++)
      for (int across = 0; across <= bits; across++) {
        uint32_t seeds[2] = {seed * 0x9e3779b9u, seed * 0x85ebca6bu};
        assert_int_equal(fullest(0, 1, bits, across, seed << bits, seeds), 1);
      }
}
