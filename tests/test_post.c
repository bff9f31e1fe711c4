// test_post.c — laws of the frosted glass.

#include "num.h"
#include "post.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 160, HEIGHT = 120 };

static size_t bytes_of(const image *im) {
  return (size_t)im->width * (size_t)im->height * sizeof *im->pixels;
}

// A picture whose red and green are the column and the row.
static image ramp(arena *mem, int width, int height) {
  image im = image_new(mem, width, height);
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++)
      im.pixels[(size_t)y * (size_t)width + (size_t)x] =
          (vec3){(float)x, (float)y, 1};
  return im;
}

// Radius 0 is clear glass, bit for bit; and what is one colour stays so.
static void clear_glass_changes_nothing(void **state) {
  (void)state;
  arena mem = {0};
  image im = ramp(&mem, WIDTH, HEIGHT);
  image out = post_frosted(&im, (post_frost){.radius = 0}, &mem, NULL);
  assert_memory_equal(im.pixels, out.pixels, bytes_of(&im));
  for (size_t i = 0; i < WIDTH * HEIGHT; i++)
    im.pixels[i] = (vec3){0.25f, 3, 0};
  out = post_frosted(&im, (post_frost){.radius = 7}, &mem, NULL);
  assert_memory_equal(im.pixels, out.pixels, bytes_of(&im));
  arena_free(&mem);
}

// On a ramp a pixel says where it looked.  Never farther than the radius; on
// the mean at itself; and as uniformly over the disc as its second moment,
// radius^2 / 4 a coordinate, can tell.
static void grains_look_all_over_the_disc(void **state) {
  (void)state;
  arena mem = {0};
  const float radius = 6;
  image im = ramp(&mem, WIDTH, HEIGHT);
  image out = post_frosted(&im, (post_frost){.radius = radius}, &mem, NULL);
  double sum[2] = {0}, square[2] = {0}, farthest = 0;
  int n = 0;
  for (int y = 7; y < HEIGHT - 7; y++)
    for (int x = 7; x < WIDTH - 7; x++, n++) {
      vec3 p = out.pixels[y * WIDTH + x];
      double dx = (double)p.x - x, dy = (double)p.y - y;
      farthest = fmax(farthest, sqrt(dx * dx + dy * dy));
      sum[0] += dx, sum[1] += dy;
      square[0] += dx * dx, square[1] += dy * dy;
    }
  assert_true(farthest <= (double)radius + 1e-4);
  assert_true(farthest > 0.99 * (double)radius);
  for (int c = 0; c < 2; c++) {
    // Standard error of the mean: radius / 2 / sqrt(n) = 0.024.
    assert_true(fabs(sum[c] / n) < 0.1);
    assert_true(fabs(square[c] / n / 9 - 1) < 0.04);
  }
  arena_free(&mem);
}

// Light that is bent is not lost: far from the edges a bright square keeps its
// sum within the noise of its rim.
static void the_pane_keeps_the_mean(void **state) {
  (void)state;
  arena mem = {0};
  image im = image_new(&mem, WIDTH, HEIGHT);
  for (int y = 30; y < 90; y++)
    for (int x = 40; x < 120; x++)
      im.pixels[y * WIDTH + x] = vec3_all(1);
  image out = post_frosted(&im, (post_frost){.radius = 8}, &mem, NULL);
  double sum = 0;
  for (size_t i = 0; i < WIDTH * HEIGHT; i++)
    sum += (double)out.pixels[i].x;
  assert_true(fabs(sum / (60 * 80) - 1) < 0.02);
  arena_free(&mem);
}

// Neither the threads nor the run show in the bytes.
static void threads_do_not_show(void **state) {
  (void)state;
  arena mem = {0};
  image im = ramp(&mem, WIDTH, HEIGHT);
  post_frost pane = {.radius = 5.5f};
  image one = post_frosted(&im, pane, &mem, NULL);
  for (int threads = 2; threads <= 7; threads += 5) {
    pool *p = pool_new(&mem, threads);
    image many = post_frosted(&im, pane, &mem, p);
    assert_memory_equal(one.pixels, many.pixels, bytes_of(&im));
    pool_free(p);
  }
  arena_free(&mem);
}

// A crop has the grains of the whole: where no grain looks beyond its edge, it
// is a part of the frosted whole.
static void a_crop_has_the_grains_of_the_whole(void **state) {
  (void)state;
  arena mem = {0};
  enum { X0 = 20, Y0 = 10, W = 60, H = 50, RADIUS = 4 };
  image im = ramp(&mem, WIDTH, HEIGHT), crop = image_new(&mem, W, H);
  for (int y = 0; y < H; y++)
    memcpy(crop.pixels + y * W, im.pixels + (y + Y0) * WIDTH + X0,
           W * sizeof(vec3));
  image whole = post_frosted(&im, (post_frost){.radius = RADIUS}, &mem, NULL);
  image part = post_frosted(&crop, (post_frost){RADIUS, X0, Y0}, &mem, NULL);
  for (int y = RADIUS + 1; y < H - RADIUS - 1; y++)
    for (int x = RADIUS + 1; x < W - RADIUS - 1; x++) {
      vec3 a = part.pixels[y * W + x];
      vec3 b = whole.pixels[(y + Y0) * WIDTH + x + X0];
      // Equal but for the fraction of a position, rounded at another size.
      assert_true(vec3_peak(vec3_abs(vec3_sub(a, b))) < 1e-4f);
    }
  arena_free(&mem);
}

// The names that the option takes, and those that it does not.
static void names_are_read_strictly(void **state) {
  (void)state;
  error err;
  post_frost pane = {.radius = -1, .x0 = 3, .y0 = 4};
  assert_true(post_parse(&pane, "frosted", &err));
  assert_true(pane.radius == 8 && pane.x0 == 3 && pane.y0 == 4);
  assert_true(post_parse(&pane, "frosted=2.5", &err));
  assert_true(pane.radius == 2.5f);
  static const char *const BAD[] = {
      "",         "frost",      "frosted=",    "frosted=-1", "frosted=x",
      "frosted4", "frosted=1,", "frosted=1e9", "frosted=nan"};
  for (size_t i = 0; i < sizeof BAD / sizeof *BAD; i++) {
    assert_false(post_parse(&pane, BAD[i], &err));
    assert_non_null(strstr(err.text, "frosted=RADIUS"));
    assert_true(pane.radius == 2.5f);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(clear_glass_changes_nothing),
      cmocka_unit_test(grains_look_all_over_the_disc),
      cmocka_unit_test(the_pane_keeps_the_mean),
      cmocka_unit_test(threads_do_not_show),
      cmocka_unit_test(a_crop_has_the_grains_of_the_whole),
      cmocka_unit_test(names_are_read_strictly),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
