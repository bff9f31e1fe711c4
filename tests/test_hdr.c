// test_hdr.c — Radiance pictures: three codings, eight orientations, rounding.

#include "hdr.h"

#include "pictures.h"

#include <float.h>
#include <math.h>

static const loader HDR = {hdr_load, NULL};

// A file of a text and n bytes of pixels.
static blob hdr_of(const char *head, const uint8_t *pixels, size_t n) {
  blob b = {malloc(strlen(head) + n), strlen(head) + n};
  memcpy(b.bytes, head, strlen(head));
  if (n > 0) memcpy(b.bytes + strlen(head), pixels, n);
  return b;
}

// Load all of b and release it.
static image load_all(blob b, arena *mem) {
  picture p = {0};
  error err = {{0}};
  if (!blob_load(HDR, b.bytes, b.size, &p, mem, &err)) fail_msg("%s", err.text);
  free(b.bytes);
  return p.linear;
}

// The bytes that hdr_save writes.
static blob saved(const image *im) {
  FILE *f = tmpfile();
  error err;
  assert_true(hdr_save(im, f, "x.hdr", &err));
  return blob_of_file(f);
}

// One pixel through a file of one pixel.
static vec3 through(vec3 p) {
  arena mem = {0};
  image one = {1, 1, &p};
  vec3 q = load_all(saved(&one), &mem).pixels[0];
  arena_free(&mem);
  return q;
}

// Every component is within half a unit of the mantissa of the largest, which
// is at most 1/128 of that.
static void rounds_to_nearest(void **state) {
  (void)state;
  arena mem = {0};
  image im = image_new(&mem, 200, 50);
  uint32_t s = 5;
  for (int i = 0; i < 200 * 50; i++) {
    float size = ldexpf(1, (int)(next_random(&s) % 60) - 30);
    im.pixels[i] = (vec3){size * (float)(next_random(&s) & 0xffff) / 65536,
                          size * (float)(next_random(&s) & 0xffff) / 65536,
                          size * (float)(next_random(&s) & 0xffff) / 65536};
  }
  image back = load_all(saved(&im), &mem);
  for (int i = 0; i < 200 * 50; i++) {
    vec3 d = vec3_abs(vec3_sub(im.pixels[i], back.pixels[i]));
    int e;
    frexp((double)vec3_peak(im.pixels[i]), &e);
    float unit = ldexpf(1, e - 8);
    // Where the peak rounds up to 256, the next exponent's unit is 2 units.
    bool carried = vec3_peak(im.pixels[i]) >= 255.5f * unit;
    assert_true(vec3_peak(d) <= (carried ? unit : unit / 2));
  }
  arena_free(&mem);
}

// Rounding favours neither side: the mean relative error of a million greys
// is below 1e-5.  (Cutting off instead gives -2.7e-3.)
static void no_bias(void **state) {
  (void)state;
  arena mem = {0};
  int n = turns(1000000);
  image im = image_new(&mem, 1000, n / 1000 + 1);
  size_t count = 1000 * (size_t)im.height;
  for (size_t i = 0; i < count; i++)
    im.pixels[i] = vec3_all((float)(1 + ((double)i + 0.5) / (double)count));
  image back = load_all(saved(&im), &mem);
  double sum = 0;
  for (size_t i = 0; i < count; i++)
    sum += (double)back.pixels[i].x / (double)im.pixels[i].x - 1;
  assert_true(fabs(sum / (double)count) <= 1e-5);
  arena_free(&mem);
}

// Values at the ends of what four bytes can say.
static void ends_of_the_range(void **state) {
  (void)state;
  float largest = ldexpf(255, 119);
  assert_true(through(vec3_all(FLT_MAX)).x == largest);
  assert_true(through((vec3){INFINITY, 1, 0}).x == largest);
  assert_true(through((vec3){largest, 1, 0}).x == largest);
  assert_true(through((vec3){255.7f, 0, 0}).x == 256);
  assert_true(through((vec3){NAN, -1, 1}).x == 0);
  assert_true(through((vec3){NAN, -1, 1}).y == 0);
  assert_true(through((vec3){NAN, -1, 1}).z == 1);
  assert_true(through(vec3_all(1e-45f)).x == 0);
  assert_true(through(vec3_all(ldexpf(1, -128))).x == ldexpf(1, -128));
  assert_true(through(vec3_all(ldexpf(1, -135))).x == 0);
}

