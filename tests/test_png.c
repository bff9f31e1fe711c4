// test_png.c — PNG files: what libpng is asked for, and what goes wrong.

#include "png.h"

#include "pictures.h"

#include <math.h>
#include <png.h>

static const loader PNG = {NULL, png_load};

// The bytes that png_save writes.
static blob png_of(const image *im, int depth) {
  FILE *f = tmpfile();
  error err;
  assert_true(png_save(im, depth, f, "x.png", &err));
  return blob_of_file(f);
}

// Load all of b or fail the test.
static pixmap load_all(blob b, arena *mem) {
  picture p = {0};
  error err = {{0}};
  if (!blob_load(PNG, b.bytes, b.size, &p, mem, &err)) fail_msg("%s", err.text);
  return p.stored;
}

// What is written comes back as the nearest codes of the sRGB curve, at both
// depths.
static void codes_come_back(void **state) {
  (void)state;
  arena mem = {0};
  image im = test_image(&mem, 61, 17);
  im.pixels[5] = (vec3){NAN, -1, 2};
  srgb_table table = srgb_table_new();
  for (int depth = 8; depth <= 16; depth += 8) {
    blob b = png_of(&im, depth);
    pixmap p = load_all(b, &mem);
    assert_true(p.width == 61 && p.height == 17 && p.channels == 3);
    assert_int_equal(p.depth, depth);
    for (int i = 0; i < 61 * 17; i++) {
      float y = im.pixels[i].y;
      if (depth == 8)
        assert_int_equal(((uint8_t *)p.samples)[3 * i + 1],
                         srgb_code(&table, y));
      else
        assert_int_equal(((uint16_t *)p.samples)[3 * i + 1], srgb_code16(y));
    }
    free(b.bytes);
  }
  arena_free(&mem);
}

// The data of the first chunk of the given type, and its length.
static const uint8_t *chunk_of(blob b, const char *type, size_t *size) {
  for (size_t at = 8; at + 12 <= b.size;) {
    const uint8_t *c = b.bytes + at;
    *size = (size_t)c[0] << 24 | (size_t)c[1] << 16 | (size_t)c[2] << 8 | c[3];
    if (memcmp(c + 4, type, 4) == 0) return c + 8;
    at += 12 + *size;
  }
  return NULL;
}

// A picture says in three ways that its numbers are sRGB.
static void colour_space_is_named(void **state) {
  (void)state;
  arena mem = {0};
  image im = test_image(&mem, 4, 4);
  blob b = png_of(&im, 8);
  size_t n;
  assert_non_null(chunk_of(b, "sRGB", &n));
  assert_int_equal(n, 1);
  const uint8_t *gamma = chunk_of(b, "gAMA", &n);
  assert_non_null(gamma);
  assert_int_equal(gamma[2] << 8 | gamma[3], 45455);
  const uint8_t *white = chunk_of(b, "cHRM", &n);
  assert_non_null(white);
  assert_int_equal(white[2] << 8 | white[3], 31270);  // x of D65
  assert_null(chunk_of(b, "tIME", &n));  // equal pictures are equal files
  free(b.bytes);
  arena_free(&mem);
}

// A kind of PNG to make: libpng's colour type, bits, interlace, transparency.
typedef struct recipe {
  int type, bits, interlace;
  bool transparent;
} recipe;

// A file of that kind, 13 x 11, whose samples are random.
static blob png_made(recipe r, uint8_t rows[11][13 * 8]) {
  FILE *f = tmpfile();
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, f);
  png_set_IHDR(png, info, 13, 11, r.bits, r.type, r.interlace, 0, 0);
  png_color palette[256];
  png_byte alpha[256];
  for (int i = 0; i < 256; i++) {
    palette[i] = (png_color){(png_byte)i, (png_byte)(255 - i), 7};
    alpha[i] = (png_byte)(i / 2);
  }
  bool indexed = r.type == PNG_COLOR_TYPE_PALETTE;
  if (indexed) png_set_PLTE(png, info, palette, 1 << r.bits);
  png_color_16 key = {0};
  if (r.transparent)
    png_set_tRNS(png, info, alpha, indexed ? 1 << r.bits : 0,
                 indexed ? NULL : &key);
  png_write_info(png, info);
  uint32_t state = 3;
  png_bytep pointers[11];
  for (int y = 0; y < 11; y++) {
    pointers[y] = rows[y];
    for (int i = 0; i < 13 * 8; i++)
      rows[y][i] = (uint8_t)next_random(&state);
  }
  png_write_image(png, pointers);
  png_write_end(png, NULL);
  png_destroy_write_struct(&png, &info);
  return blob_of_file(f);
}

// Sample number i of a row, as packed in the file.
static int packed(const uint8_t *row, int bits, int i) {
  if (bits == 16) return row[2 * i] << 8 | row[2 * i + 1];
  int per = 8 / bits;
  return row[i / per] >> (8 - bits - i % per * bits) & ((1 << bits) - 1);
}

