// test_metric.c — distances between pictures.

#include "metric.h"

#include "pictures.h"

#include <math.h>

// A picture of n x 1 grey values.
static image row_of(arena *mem, int n, const float *values) {
  image im = image_new(mem, n, 1);
  for (int i = 0; i < n; i++)
    im.pixels[i] = vec3_all(values[i]);
  return im;
}

// Every number by hand, on two pixels that differ by 0.5 and -0.25.
static void numbers_by_hand(void **state) {
  (void)state;
  arena mem = {0};
  image a = row_of(&mem, 3, (float[]){1, 1.25f, 3});
  image b = row_of(&mem, 3, (float[]){1, 1.5f, 2.5f});
  metric m = metric_compare(&a, &b, &mem);
  double mse = (0.0625 + 0.25) / 3;
  assert_true(fabs(m.mse - mse) < 1e-15);
  assert_true(fabs(m.rmse - sqrt(mse)) < 1e-15);
  assert_true(fabs(m.mae - 0.25) < 1e-15);
  assert_true(fabs(m.mean - 0.25 / 3) < 1e-15);
  assert_true(fabs(m.psnr + 10 * log10(mse)) < 1e-12);
  double relmse = (0.0625 / 2.26 + 0.25 / 6.26) / 3;
  assert_true(fabs(m.relmse - relmse) < 1e-15);
  assert_true(m.max == 0.5 && m.p999 == 0.5);
  assert_int_equal(m.worst_x, 2);
  assert_int_equal(m.differing, 2);
  assert_false(m.non_finite);
  arena_free(&mem);
}

// Equal pictures: all zero, and PSNR infinite.
static void equal_pictures(void **state) {
  (void)state;
  arena mem = {0};
  image a = test_image(&mem, 9, 5);
  metric m = metric_compare(&a, &a, &mem);
  assert_true(m.rmse == 0 && m.max == 0 && m.p999 == 0 && m.relmse == 0);
  assert_true(isinf(m.psnr) && m.psnr > 0);
  assert_int_equal(m.differing, 0);
  arena_free(&mem);
}

// relMSE divides by the reference, so that the two sides are not alike.
static void relmse_is_not_symmetric(void **state) {
  (void)state;
  arena mem = {0};
  image a = row_of(&mem, 1, (float[]){2}), b = row_of(&mem, 1, (float[]){1});
  assert_true(fabs(metric_compare(&a, &b, &mem).relmse - 1 / 1.01) < 1e-15);
  assert_true(fabs(metric_compare(&b, &a, &mem).relmse - 1 / 4.01) < 1e-15);
  arena_free(&mem);
}

// The percentile is the one that sorting would find: among 2,000 pixels with
// the errors 1..2000 (shuffled), 1998 is the smallest that 99.9 % do not
// exceed.
static void percentile_by_rank(void **state) {
  (void)state;
  arena mem = {0};
  image a = image_new(&mem, 50, 40), b = image_new(&mem, 50, 40);
  for (int i = 0; i < 2000; i++)
    a.pixels[i * 7 % 2000].y = (float)(i + 1) * 1e-3f;
  metric m = metric_compare(&a, &b, &mem);
  assert_true(m.p999 == (double)(1998 * 1e-3f));
  assert_true(m.max == (double)(2000 * 1e-3f));
  arena_free(&mem);
}

// Sums are in double: a million equal differences keep their mean.
static void sums_do_not_drift(void **state) {
  (void)state;
  arena mem = {0};
  image a = image_new(&mem, 1000, 1000), b = image_new(&mem, 1000, 1000);
  for (int i = 0; i < 1000000; i++)
    a.pixels[i] = vec3_all(0.1f);
  metric m = metric_compare(&a, &b, &mem);
  assert_true(fabs(m.mae - (double)0.1f) < 1e-11);
  arena_free(&mem);
}

// A value that is no number is found, with its place and its side.
static void non_finite_is_found(void **state) {
  (void)state;
  arena mem = {0};
  image a = test_image(&mem, 9, 5), b = test_image(&mem, 9, 5);
  b.pixels[2 * 9 + 4].z = NAN;
  metric m = metric_compare(&a, &b, &mem);
  assert_true(m.non_finite && m.bad_in_b && m.bad_x == 4 && m.bad_y == 2);
  a.pixels[9 + 3].x = INFINITY;
  m = metric_compare(&a, &b, &mem);
  assert_true(m.non_finite && !m.bad_in_b && m.bad_x == 3 && m.bad_y == 1);
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(numbers_by_hand),
      cmocka_unit_test(equal_pictures),
      cmocka_unit_test(relmse_is_not_symmetric),
      cmocka_unit_test(percentile_by_rank),
      cmocka_unit_test(sums_do_not_drift),
      cmocka_unit_test(non_finite_is_found),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