// Any width comes back: flat below 8 and above 32,767, run lengths between;
// rows with runs of every length too.
static void any_width(void **state) {
  (void)state;
  const int widths[] = {1, 2, 7, 8, 9, 127, 128, 129, 300, 32767, 32768};
  for (size_t k = 0; k < sizeof widths / sizeof *widths; k++) {
    arena mem = {0};
    image im = image_new(&mem, widths[k], 3);
    uint32_t s = 1;
    for (int i = 0; i < 3 * widths[k];) {
      int run = (int)(next_random(&s) % 300) / (int)(next_random(&s) % 9 + 1);
      float value = (float)(next_random(&s) % 256);
      for (int j = 0; j <= run && i < 3 * widths[k]; j++, i++)
        im.pixels[i] = (vec3){255, value, (float)(j % 5)};
    }
    image back = load_all(saved(&im), &mem);
    assert_int_equal(back.width, widths[k]);
    assert_memory_equal(back.pixels, im.pixels,
                        3 * (size_t)widths[k] * sizeof(vec3));
    arena_free(&mem);
  }
}

// Old run lengths: 1 1 1 n repeats, a second one counts 256 times as much.
static void old_run_lengths(void **state) {
  (void)state;
  arena mem = {0};
  const uint8_t rows[] = {4, 5, 6, 136, 1, 1, 1, 44, 1, 1, 1, 1, 7, 8, 9, 136};
  image im = load_all(
      hdr_of("#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 302\n", rows, 16),
      &mem);
  assert_true(im.width == 302 && im.height == 1);
  for (int i = 0; i < 301; i++)
    assert_true(im.pixels[i].x == 4 && im.pixels[i].z == 6);
  assert_true(im.pixels[301].y == 8);
  arena_free(&mem);
}

// The eight ways to lay out the same upright picture of 2 x 3.
static void eight_orientations(void **state) {
  (void)state;
  for (int k = 0; k < 8; k++) {
    bool x_first = k & 1, left = k & 2, up = k & 4;
    char head[96];
    snprintf(head, sizeof head,
             "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n%c%c %d %c%c %d\n",
             x_first ? left ? '-' : '+'
             : up    ? '+'
                     : '-',
             x_first ? 'X' : 'Y', x_first ? 2 : 3,
             x_first ? up ? '+' : '-'
             : left  ? '-'
                     : '+',
             x_first ? 'Y' : 'X', x_first ? 3 : 2);
    uint8_t pixels[24];
    for (int i = 0; i < 6; i++) {
      int x = x_first ? i / 3 : i % 2, y = x_first ? i % 3 : i / 2;
      if (left) x = 1 - x;
      if (up) y = 2 - y;
      memcpy(pixels + 4 * i, (uint8_t[]){(uint8_t)(10 * y + x), 0, 0, 136}, 4);
    }
    arena mem = {0};
    image im = load_all(hdr_of(head, pixels, 24), &mem);
    assert_true(im.width == 2 && im.height == 3);
    for (int i = 0; i < 6; i++)
      assert_true(im.pixels[i].x == (float)(10 * (i / 2) + i % 2));
    arena_free(&mem);
  }
}

// Exposures and colour corrections multiply and are divided out; lines that
// change no number are passed over, also with CR LF and without FORMAT.
static void header_lines(void **state) {
  (void)state;
  arena mem = {0};
  const uint8_t p[] = {128, 64, 32, 129};
  image im =
      load_all(hdr_of("#?RADIANCE\nGAMMA=2.2\nEXPOSURE= 2\nEXPOSURE=+2.50e-1\n"
                      "COLORCORR=1 2 .5\n# words\nPRIMARIES=0 0 0 0 0 0 0 0\n"
                      "PIXASPECT=1\nVIEW= -vtv\n\n-Y 1 +X 1\n",
                      p, 4),
               &mem);
  assert_true(im.pixels[0].x == 2);
  assert_true(im.pixels[0].y == 0.5f);
  assert_true(im.pixels[0].z == 1);
  im = load_all(hdr_of("#?RGBE\r\n\r\n-Y 1 +X 1\r\n", p, 4), &mem);
  assert_true(im.pixels[0].x == 1);
  arena_free(&mem);
}

