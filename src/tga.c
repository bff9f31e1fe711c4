// tga.c

#include "tga.h"

#include "file.h"

#include <string.h>

// A packet of run lengths holds at most this many pixels.
// Source: Truevision TGA FFS 2.0, "Run-length encoded images".
enum { TGA_MAX_RUN = 128 };

// Bytes of the header before the image's own name.
enum { TGA_HEADER_BYTES = 18 };

// The header, and what follows from it.
typedef struct tga_header {
  int name_bytes;           // of a text to skip
  int type;                 // 1 palette, 2 colour, 3 grey
  bool runs;                // in run lengths
  int first, entries;       // the palette's first index and its length
  int entry_bits;           // of a palette entry
  int width, height, bits;  // bits of a pixel as it lies in the file
  int alpha_bits;
  bool from_right, from_top;
  int channels;  // of the result
} tga_header;

// Two bytes, the least significant first.
static int tga_short(const uint8_t *b) {
  return b[0] | b[1] << 8;
}

// Bytes of something with that many bits.
static int bytes_of_bits(int bits) {
  return (bits + 7) / 8;
}

// Whether a colour may have that many bits.
static bool tga_colour_bits(int bits) {
  return bits == 15 || bits == 16 || bits == 24 || bits == 32;
}

// Understand a header; false when it is none that is read here.
static bool tga_parse(tga_header *h, const uint8_t *b) {
  int type = b[2];
  *h = (tga_header){.name_bytes = b[0],
                    .type = type & 7,
                    .runs = type & 8,
                    .first = tga_short(b + 3),
                    .entries = tga_short(b + 5),
                    .entry_bits = b[7],
                    .width = tga_short(b + 12),
                    .height = tga_short(b + 14),
                    .bits = b[16],
                    .alpha_bits = b[17] & 15,
                    .from_right = b[17] & 16,
                    .from_top = b[17] & 32};
  bool palette = h->type == 1;
  if (type > 11 || h->type < 1 || h->type > 3) return false;
  if (b[1] > 1 || b[17] > 63 || h->width == 0 || h->height == 0) return false;
  if (palette && (b[1] != 1 || h->entries == 0)) return false;
  if (b[1] == 1 && !tga_colour_bits(h->entry_bits)) return false;
  if (b[1] == 0) h->entries = 0;
  int colour = palette ? h->entry_bits : h->bits;
  h->channels = h->type == 3 ? 1 : colour == 32 && h->alpha_bits > 0 ? 4 : 3;
  if (h->type == 2) return tga_colour_bits(h->bits);
  return h->bits == 8 || (palette && h->bits == 16);
}

bool tga_is_plausible(const unsigned char *bytes, size_t n) {
  tga_header h;
  return n >= TGA_HEADER_BYTES && tga_parse(&h, bytes);
}

// One file in work.
typedef struct tga_job {
  FILE *f;
  tga_header h;
  uint8_t *palette;  // entries * channels samples
  pixmap map;
} tga_job;

// A colour of 15 to 32 bits as red, green, blue, alpha.  Five bits are widened
// to eight by repeating their top bits, so that 31 becomes 255.
static void tga_colour(uint8_t *to, const uint8_t *b, int bits) {
  to[3] = 255;
  if (bits > 16) {
    to[0] = b[2], to[1] = b[1], to[2] = b[0];
    if (bits == 32) to[3] = b[3];
    return;
  }
  int v = tga_short(b);
  for (int c = 0; c < 3; c++) {
    int five = v >> (10 - 5 * c) & 31;
    to[c] = (uint8_t)(five << 3 | five >> 2);
  }
}

// Read the palette, if the file has one.  False when the file ends.
static bool tga_read_palette(tga_job *job, arena *mem) {
  const tga_header *h = &job->h;
  job->palette = arena_alloc(mem, (size_t)h->entries, 4);
  for (int i = 0; i < h->entries; i++) {
    uint8_t b[4];
    size_t n = (size_t)bytes_of_bits(h->entry_bits);
    if (fread(b, 1, n, job->f) != n) return false;
    tga_colour(job->palette + 4 * i, b, h->entry_bits);
  }
  return true;
}

