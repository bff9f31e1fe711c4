// test_jpeg.c — JPEG files, made here by libjpeg itself.

#include "jpeg.h"

#include "pictures.h"

#include <jpeglib.h>

static const loader JPEG = {NULL, jpeg_load};

// A smooth picture of 40 x 24 with the given number of channels.
static uint8_t smooth(int x, int y, int c) {
  return (uint8_t)(c == 0 ? 20 + 5 * x : c == 1 ? 220 - 8 * y : 60 + 2 * x + y);
}

// The kinds of JPEG that the tests make.
typedef struct jpeg_kind {
  J_COLOR_SPACE space;
  int channels;
  bool progressive, arithmetic;
  const jpeg_scan_info *scans;  // 253 of them, or NULL
} jpeg_kind;

// A file of that kind.
static blob jpeg_made(jpeg_kind kind) {
  struct jpeg_compress_struct jpeg;
  struct jpeg_error_mgr manager;
  jpeg.err = jpeg_std_error(&manager);
  jpeg_create_compress(&jpeg);
  unsigned char *bytes = NULL;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &bytes, &size);
  jpeg.image_width = 40;
  jpeg.image_height = 24;
  jpeg.input_components = kind.channels;
  jpeg.in_color_space = kind.space;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 95, TRUE);
  jpeg.arith_code = kind.arithmetic;
  if (kind.progressive) jpeg_simple_progression(&jpeg);
  if (kind.scans != NULL) jpeg.scan_info = kind.scans, jpeg.num_scans = 253;
  jpeg_start_compress(&jpeg, TRUE);
  for (int y = 0; y < 24; y++) {
    uint8_t row[40 * 4];
    for (int i = 0; i < 40 * kind.channels; i++)
      row[i] = smooth(i / kind.channels, y, i % kind.channels);
    JSAMPROW from = row;
    jpeg_write_scanlines(&jpeg, &from, 1);
  }
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  return (blob){bytes, size};
}

// Grey and colour, baseline and progressive, come back within the loss of the
// format, and no damage is taken for a picture.
static void kinds_come_back(void **state) {
  (void)state;
  const jpeg_kind kinds[] = {{JCS_GRAYSCALE, 1, false, false, NULL},
                             {JCS_GRAYSCALE, 1, true, false, NULL},
                             {JCS_RGB, 3, false, false, NULL},
                             {JCS_RGB, 3, true, false, NULL}};
  for (int k = 0; k < 4; k++) {
    blob b = jpeg_made(kinds[k]);
    arena mem = {0};
    error err = {{0}};
    picture p = {0};
    if (!blob_load(JPEG, b.bytes, b.size, &p, &mem, &err))
      fail_msg("%s", err.text);
    int channels = kinds[k].channels;
    assert_true(p.stored.width == 40 && p.stored.height == 24);
    assert_true(p.stored.channels == channels && p.stored.depth == 8);
    const uint8_t *samples = p.stored.samples;
    for (int i = 0; i < 40 * 24 * channels; i++) {
      int x = i / channels % 40, y = i / channels / 40;
      assert_in_range(samples[i] + 9 - smooth(x, y, i % channels), 0, 18);
    }
    arena_free(&mem);
    check_truncations(JPEG, b);
    check_flips(JPEG, b);
    free(b.bytes);
  }
}

// Ink (CMYK) and arithmetic codes are refused with words, and a size that the
// file cannot hold before memory is asked for.
static void refused_kinds(void **state) {
  (void)state;
  arena mem = {0};
  error err = {{0}};
  picture p = {0};
  blob b = jpeg_made((jpeg_kind){JCS_CMYK, 4, false, false, NULL});
  assert_false(blob_load(JPEG, b.bytes, b.size, &p, &mem, &err));
  assert_non_null(strstr(err.text, "CMYK"));
  free(b.bytes);
  b = jpeg_made((jpeg_kind){JCS_GRAYSCALE, 1, false, true, NULL});
  assert_false(blob_load(JPEG, b.bytes, b.size, &p, &mem, &err));
  assert_non_null(strstr(err.text, "rithmetic"));
  free(b.bytes);
  for (int progressive = 0; progressive < 2; progressive++) {
    b = jpeg_made((jpeg_kind){JCS_RGB, 3, progressive, false, NULL});
    size_t at = 2;  // find the frame header, SOF0 or SOF2
    while (b.bytes[at + 1] != 0xc0 && b.bytes[at + 1] != 0xc2)
      at += 2 + ((size_t)b.bytes[at + 2] << 8 | b.bytes[at + 3]);
    memset(b.bytes + at + 5, 0xfb, 4);  // 64507 x 64507
    assert_false(blob_load(JPEG, b.bytes, b.size, &p, &mem, &err));
    assert_non_null(strstr(err.text, "too short"));
    free(b.bytes);
  }
}

// Spare bytes before the last marker, as some cameras write, lose nothing.
static void spare_bytes(void **state) {
  (void)state;
  arena mem = {0};
  error err = {{0}};
  picture p = {0}, q = {0};
  blob b = jpeg_made((jpeg_kind){JCS_RGB, 3, false, false, NULL});
  blob spare = {calloc(1, b.size + 5), b.size + 5};
  memcpy(spare.bytes, b.bytes, b.size - 2);
  memcpy(spare.bytes + b.size + 3, b.bytes + b.size - 2, 2);
  assert_true(blob_load(JPEG, b.bytes, b.size, &p, &mem, &err));
  assert_true(blob_load(JPEG, spare.bytes, spare.size, &q, &mem, &err));
  assert_memory_equal(p.stored.samples, q.stored.samples, 40 * 24 * 3);
  free(b.bytes);
  free(spare.bytes);
  arena_free(&mem);
}

// A file that sends each bit of each frequency in a scan of its own makes the
// reader walk over all of the picture 253 times, and is refused.
static void many_scans(void **state) {
  (void)state;
  static jpeg_scan_info scans[253] = {{1, {0}, 0, 0, 0, 0}};
  for (int i = 0; i < 252; i++) {
    int frequency = 1 + i % 63, bit = 3 - i / 63;
    scans[1 + i] = (jpeg_scan_info){
        1, {0}, frequency, frequency, bit == 3 ? 0 : bit + 1, bit};
  }
  arena mem = {0};
  error err = {{0}};
  picture p = {0};
  blob b = jpeg_made((jpeg_kind){JCS_GRAYSCALE, 1, .scans = scans});
  assert_false(blob_load(JPEG, b.bytes, b.size, &p, &mem, &err));
  assert_non_null(strstr(err.text, "200 scans"));
  free(b.bytes);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(kinds_come_back),
      cmocka_unit_test(refused_kinds),
      cmocka_unit_test(spare_bytes),
      cmocka_unit_test(many_scans),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
