// test_pfm.c — float maps: every bit comes back.

#include "pfm.h"

#include "pictures.h"

#include <math.h>

static const loader PFM = {pfm_load, NULL};

// A file of a header and n bytes of pixels.
static blob pfm_of(const char *head, const uint8_t *pixels, size_t n) {
  blob b = {malloc(strlen(head) + n), strlen(head) + n};
  memcpy(b.bytes, head, strlen(head));
  memcpy(b.bytes + strlen(head), pixels, n);
  return b;
}

// Written and read, all floats are the same bits: NaN, infinity, denormals
// and the sign of zero too.
static void every_bit_comes_back(void **state) {
  (void)state;
  arena mem = {0};
  error err;
  image im = test_image(&mem, 19, 7);
  im.pixels[3] = (vec3){NAN, INFINITY, -INFINITY};
  im.pixels[4] = (vec3){-0.0f, 1e-42f, -5};
  FILE *f = tmpfile();
  assert_true(pfm_save(&im, f, "x.pfm", &err));
  blob b = blob_of_file(f);
  picture p = {0};
  assert_true(blob_load(PFM, b.bytes, b.size, &p, &mem, &err));
  assert_true(p.linear.width == 19 && p.linear.height == 7);
  assert_memory_equal(p.linear.pixels, im.pixels, 19 * 7 * sizeof(vec3));
  check_truncations(PFM, b);
  check_flips(PFM, b);
  free(b.bytes);
  arena_free(&mem);
}

// Grey and colour, both byte orders, the bottom row first; the size of the
// scale changes nothing.
static void orders_and_channels(void **state) {
  (void)state;
  arena mem = {0};
  error err;
  picture p = {0};
  const uint8_t big[] = {0x3f, 0x80, 0, 0, 0x40, 0, 0, 0};     // 1, 2
  const uint8_t little[] = {0, 0, 0x80, 0x3f, 0, 0, 0, 0x40};  // 1, 2
  const char *heads[] = {"Pf\n1 2\n1.0\n", "Pf\n1 2\n-1.0\n", "Pf 1 2 +2e3 ",
                         "Pf\r1\t2\n-.5\n"};
  for (int i = 0; i < 4; i++) {
    blob b = pfm_of(heads[i], i % 2 ? little : big, 8);
    assert_true(blob_load(PFM, b.bytes, b.size, &p, &mem, &err));
    assert_true(p.linear.width == 1 && p.linear.height == 2);
    assert_true(p.linear.pixels[1].x == 1 && p.linear.pixels[0].z == 2);
    check_truncations(PFM, b);
    free(b.bytes);
  }
  const uint8_t rgb[] = {0x3f, 0x80, 0, 0, 0x40, 0, 0, 0, 0xc0, 0, 0, 0};
  blob b = pfm_of("PF\n1 1\n1\n", rgb, 12);
  assert_true(blob_load(PFM, b.bytes, b.size, &p, &mem, &err));
  assert_true(p.linear.pixels[0].x == 1 && p.linear.pixels[0].z == -2);
  free(b.bytes);
  arena_free(&mem);
}

// Bad headers, and sizes that the file does not hold, are refused.
static void impossible_files(void **state) {
  (void)state;
  arena mem = {0};
  error err;
  picture p = {0};
  const char *heads[] = {"PG\n1 1\n1\n",          "PF\n0 1\n1\n",
                         "PF\n1 -1\n1\n",         "PF\n1 1\n0\n",
                         "PF\n1 1\nx\n",          "PF\n1 1\n1\n",
                         "PF\n65536 1\n1 ",       "PF\n1 1\n1x\n",
                         "PF\n65535 65535\n-1\n", "PF\n1  1\n1.\n"};
  for (size_t i = 0; i < sizeof heads / sizeof *heads; i++) {
    blob b = pfm_of(heads[i], (const uint8_t *)"01234567890", 11);
    assert_false(blob_load(PFM, b.bytes, b.size, &p, &mem, &err));
    free(b.bytes);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_bit_comes_back),
      cmocka_unit_test(orders_and_channels),
      cmocka_unit_test(impossible_files),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
