// png.c

#include "png.h"

#include "file.h"

#include <assert.h>
#include <png.h>
#include <setjmp.h>
#include <string.h>
#include <zlib.h>

// Deflate, the compression of PNG, codes 258 bytes with 2 bits at best.
// Source: RFC 1951, section 3.2.5 (length code 285, one bit; distance, one).
enum { DEFLATE_MAX_RATIO = 1032 };

// One file in work, so that nothing that matters is a local variable of the
// function that longjmp returns to.
typedef struct png_job {
  png_structp png;
  png_infop info;
  arena scratch;
  pixmap map;
  uint64_t file_bytes;
  char problem[200];
} png_job;

// libpng's last word: keep it and leave through longjmp.
static _Noreturn void png_failed(png_structp png, const char *text) {
  png_job *job = png_get_error_ptr(png);
  size_t n = strlen(job->problem);
  snprintf(job->problem + n, sizeof job->problem - n, "%s%s",
           n == 0 ? "" : ": ", text);
  png_longjmp(png, 1);
}

// A warning is kept only until the next: the one before an error explains it.
static void png_warned(png_structp png, const char *text) {
  png_job *job = png_get_error_ptr(png);
  snprintf(job->problem, sizeof job->problem, "%s", text);
}

// Ask for samples of 8 or 16 bits and no palette.
static void png_widen(png_job *job) {
  png_set_expand(job->png);  // palette, 1, 2 and 4 bits, tRNS
  const uint16_t one = 1;
  if (*(const uint8_t *)&one == 1) png_set_swap(job->png);
}

// Read all into job.  Errors leave by longjmp.
static void png_decode(png_job *job, FILE *f) {
  png_init_io(job->png, f);
  png_set_user_limits(job->png, IMAGE_MAX_SIDE, IMAGE_MAX_SIDE);
  // Texts and profiles are not used; libpng would clear a buffer of the length
  // that a chunk claims before it looks whether the file has so much.
  png_set_keep_unknown_chunks(job->png, PNG_HANDLE_CHUNK_NEVER, NULL, -1);
  png_read_info(job->png, job->info);
  pixmap *map = &job->map;
  map->width = (int)png_get_image_width(job->png, job->info);
  map->height = (int)png_get_image_height(job->png, job->info);
  uint64_t packed =
      png_get_rowbytes(job->png, job->info) * (uint64_t)map->height;
  if (packed / DEFLATE_MAX_RATIO > job->file_bytes ||
      !image_fits(map->width, map->height, job->file_bytes))
    png_error(job->png, "the file is too short for its width and height");
  png_widen(job);
  int passes = png_set_interlace_handling(job->png);
  png_read_update_info(job->png, job->info);
  map->channels = png_get_channels(job->png, job->info);
  map->depth = png_get_bit_depth(job->png, job->info);
  size_t row = png_get_rowbytes(job->png, job->info);
  uint8_t *bytes = arena_alloc(&job->scratch, (size_t)map->height, row);
  map->samples = bytes;
  for (int pass = 0; pass < passes; pass++)
    for (int y = 0; y < map->height; y++)
      png_read_row(job->png, bytes + (size_t)y * row, NULL);
  png_read_end(job->png, NULL);
}

// The place that longjmp comes back to.
static bool png_try_decode(png_job *job, FILE *f) {
  if (setjmp(png_jmpbuf(job->png)) != 0) return false;
  png_decode(job, f);
  return true;
}

bool png_load(pixmap *out, FILE *f, const char *name, arena *mem, error *err) {
  png_job job = {.file_bytes = file_left(f)};
  job.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &job, png_failed,
                                   png_warned);
  if (job.png != NULL) job.info = png_create_info_struct(job.png);
  bool ok = job.info != NULL && png_try_decode(&job, f);
  if (job.png != NULL) png_destroy_read_struct(&job.png, &job.info, NULL);
  if (ok) {
    arena_adopt(mem, &job.scratch);
    *out = job.map;
    return true;
  }
  arena_free(&job.scratch);
  return fail(err, "%s: not a whole PNG file: %s", name,
              job.problem[0] == '\0' ? "libpng did not start" : job.problem);
}

// One row of im as samples of 8 or 16 bits, the latter most significant byte
// first as PNG has it.
static void png_pack_row(uint8_t *row, const image *im, int y, int depth,
                         const srgb_table *table) {
  for (int x = 0; x < im->width; x++) {
    vec3 p = im->pixels[(size_t)y * (size_t)im->width + (size_t)x];
    float rgb[3] = {p.x, p.y, p.z};
    for (int c = 0; c < 3; c++) {
      if (depth == 8) {
        *row++ = srgb_code(table, rgb[c]);
        continue;
      }
      uint16_t code = srgb_code16(rgb[c]);
      *row++ = (uint8_t)(code >> 8);
      *row++ = (uint8_t)(code & 255);
    }
  }
}

// How hard to compress.  A rendered picture repeats nothing but runs of what
// one filter leaves of smooth shading: looking for runs alone takes a sixth of
// the time that looking for anything does, for 2 % more bytes.
static void png_set_effort(png_structp png) {
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_PAETH);
  png_set_compression_strategy(png, Z_RLE);
}

// Write all of im.  Errors leave by longjmp.
static void png_encode(png_job *job, const image *im, int depth, FILE *f) {
  png_init_io(job->png, f);
  png_set_effort(job->png);
  png_set_IHDR(job->png, job->info, (png_uint_32)im->width,
               (png_uint_32)im->height, depth, PNG_COLOR_TYPE_RGB,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  // The chunk sRGB, and for readers that do not know it gAMA and cHRM.
  png_set_sRGB_gAMA_and_cHRM(job->png, job->info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(job->png, job->info);
  srgb_table table = srgb_table_new();
  uint8_t *row =
      arena_alloc(&job->scratch, (size_t)im->width * 3, (size_t)depth / 8);
  for (int y = 0; y < im->height; y++) {
    png_pack_row(row, im, y, depth, &table);
    png_write_row(job->png, row);
  }
  png_write_end(job->png, NULL);
}

// The same place for writing.
static bool png_try_encode(png_job *job, const image *im, int depth, FILE *f) {
  if (setjmp(png_jmpbuf(job->png)) != 0) return false;
  png_encode(job, im, depth, f);
  return true;
}

bool png_save(const image *im, int depth, FILE *f, const char *name,
              error *err) {
  assert(depth == 8 || depth == 16);
  png_job job = {0};
  job.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &job, png_failed,
                                    png_warned);
  if (job.png != NULL) job.info = png_create_info_struct(job.png);
  bool ok = job.info != NULL && png_try_encode(&job, im, depth, f);
  if (job.png != NULL) png_destroy_write_struct(&job.png, &job.info);
  arena_free(&job.scratch);
  return ok || fail(err, "%s: cannot be written as PNG: %s", name, job.problem);
}