// The samples of one pixel from its bytes.  False for an index outside the
// palette.
static bool tga_pixel(const tga_job *job, uint8_t rgba[4], const uint8_t *b) {
  const tga_header *h = &job->h;
  if (h->type == 2) tga_colour(rgba, b, h->bits);
  if (h->type == 3) rgba[0] = b[0];
  if (h->type != 1) return true;
  int index = (h->bits == 8 ? b[0] : tga_short(b)) - h->first;
  if (index < 0 || index >= h->entries) return false;
  memcpy(rgba, job->palette + 4 * index, 4);
  return true;
}

// Store pixel number i of the file where its corner and direction say.
static void tga_store(tga_job *job, int64_t i, const uint8_t rgba[4]) {
  const tga_header *h = &job->h;
  int64_t x = i % h->width, y = i / h->width;
  if (h->from_right) x = h->width - 1 - x;
  if (!h->from_top) y = h->height - 1 - y;
  size_t at = (size_t)(y * h->width + x) * (size_t)h->channels;
  memcpy((uint8_t *)job->map.samples + at, rgba, (size_t)h->channels);
}

// The next pixel of the file.
static bool tga_next(tga_job *job, uint8_t rgba[4], const char **why) {
  uint8_t b[4];
  size_t n = (size_t)bytes_of_bits(job->h.bits);
  *why = "the file ends early";
  if (fread(b, 1, n, job->f) != n) return false;
  *why = "an index is outside the palette";
  return tga_pixel(job, rgba, b);
}

// Read all pixels; NULL, or why not.
static const char *tga_read_pixels(tga_job *job) {
  int64_t n = (int64_t)job->h.width * job->h.height;
  for (int64_t i = 0; i < n;) {
    const char *why;
    int count = 1;
    bool repeat = false;
    if (job->h.runs) {
      int head = getc(job->f);
      if (head == EOF) return "the file ends early";
      count = (head & 127) + 1;
      repeat = head & 128;
    }
    // A run may go on in the next row (some writers do that), but not past
    // the last pixel.
    if (count > n - i) return "a run of pixels leaves the picture";
    uint8_t rgba[4] = {0};
    for (int k = 0; k < count; k++) {
      if ((k == 0 || !repeat) && !tga_next(job, rgba, &why)) return why;
      tga_store(job, i++, rgba);
    }
  }
  return NULL;
}

// Read what follows the header; NULL, or why not.
static const char *tga_read_rest(tga_job *job, arena *mem) {
  const tga_header *h = &job->h;
  if (fseeko(job->f, h->name_bytes, SEEK_CUR) != 0) return "it cannot seek";
  if (!tga_read_palette(job, mem)) return "the file ends in its palette";
  uint64_t n = (uint64_t)h->width * (uint64_t)h->height;
  uint64_t pixel = (uint64_t)bytes_of_bits(h->bits);
  uint64_t least = h->runs ? n / TGA_MAX_RUN * (pixel + 1) : n * pixel;
  if (least > file_left(job->f))
    return "the file is too short for its width and height";
  job->map = (pixmap){h->width, h->height, h->channels, 8, NULL};
  job->map.samples = arena_alloc(mem, n, (size_t)h->channels);
  return tga_read_pixels(job);
}

bool tga_load(pixmap *out, FILE *f, const char *name, arena *mem, error *err) {
  tga_job job = {.f = f};
  uint8_t head[TGA_HEADER_BYTES];
  if (fread(head, 1, sizeof head, f) != sizeof head || !tga_parse(&job.h, head))
    return fail(err, "%s: not a TGA file of type 1, 2, 3, 9, 10 or 11", name);
  arena scratch = {0};
  const char *why = tga_read_rest(&job, &scratch);
  if (why != NULL) {
    arena_free(&scratch);
    return fail(err, "%s: not a whole TGA file: %s", name, why);
  }
  arena_adopt(mem, &scratch);
  *out = job.map;
  return true;
}
