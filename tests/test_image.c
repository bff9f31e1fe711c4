// test_image.c — the sRGB curve and images made of stored samples.

#include "pictures.h"

#include <math.h>

// The curve in long double, written down a second time.
static long double curve(long double x) {
  return x <= 0.0031308L ? 12.92L * x : 1.055L * powl(x, 1 / 2.4L) - 0.055L;
}

// Its inverse.
static long double inverse(long double y) {
  return y <= 0.04045L ? y / 12.92L : powl((y + 0.055L) / 1.055L, 2.4L);
}

// An 8-bit code changes between exactly the two neighbouring floats between
// which the curve crosses a half: 255 thresholds, 510 neighbours, 0 wrong.
static void codes_change_at_the_right_float(void **state) {
  (void)state;
  srgb_table t = srgb_table_new();
  int wrong = 0;
  for (int k = 0; k < 255; k++) {
    long double at = inverse((k + 0.5L) / 255);
    float above = (float)at;
    if ((long double)above < at) above = nextafterf(above, 2);
    float below = nextafterf(above, 0);
    assert_true(255 * curve((long double)above) >= k + 0.5L);
    assert_true(255 * curve((long double)below) < k + 0.5L);
    wrong += srgb_code(&t, above) != k + 1;
    wrong += srgb_code(&t, below) != k;
  }
  assert_int_equal(wrong, 0);
}

// The same with 16 bits: 65,535 thresholds, 131,070 neighbours.
static void codes16_change_at_the_right_float(void **state) {
  (void)state;
  int wrong = 0, step = getenv("FACET_QUICK") == NULL ? 1 : 50;
  for (int k = 0; k < 65535; k += step) {
    float near = (float)inverse((k + 0.5L) / 65535);
    for (int side = 0; side < 3; side++) {
      float x = nextafterf(near, side == 0 ? 0.0f : 2.0f);
      if (side == 1) x = near;
      wrong += srgb_code16(x) != (long)(65535 * curve((long double)x) + 0.5L);
    }
  }
  assert_int_equal(wrong, 0);
}

// Decoding a code to linear light and encoding it again is the identity.
static void codes_survive_a_round_trip(void **state) {
  (void)state;
  srgb_table t = srgb_table_new();
  for (int k = 0; k < 256; k++)
    assert_int_equal(srgb_code(&t, (float)srgb_decode(k / 255.0)), k);
  for (int k = 0; k < 65536; k++)
    assert_int_equal(srgb_code16((float)srgb_decode(k / 65535.0)), k);
}

// What is no light or too much light has a code too.
static void codes_of_odd_values(void **state) {
  (void)state;
  srgb_table t = srgb_table_new();
  const float low[] = {NAN, -INFINITY, -1, -0.0f, 0, 1e-30f};
  const float high[] = {1, 1.0001f, 1e30f, INFINITY};
  for (int i = 0; i < 6; i++) {
    assert_int_equal(srgb_code(&t, low[i]), 0);
    assert_int_equal(srgb_code16(low[i]), 0);
  }
  for (int i = 0; i < 4; i++) {
    assert_int_equal(srgb_code(&t, high[i]), 255);
    assert_int_equal(srgb_code16(high[i]), 65535);
  }
}

// Grey is spread, alpha left out, and codes become numbers in [0, 1] with or
// without the curve, at both depths.
static void pixmaps_become_images(void **state) {
  (void)state;
  arena mem = {0};
  uint8_t grey_alpha[] = {0, 9, 255, 9, 51, 9};
  pixmap p = {3, 1, 2, 8, grey_alpha};
  image im = image_from_pixmap(&mem, &p, false);
  assert_true(im.pixels[0].x == 0 && im.pixels[1].y == 1);
  assert_true(im.pixels[2].x == 0.2f && im.pixels[2].z == 0.2f);
  uint16_t rgba[] = {65535, 13107, 0, 1};
  pixmap q = {1, 1, 4, 16, rgba};
  im = image_from_pixmap(&mem, &q, true);
  assert_true(im.pixels[0].x == 1 && im.pixels[0].z == 0);
  assert_true(im.pixels[0].y == (float)srgb_decode(0.2));
  arena_free(&mem);
}

// A side is digits only, in 1..65535.
static void sides_are_whole_numbers(void **state) {
  (void)state;
  int side = -1;
  const char *bad[] = {"",
                       "0",
                       "-1",
                       "+1",
                       "1 ",
                       " 1",
                       "1x",
                       "1.5",
                       "65536",
                       "4294967297",
                       "99999999999999"};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
    assert_false(image_parse_side(bad[i], &side));
  assert_int_equal(side, -1);
  assert_true(image_parse_side("65535", &side) && side == 65535);
  assert_true(image_parse_side("007", &side) && side == 7);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(codes_change_at_the_right_float),
      cmocka_unit_test(codes16_change_at_the_right_float),
      cmocka_unit_test(codes_survive_a_round_trip),
      cmocka_unit_test(codes_of_odd_values),
      cmocka_unit_test(pixmaps_become_images),
      cmocka_unit_test(sides_are_whole_numbers),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
