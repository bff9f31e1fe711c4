// test_sobol.c — laws of the points that pictures are sampled with.

#include "sampler.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// n, or a fiftieth of it under the sanitizers.
static uint64_t shortened(uint64_t n) {
  return getenv("FACET_QUICK") != NULL ? n / 50 : n;
}

// Dimensions of the points, cut into boxes: digits[i] digits of number dims[i].
typedef struct cuts {
  int n, dims[4], digits[4];
  bool turned;  // scrambled so
} cuts;

static uint32_t box_of(const cuts *c, uint32_t point, const uint32_t *seeds) {
  uint32_t box = 0;
  for (int i = 0; i < c->n; i++) {
    uint32_t d = sobol_digits(point, (uint32_t)c->dims[i]);
    if (seeds != NULL)
      d = (c->turned ? sobol_turn : sobol_scramble)(d, seeds[c->dims[i]]);
    box = box << c->digits[i] | (d & ((1u << c->digits[i]) - 1));
  }
  return box;
}

// Whether the 2^bits points from number `first` on, which is a multiple of
// that, fill all boxes alike.
static bool even(const cuts *c, int bits, uint32_t first,
                 const uint32_t *seeds) {
  static int count[1 << 12];
  int cut = 0;
  for (int i = 0; i < c->n; i++)
    cut += c->digits[i];
  memset(count, 0, sizeof count);
  for (uint32_t p = first; p < first + (1u << bits); p++)
    count[box_of(c, p, seeds)]++;
  for (int i = 0; i < 1 << cut; i++)
    if (count[i] != 1 << (bits - cut)) return false;
  return true;
}

// All ways to cut the dimensions with `left` digits in total, from dimension
// number `at` of the cuts on.  Counts in *odd those that are not even.
static void try_all(cuts *c, int at, int left, int bits, int *odd) {
  if (at == c->n - 1) {
    c->digits[at] = left;
    *odd += !even(c, bits, 0, NULL);
    return;
  }
  for (c->digits[at] = 0; c->digits[at] <= left; c->digits[at]++) {
    cuts rest = *c;
    try_all(&rest, at + 1, left - c->digits[at], bits, odd);
  }
}

// Each aligned run of 2^m points of a pair has one in each box of size 2^-m,
// whatever its shape; scrambling changes nothing in that.
static void boxes_hold_one_point_each(void **state) {
  (void)state;
  for (int pair = 0; pair < SOBOL_DIMENSIONS; pair += 2)
    for (int bits = 0; bits <= 12; bits++)
      for (int across = 0; across <= bits; across++) {
        cuts c = {2, {pair, pair + 1}, {across, bits - across}, false};
        uint32_t seeds[SOBOL_DIMENSIONS];
        for (uint32_t i = 0; i < SOBOL_DIMENSIONS; i++)
          seeds[i] = sampler_seed((uint64_t)bits * 77, i);
        assert_true(even(&c, bits, 0, NULL));
        assert_true(even(&c, bits, 0, seeds));
        assert_true(even(&c, bits, 5u << bits, seeds));
        c.turned = true;
        assert_true(even(&c, bits, 0, seeds));
        assert_true(even(&c, bits, 5u << bits, seeds));
      }
}

// The least t such that 2^bits points fill all boxes of size 2^(t - bits).
static int quality(const int dims[4], int bits) {
  for (int t = 0; t < bits; t++) {
    cuts c = {4, {dims[0], dims[1], dims[2], dims[3]}, {0}, false};
    int odd = 0;
    try_all(&c, 0, bits - t, bits, &odd);
    if (odd == 0) return t;
  }
  return bits;
}

// Four dimensions cannot all be that even.  Pixel and direction, pixel and
// light, and direction and light are nearly: t of 2 up to 64 points, 3 or 4
// up to 4096.
static void fours_are_nearly_as_even(void **state) {
  (void)state;
  static const int FOURS[3][4] = {{0, 1, 2, 3}, {0, 1, 4, 5}, {2, 3, 4, 5}};
  int top = shortened(50) < 50 ? 8 : 12;
  for (int i = 0; i < 3; i++)
    for (int bits = 1; bits <= top; bits++) {
      int t = quality(FOURS[i], bits);
      print_message("# %d%d%d%d, 2^%d points: t = %d\n", FOURS[i][0],
                    FOURS[i][1], FOURS[i][2], FOURS[i][3], bits, t);
      assert_true(t <= (bits <= 5 ? 2 : bits <= 9 ? 3 : 4));
    }
}

