// test_tga.c — TGA files, byte by byte.

#include "tga.h"

#include "pictures.h"

static const loader TGA = {NULL, tga_load};

// A header for a picture of 3 x 2.
static blob tga_head(int type, int bits, int descriptor) {
  blob b = {calloc(1, 4096), 18};
  b.bytes[2] = (uint8_t)type;
  b.bytes[12] = 3;
  b.bytes[14] = 2;
  b.bytes[16] = (uint8_t)bits;
  b.bytes[17] = (uint8_t)descriptor;
  return b;
}

// Append n bytes.
static void put(blob *b, const uint8_t *bytes, size_t n) {
  memcpy(b->bytes + b->size, bytes, n);
  b->size += n;
}

// Load b and compare its samples with those wanted, then damage it.
static void check_tga(blob b, int channels, const uint8_t *want) {
  arena mem = {0};
  error err = {{0}};
  picture p = {0};
  if (!blob_load(TGA, b.bytes, b.size, &p, &mem, &err))
    fail_msg("%s", err.text);
  assert_true(p.stored.width == 3 && p.stored.height == 2);
  assert_true(p.stored.channels == channels && p.stored.depth == 8);
  assert_memory_equal(p.stored.samples, want, 6 * (size_t)channels);
  arena_free(&mem);
  check_truncations(TGA, b);
  check_flips(TGA, b);
  free(b.bytes);
}

// Colour is stored blue first; the four corners that a picture may start
// from all give the same upright picture.
static void four_corners(void **state) {
  (void)state;
  const uint8_t want[18] = {1,  2,  3,  4,  5,  6,  7,  8,  9,
                            10, 11, 12, 13, 14, 15, 16, 17, 18};
  for (int corner = 0; corner < 4; corner++) {
    blob b = tga_head(2, 24, corner << 4);
    for (int i = 0; i < 6; i++) {
      int x = corner & 1 ? 2 - i % 3 : i % 3,
          y = corner & 2 ? i / 3 : 1 - i / 3;
      const uint8_t *p = want + 3 * (3 * y + x);
      put(&b, (uint8_t[]){p[2], p[1], p[0]}, 3);
    }
    check_tga(b, 3, want);
  }
}

// The same picture in run lengths, a run and a literal packet; a run may go on
// in the next row.
static void run_lengths(void **state) {
  (void)state;
  const uint8_t want[24] = {3, 2, 1, 4, 3, 2, 1, 4, 3, 2, 1, 4,
                            3, 2, 1, 4, 7, 6, 5, 8, 9, 9, 9, 0};
  blob b = tga_head(10, 32, 0x28);
  put(&b, (uint8_t[]){0x83, 1, 2, 3, 4, 0x01, 5, 6, 7, 8, 9, 9, 9, 0}, 14);
  check_tga(b, 4, want);
}

// Five bits a channel: 31 becomes 255, 16 becomes 132.
static void fifteen_and_sixteen_bits(void **state) {
  (void)state;
  const uint8_t want[18] = {255, 0, 0, 0, 255, 0, 0, 0, 255,
                            132, 0, 0, 0, 132, 0, 0, 0, 132};
  for (int bits = 15; bits <= 16; bits++) {
    blob b = tga_head(2, bits, 0x20);
    put(&b, (uint8_t[]){0, 0x7c, 0xe0, 3, 0x1f, 0, 0, 0x40, 0, 2, 0x10, 0x80},
        12);
    check_tga(b, 3, want);
  }
}

// Palettes, whose indices may be one or two bytes and start anywhere.
static void palettes(void **state) {
  (void)state;
  const uint8_t want[18] = {30, 20, 10, 60, 50, 40, 30, 20, 10,
                            60, 50, 40, 60, 50, 40, 60, 50, 40};
  for (int bits = 8; bits <= 16; bits += 8) {
    blob b = tga_head(1, bits, 0x20);
    b.bytes[0] = 4;  // a name of four bytes
    b.bytes[1] = 1;
    b.bytes[3] = 100;  // the first index
    b.bytes[5] = 2;
    b.bytes[7] = 24;
    put(&b, (const uint8_t *)"name\12\24\36\50\62\74", 10);
    const uint8_t index[6] = {100, 101, 100, 101, 101, 101};
    for (int i = 0; i < 6; i++)
      put(&b, (uint8_t[]){index[i], 0}, (size_t)bits / 8);
    check_tga(b, 3, want);
  }
}

// Grey, plain and in runs; 32 bits without alpha bits have no alpha.
static void grey_and_no_alpha(void **state) {
  (void)state;
  const uint8_t grey[6] = {9, 9, 9, 9, 1, 2};
  blob b = tga_head(3, 8, 0x20);
  put(&b, grey, 6);
  check_tga(b, 1, grey);
  b = tga_head(11, 8, 0x20);
  put(&b, (uint8_t[]){0x83, 9, 1, 1, 2}, 5);
  check_tga(b, 1, grey);
  uint8_t none[24] = {0}, want[18] = {0};
  b = tga_head(2, 32, 0x20);
  put(&b, none, 24);
  check_tga(b, 3, want);
}

// What must be refused: an index outside the palette, a run over the end, and
// a size that the file cannot hold.
static void impossible_files(void **state) {
  (void)state;
  arena mem = {0};
  error err = {{0}};
  picture p = {0};
  blob b = tga_head(1, 8, 0);
  b.bytes[1] = b.bytes[5] = 1;
  b.bytes[7] = 24;
  put(&b, (uint8_t[]){1, 2, 3, 0, 0, 0, 0, 0, 1}, 9);
  assert_false(blob_load(TGA, b.bytes, b.size, &p, &mem, &err));
  assert_non_null(strstr(err.text, "outside the palette"));
  free(b.bytes);
  b = tga_head(11, 8, 0);
  put(&b, (uint8_t[]){0x86, 9}, 2);
  assert_false(blob_load(TGA, b.bytes, b.size, &p, &mem, &err));
  assert_non_null(strstr(err.text, "leaves the picture"));
  memset(b.bytes + 12, 0xff, 4);
  assert_false(blob_load(TGA, b.bytes, b.size, &p, &mem, &err));
  assert_non_null(strstr(err.text, "too short"));
  free(b.bytes);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(four_corners),
      cmocka_unit_test(run_lengths),
      cmocka_unit_test(fifteen_and_sixteen_bits),
      cmocka_unit_test(palettes),
      cmocka_unit_test(grey_and_no_alpha),
      cmocka_unit_test(impossible_files),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
