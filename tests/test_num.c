// test_num.c — our own elementary functions against double-precision libm.

#include "num.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// A loop of n turns, or a fiftieth of them under the sanitizers.
static uint32_t turns(uint32_t n) {
  return getenv("FACET_QUICK") == NULL ? n : n / 50 + 1;
}

// The float with these bits.
static float float_of(uint32_t bits) {
  float x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

static const double TWO_PI = 6.28318530717958648;

// Over all of [0, 1] the point lies within 1.2e-7 of the circle's, in each
// coordinate; the quarters are exact.
static void circle_is_close(void **state) {
  (void)state;
  double worst = 0;
  uint32_t n = turns(4000000);
  for (uint32_t i = 0; i <= n; i++) {
    float u = (float)i / (float)n;
    vec2 p = num_circle(u);
    worst = fmax(worst, fabs((double)p.x - cos(TWO_PI * (double)u)));
    worst = fmax(worst, fabs((double)p.y - sin(TWO_PI * (double)u)));
  }
  assert_true(worst <= 1.2e-7);
  const vec2 quarter[5] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 0}};
  for (int i = 0; i < 5; i++) {
    vec2 p = num_circle((float)i / 4);
    assert_true(p.x == quarter[i].x && p.y == quarter[i].y);
  }
}

// Over all positive floats, denormal ones too, the logarithm is the float
// nearest to the true one, or its neighbour.
static void log2_is_close(void **state) {
  (void)state;
  uint32_t step = 0x7f800000 / turns(2000000);
  for (uint32_t bits = 1; bits < 0x7f800000; bits += step) {
    float x = float_of(bits);
    double want = log2((double)x), got = (double)num_log2(x);
    assert_true(fabs(got - want) <= 1.2e-7 * fabs(want));
  }
  assert_true(num_log2(1) == 0 && num_log2(8) == 3 && num_log2(0.25f) == -2);
  assert_true(num_log2(0) == -INFINITY && num_log2(INFINITY) == INFINITY);
}

// Powers of two over the whole range, with whole ones exact, and both ends.
static void exp2_is_close(void **state) {
  (void)state;
  uint32_t n = turns(2000000);
  for (uint32_t i = 0; i <= n; i++) {
    float y = -125 + 252.9f * (float)i / (float)n;
    double want = exp2((double)y);
    assert_true(fabs((double)num_exp2(y) - want) <= 6.1e-8 * want);
  }
  for (int k = -149; k < 128; k++)
    assert_true(num_exp2((float)k) == ldexpf(1, k));
  assert_true(num_exp2(128) == INFINITY && num_exp2(-152) == 0);
  assert_true(num_exp2(INFINITY) == INFINITY && num_exp2(-INFINITY) == 0);
  assert_true(isnan(num_exp2(NAN)));
}

// Relative error of pow <= 1e-6 wherever the result is a normal float.
static void pow_is_close(void **state) {
  (void)state;
  uint32_t n = turns(1000000), used = 0;
  for (uint32_t i = 0; i < n; i++) {
    float x = float_of(1 + (uint32_t)((i * UINT64_C(2654435761)) % 0x7f7fffff));
    float y = 40 * (float)sin(i * 0.7) * (float)(i % 7) / 6;
    double want = pow((double)x, (double)y);
    if (!(want > 1.2e-38 && want < 3.4e38)) continue;
    used++;
    assert_true(fabs((double)num_pow(x, y) / want - 1) <= 1e-6);
  }
  assert_true(used > n / 20);
  assert_true(num_pow(0, 0.5f) == 0 && num_pow(0, 0) == 1);
  assert_true(num_pow(5, 0) == 1 && num_pow(2, 10) == 1024);
  assert_true(num_pow(1, 1e30f) == 1 && num_pow(0.5f, 1e30f) == 0);
  assert_true(num_pow(INFINITY, -1) == 0 && num_pow(2, 200) == INFINITY);
}

// The angle in turns within 2e-7, on all sides, for lengths from 1e-20 to
// 1e20; always in [0, 1).
static void turns_are_close(void **state) {
  (void)state;
  uint32_t n = turns(2000000);
  for (uint32_t i = 0; i < n; i++) {
    double a = TWO_PI * i / n, length = exp2(fmod(i * 0.61, 130) - 65);
    float x = (float)(length * cos(a)), y = (float)(length * sin(a));
    double want = atan2((double)y, (double)x) / TWO_PI;
    float got = num_turns(y, x);
    assert_true(got >= 0 && got < 1);
    double apart = fabs((double)got - (want < 0 ? want + 1 : want));
    assert_true(fmin(apart, 1 - apart) <= 2e-7);
  }
  assert_true(num_turns(0, 1) == 0 && num_turns(1, 0) == 0.25f);
  assert_true(num_turns(0, -1) == 0.5f && num_turns(-1, 0) == 0.75f);
  assert_true(num_turns(0, 0) == 0 && num_turns(-0.0f, 1) == 0);
  assert_true(num_turns(-1e-30f, 1) == 0);
}

// acos / pi within 2e-7 and at its ends exact; beyond them clamped.
static void acos_is_close(void **state) {
  (void)state;
  uint32_t n = turns(2000000);
  for (uint32_t i = 0; i <= n; i++) {
    float x = -1 + 2 * (float)i / (float)n;
    double want = acos((double)x) / (TWO_PI / 2);
    assert_true(fabs((double)num_acos_pi(x) - want) <= 2e-7);
  }
  assert_true(num_acos_pi(1) == 0 && num_acos_pi(-1) == 1);
  assert_true(num_acos_pi(0) == 0.5f);
  assert_true(num_acos_pi(2) == 0 && num_acos_pi(-7) == 1);
}

// Fold the bits of x into h (FNV-1a).
static uint64_t hashed(uint64_t h, float x) {
  uint32_t bits;
  memcpy(&bits, &x, sizeof bits);
  return (h ^ bits) * UINT64_C(1099511628211);
}

// The same bits on every machine and from every compiler: a hash of 240,000
// results, written down when they were first computed.
static void results_have_the_same_bits_everywhere(void **state) {
  (void)state;
  uint64_t h = UINT64_C(14695981039346656037);
  for (int i = 0; i < 40000; i++) {
    float u = (float)i / 40000;
    vec2 c = num_circle(u);
    h = hashed(hashed(h, c.x), c.y);
    h = hashed(h, num_pow(u, 2.4f));
    h = hashed(h, num_log2(u + 1e-3f));
    h = hashed(h, num_turns(u - 0.3f, 0.6f - u));
    h = hashed(h, num_acos_pi(2 * u - 1));
  }
  assert_int_equal(h, UINT64_C(0x13fafd3aa57a0bb1));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(circle_is_close),
      cmocka_unit_test(log2_is_close),
      cmocka_unit_test(exp2_is_close),
      cmocka_unit_test(pow_is_close),
      cmocka_unit_test(turns_are_close),
      cmocka_unit_test(acos_is_close),
      cmocka_unit_test(results_have_the_same_bits_everywhere),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