// Owen's scrambling: a digit's flip depends on the digits before it alone, and
// is as likely as not; flips behind different digits are independent.
static void scrambling_is_nested_and_random(void **state) {
  (void)state;
  enum { SEEDS = 100000, DIGITS = 16 };
  uint32_t flips[DIGITS] = {0}, apart[DIGITS] = {0}, x = 0x5a3c9671;
  for (uint32_t i = 0; i < SEEDS; i++) {
    uint32_t seed = sampler_seed(12345, i), y = x ^ sobol_scramble(x, seed);
    for (uint32_t k = 0; k < DIGITS; k++) {
      uint32_t later = x ^ 0xfffffffeu << k, before = x ^ (1u << k) >> 1;
      later ^= sobol_scramble(later, seed);
      before ^= sobol_scramble(before, seed);
      assert_int_equal(later >> k & 1, y >> k & 1);
      flips[k] += y >> k & 1;
      apart[k] += (before ^ y) >> k & 1;
    }
  }
  for (int k = 0; k < DIGITS; k++) {
    double flip = flips[k] / (double)SEEDS, unlike = apart[k] / (double)SEEDS;
    print_message("# digit %d: flipped %.4f, unlike its neighbour %.4f\n", k,
                  flip, unlike);
    assert_true(fabs(flip - 0.5) < 5 * 0.5 / sqrt(SEEDS));
    if (k > 0) assert_true(fabs(unlike - 0.5) < 0.02);
  }
}

// A block's order is a permutation that keeps each run from 2^k on.
static void shuffling_permutes_each_power_of_two(void **state) {
  (void)state;
  for (uint32_t seed = 1; seed < 50; seed++) {
    static bool seen[1 << 10];
    memset(seen, 0, sizeof seen);
    for (uint32_t i = 0; i < 1 << 10; i++) {
      uint32_t to = sampler_shuffle(i, seed * 0x9e3779b9u);
      assert_true(to < 1 << 10 && !seen[to]);
      for (uint32_t k = 1; k < 1 << 10; k *= 2)
        assert_int_equal(i < k, to < k);
      seen[to] = true;
    }
  }
}

static void eight_at_once_are_the_same(void **state) {
  (void)state;
  for (int kind = SAMPLER_SOBOL; kind <= SAMPLER_TURNED; kind++)
    for (uint32_t d = 0; d < 70; d++)
      for (uint32_t i = 0; i < 40; i++) {
        uint32_t index = i < 20 ? i : 0x9e3779b9u * i;
        sampler s = sampler_of((sampler_kind)kind, 3, d * 100 + i, index);
        float eight[8];
        sampler_8(&s, d, eight);
        sampler_at(&s, d);
        for (int k = 0; k < 8; k++) {
          assert_true(eight[k] >= 0 && eight[k] < 1);
          assert_true(eight[k] == sampler_1(&s));
        }
      }
  sampler s = sampler_of(SAMPLER_RANDOM, 1, 2, 3);
  rng r = rng_of(1, 2, 3);
  for (int i = 0; i < 20; i++)
    assert_true(sampler_1(&s) == rng_next(&r));
}

// A half plane through the unit square, a x + b y < c, and its area.
typedef struct edge {
  double a, b, c, area;
} edge;

static double above_0(double x) {
  return x > 0 ? x * x : 0;
}

static edge edge_of(rng *r) {
  double turn = 6.283185307179586 * (double)rng_next(r);
  edge e = {cos(turn), sin(turn), 0, 0};
  e.c = 0.5 * (e.a + e.b) + 0.5 * ((double)rng_next(r) - 0.5);
  double a = fabs(e.a), b = fabs(e.b);
  double c = e.c - fmin(e.a, 0) - fmin(e.b, 0);
  e.area = above_0(c) - above_0(c - a) - above_0(c - b) + above_0(c - a - b);
  e.area /= 2 * a * b;
  return e;
}

static double behind(const edge *e, vec2 p) {
  return e->a * (double)p.x + e->b * (double)p.y < e->c;
}

typedef enum scene_kind { EDGE, EDGE_LIGHT, EDGE_EDGE } scene_kind;

// Mean squared error of n samples a pixel, over many pixels with an edge
// through each; in EDGE_LIGHT what is behind it is lit by a light whose points
// count differently, in EDGE_EDGE by one behind an edge of its own.  *bias is
// the mean error over its standard error.
static double mean_square(sampler_kind kind, scene_kind scene, uint32_t light,
                          uint32_t n, double *bias) {
  const uint64_t pixels = shortened(4000);
  double sum = 0, squares = 0;
  for (uint64_t p = 0; p < pixels; p++) {
    rng r = rng_of(99, p, n);
    edge e = edge_of(&r), f = edge_of(&r);
    double got = 0, want = e.area;
    if (scene == EDGE_LIGHT) want *= 0.5;
    if (scene == EDGE_EDGE) want *= f.area;
    for (uint32_t i = 0; i < n; i++) {
      sampler s = sampler_of(kind, 5, p, i);
      double x = behind(&e, sampler_2(&s));
      sampler_at(&s, light);
      vec2 u = sampler_2(&s);
      if (scene == EDGE_LIGHT) x *= 2 * (double)u.x * (double)u.y;
      if (scene == EDGE_EDGE) x *= behind(&f, u);
      got += x / n;
    }
    sum += got - want;
    squares += (got - want) * (got - want);
  }
  *bias = sum / sqrt(squares);
  return squares / (double)pixels;
}