// XYZ becomes linear RGB by the matrix that the standard prints.
static void xyz_is_converted(void **state) {
  (void)state;
  arena mem = {0};
  const uint8_t p[] = {243, 255, 255, 128};  // 0.949, 0.996, 0.996
  vec3 c = load_all(hdr_of("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n",
                           p, 4),
                    &mem)
               .pixels[0];
  double x = 243 / 256.0, y = 255 / 256.0, z = 255 / 256.0;
  assert_true(fabs((double)c.x - (3.2406 * x - 1.5372 * y - 0.4986 * z)) <
              1e-3);
  assert_true(fabs((double)c.y - (-0.9689 * x + 1.8758 * y + 0.0415 * z)) <
              1e-3);
  assert_true(fabs((double)c.z - (0.0557 * x - 0.2040 * y + 1.0570 * z)) <
              1e-3);
  arena_free(&mem);
}

// Whether a file is refused with these words in the message.
static bool refused(const char *head, const uint8_t *pixels, size_t n,
                    const char *words) {
  arena mem = {0};
  error err = {{0}};
  picture p = {0};
  blob b = hdr_of(head, pixels, n);
  bool ok = blob_load(HDR, b.bytes, b.size, &p, &mem, &err);
  free(b.bytes);
  arena_free(&mem);
  return !ok && strstr(err.text, words) != NULL;
}

// What cannot be right is refused, and says why.
static void impossible_files(void **state) {
  (void)state;
  const uint8_t p[] = {1, 1, 1, 1, 0, 0, 0, 0};
  assert_true(refused("P6\n", p, 4, "#?"));
  assert_true(
      refused("#?RADIANCE\nFORMAT=jpeg\n\n-Y 1 +X 1\n", p, 4, "FORMAT"));
  assert_true(
      refused("#?RADIANCE\nEXPOSURE=0\n\n-Y 1 +X 1\n", p, 4, "positive"));
  assert_true(
      refused("#?RADIANCE\nEXPOSURE=x\n\n-Y 1 +X 1\n", p, 4, "positive"));
  assert_true(
      refused("#?RADIANCE\nCOLORCORR=1 1\n\n-Y 1 +X 1\n", p, 4, "three"));
  assert_true(refused("#?RADIANCE\n\n-Y 1\n", p, 4, "-Y 512"));
  assert_true(refused("#?RADIANCE\n\n-Y 1 +Y 1\n", p, 4, "-Y 512"));
  assert_true(refused("#?RADIANCE\n\n-Y 65536 +X 1\n", p, 4, "-Y 512"));
  assert_true(refused("#?RADIANCE\n\n-Y 0 +X 1\n", p, 4, "-Y 512"));
  assert_true(refused("#?RADIANCE\n\n-Y 1 +X 1\n", p, 4, "repeats nothing"));
  assert_true(
      refused("#?RADIANCE\n\n-Y 65535 +X 65535\n", p, 4, "too short for"));
  const uint8_t old[] = {9, 9, 9, 9, 1, 1, 1, 9};
  assert_true(refused("#?RADIANCE\n\n-Y 1 +X 4\n", old, 8, "leaves"));
  const uint8_t none[] = {2, 2, 0, 8, 0, 0, 0, 0, 0, 0, 0, 0};
  assert_true(refused("#?RADIANCE\n\n-Y 1 +X 8\n", none, 12, "leaves"));
  const uint8_t over[] = {2, 2, 0, 8, 128 + 9, 0, 0, 0};
  assert_true(refused("#?RADIANCE\n\n-Y 1 +X 8\n", over, 8, "leaves"));
  assert_true(refused("#?RADIANCE\n\n-Y 1 +X 9\n", over, 8, "another width"));
}

// No damage is taken for a picture, and none does harm.
static void damaged_files(void **state) {
  (void)state;
  arena mem = {0};
  image im = test_image(&mem, 40, 9);
  blob b = saved(&im);
  check_truncations(HDR, b);
  check_flips(HDR, b);
  free(b.bytes);
  im = test_image(&mem, 7, 9);
  b = saved(&im);
  check_truncations(HDR, b);
  check_flips(HDR, b);
  free(b.bytes);
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rounds_to_nearest), cmocka_unit_test(no_bias),
      cmocka_unit_test(ends_of_the_range), cmocka_unit_test(any_width),
      cmocka_unit_test(old_run_lengths),   cmocka_unit_test(eight_orientations),
      cmocka_unit_test(header_lines),      cmocka_unit_test(xyz_is_converted),
      cmocka_unit_test(impossible_files),  cmocka_unit_test(damaged_files),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