// Compare all samples with those that were packed.
static void check_samples(recipe r, const pixmap *p, uint8_t rows[11][13 * 8]) {
  bool indexed = r.type == PNG_COLOR_TYPE_PALETTE;
  int stored = indexed || r.type == PNG_COLOR_TYPE_GRAY ? 1
               : r.type == PNG_COLOR_TYPE_GRAY_ALPHA    ? 2
               : r.type == PNG_COLOR_TYPE_RGB           ? 3
                                                        : 4;
  int channels = (indexed ? 3 : stored) + r.transparent;
  assert_true(p->width == 13 && p->height == 11 && p->channels == channels);
  assert_int_equal(p->depth, r.bits == 16 ? 16 : 8);
  for (int y = 0; y < 11; y++)
    for (int x = 0; x < 13; x++) {
      int at = (y * 13 + x) * channels;
      int first = packed(rows[y], r.bits, x * stored);
      int want =
          indexed || r.bits >= 8 ? first : first * 255 / ((1 << r.bits) - 1);
      int got = p->depth == 16 ? ((uint16_t *)p->samples)[at]
                               : ((uint8_t *)p->samples)[at];
      assert_int_equal(got, want);
      if (indexed && r.transparent)
        assert_int_equal(((uint8_t *)p->samples)[at + 3], first / 2);
    }
}

// Every colour type and depth of the format, plain and interlaced, with and
// without a transparency chunk, gives the samples that were stored.
static void every_kind_is_read(void **state) {
  (void)state;
  const int types[] = {0, 0, 0, 0, 0, 2, 2, 3, 3, 3, 3, 4, 4, 6, 6};
  const int bits[] = {1, 2, 4, 8, 16, 8, 16, 1, 2, 4, 8, 8, 16, 8, 16};
  for (int i = 0; i < 15; i++)
    for (int k = 0; k < 4; k++) {
      recipe r = {types[i], bits[i], k & 1, (k & 2) && types[i] < 4};
      uint8_t rows[11][13 * 8];
      blob b = png_made(r, rows);
      arena mem = {0};
      pixmap p = load_all(b, &mem);
      check_samples(r, &p, rows);
      arena_free(&mem);
      free(b.bytes);
    }
}

// No damage is taken for a picture, and none does harm.
static void damaged_files(void **state) {
  (void)state;
  arena mem = {0};
  image im = test_image(&mem, 31, 9);
  blob b = png_of(&im, 8);
  check_truncations(PNG, b);
  check_flips(PNG, b);
  free(b.bytes);
  uint8_t rows[11][13 * 8];
  b = png_made((recipe){3, 4, 1, true}, rows);
  check_truncations(PNG, b);
  check_flips(PNG, b);
  free(b.bytes);
  arena_free(&mem);
}

// Store a width, a height and the checksum that makes the header good.
static void claim_size(blob b, uint32_t width, uint32_t height) {
  uint8_t *head = b.bytes + 12;  // "IHDR"
  for (int i = 0; i < 4; i++) {
    head[4 + i] = (uint8_t)(width >> (24 - 8 * i));
    head[8 + i] = (uint8_t)(height >> (24 - 8 * i));
  }
  uint32_t crc = 0xffffffffu;  // PNG specification, annex D
  for (int i = 0; i < 17; i++) {
    crc ^= head[i];
    for (int k = 0; k < 8; k++)
      crc = crc & 1 ? 0xedb88320u ^ crc >> 1 : crc >> 1;
  }
  for (int i = 0; i < 4; i++)
    head[17 + i] = (uint8_t)(~crc >> (24 - 8 * i));
}

// A small file that claims gigabytes is refused before they are asked for,
// and so is a side beyond the limit.
static void impossible_sizes(void **state) {
  (void)state;
  arena mem = {0};
  error err = {{0}};
  picture p = {0};
  image im = test_image(&mem, 2, 2);
  blob b = png_of(&im, 16);
  claim_size(b, 65535, 65535);
  assert_false(blob_load(PNG, b.bytes, b.size, &p, &mem, &err));
  assert_non_null(strstr(err.text, "too short for its width"));
  claim_size(b, 65536, 1);
  assert_false(blob_load(PNG, b.bytes, b.size, &p, &mem, &err));
  assert_non_null(strstr(err.text, "width exceeds"));
  claim_size(b, 2, 2);
  assert_true(blob_load(PNG, b.bytes, b.size, &p, &mem, &err));
  free(b.bytes);
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(codes_come_back),
      cmocka_unit_test(colour_space_is_named),
      cmocka_unit_test(every_kind_is_read),
      cmocka_unit_test(damaged_files),
      cmocka_unit_test(impossible_sizes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