// The error at 64 samples, and the power of N by which it falls from 16 to
// 1024, least squares.
static void check_error(scene_kind scene, uint32_t light, double most,
                        double steepest) {
  double x[4], y[4], bias, slope = 0, random;
  for (int i = 0; i < 4; i++) {
    x[i] = 4 + 2 * i;
    y[i] = log2(mean_square(SAMPLER_SOBOL, scene, light, 16u << 2 * i, &bias));
    assert_true(fabs(bias) < 4);
    slope += y[i] * (x[i] - 7) / 20;
  }
  random = mean_square(SAMPLER_RANDOM, scene, light, 64, &bias);
  print_message("# scene %d, light %u: %.2e at 64 (random %.2e), slope %.2f\n",
                (int)scene, light, exp2(y[1]), random, slope);
  if (shortened(50) < 50) return;
  assert_true(exp2(y[1]) < most && slope < steepest);
}

// An edge is smooth enough for N^-1.5.  Light and pixel are even together,
// and so are the light's own two dimensions, at every depth; but those of
// another block know nothing of the pixel: the slope is that of chance.
static void error_falls_faster_than_by_chance(void **state) {
  (void)state;
  check_error(EDGE, 2, 3e-4, -1.45);
  check_error(EDGE_LIGHT, 2, 3e-4, -1.4);
  check_error(EDGE_LIGHT, 4, 3e-4, -1.4);
  check_error(EDGE_EDGE, 2, 6e-4, -1.3);
  check_error(EDGE_EDGE, 4, 6e-4, -1.3);
  check_error(EDGE_LIGHT, 12, 1.2e-3, -0.9);
}

// A wall before an even sky: it hides from a matt surface what is behind a line
// through the disc onto which directions fall.  How many of n it hides.
static uint32_t hidden(sampler_kind kind, uint64_t pixel, uint32_t dimension,
                       uint32_t n, const double wall[3]) {
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    sampler s = sampler_of(kind, 5, pixel, i);
    sampler_at(&s, dimension);
    vec2 u = sampler_2(&s);
    double turn = 6.283185307179586 * (double)u.x, r = sqrt((double)u.y);
    count += wall[0] * r * cos(turn) + wall[1] * r * sin(turn) < wall[2];
  }
  return count;
}

// What share of the disc is hidden by a line at that distance.
static double hidden_share(double c) {
  return 0.5 + (asin(c) + c * sqrt(1 - c * c)) / 3.141592653589793;
}

static double wall_error(sampler_kind kind, uint32_t dimension, uint32_t n,
                         double *mean) {
  const uint64_t pixels = shortened(20000);
  double squares = 0;
  *mean = 0;
  for (uint64_t p = 0; p < pixels; p++) {
    rng r = rng_of(7, p, n);
    double turn = 6.283185307179586 * (double)rng_next(&r);
    double wall[3] = {cos(turn), sin(turn), 1.6 * (double)rng_next(&r) - 0.8};
    double error =
        hidden(kind, p, dimension, n, wall) / (double)n - hidden_share(wall[2]);
    *mean += error / (double)pixels;
    squares += error * error / (double)pixels;
  }
  *mean /= sqrt(squares / (double)pixels);
  return squares;
}

// A wall that hides half of the sky hides one of two turned directions and two
// of four.  Where it hides more or less, two and four err less than directions
// that are only even, and sixteen no more.
static void turned_directions_face_each_other(void **state) {
  (void)state;
  for (uint32_t dimension = 2; dimension < 30; dimension += 8)
    for (uint64_t p = 0; p < 1000; p++) {
      double turn = 0.1 + (double)p, wall[3] = {cos(turn), sin(turn), 0};
      assert_int_equal(hidden(SAMPLER_TURNED, p, dimension, 2, wall), 1);
      assert_int_equal(hidden(SAMPLER_TURNED, p, dimension, 4, wall), 2);
    }
  static const double SHARE_OF[5] = {1.04, 0.8, 0.8, 1.04, 1.04};
  for (uint32_t d = 2; d < 11; d += 8)
    for (int k = 0; k < 5; k++) {
      double mean, other, even = wall_error(SAMPLER_SOBOL, d, 1u << k, &other);
      double turned = wall_error(SAMPLER_TURNED, d, 1u << k, &mean);
      print_message("# dimension %u, %2u directions: %.5f, turned %.5f\n", d,
                    1u << k, even, turned);
      assert_true(fabs(mean) < 4 && fabs(other) < 4);
      if (shortened(50) == 50) assert_true(turned < SHARE_OF[k] * even);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(boxes_hold_one_point_each),
      cmocka_unit_test(fours_are_nearly_as_even),
      cmocka_unit_test(scrambling_is_nested_and_random),
      cmocka_unit_test(shuffling_permutes_each_power_of_two),
      cmocka_unit_test(eight_at_once_are_the_same),
      cmocka_unit_test(error_falls_faster_than_by_chance),
      cmocka_unit_test(turned_directions_face_each_other),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
