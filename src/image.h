// image.h — rectangles of linear RGB, and the sRGB curve.

#ifndef IMAGE_H
#define IMAGE_H

#include "arena.h"
#include "vec.h"

#include <stdint.h>

// Row 0 is the top row; pixel (x, y) is pixels[y * width + x].  Linear RGB
// radiance unless the holder says otherwise.
typedef struct image {
  int width, height;
  vec3 *pixels;
} image;

// Sides are limited to this, so that a count of pixels fits 32 bits.
enum { IMAGE_MAX_SIDE = 65535 };

// Whether a file of so many bytes may hold a picture of that size, 0 <= width,
// height <= IMAGE_MAX_SIDE: at most IMAGE_BYTE_PIXELS for each byte, as deflate
// gives of bytes, or IMAGE_FREE_PIXELS in all.  More is no picture but an
// attempt at our memory.
bool image_fits(int width, int height, uint64_t file_bytes);

enum { IMAGE_BYTE_PIXELS = 1032, IMAGE_FREE_PIXELS = 1 << 24 };

// A black image that lives as long as a.  Needs 0 < width, height <=
// IMAGE_MAX_SIDE.
image image_new(arena *a, int width, int height);

// A side from the text of a file header: decimal digits and nothing else, in
// 1 .. IMAGE_MAX_SIDE.  False, and *side untouched, otherwise.
bool image_parse_side(const char *text, int *side);

// Pixels of an image file as stored: `channels` (1 grey, 2 grey + alpha, 3
// RGB, 4 RGBA) samples a pixel, rows from the top, no padding.  depth 8: one
// byte a sample; 16: a uint16_t in the machine's order.  Palettes and fewer
// bits are widened on reading.
typedef struct pixmap {
  int width, height, channels, depth;
  void *samples;
} pixmap;

// The sRGB transfer curve, both ways, in double precision; x in [0, 1].
// Source: IEC 61966-2-1:1999, section 5.2.  Its two pieces meet within 1e-7.
double srgb_encode(double x);
double srgb_decode(double y);

// threshold[k]: the smallest float whose code is k + 1.  Exact: a value's code
// is the integer nearest to 255 srgb_encode(value).
typedef struct srgb_table {
  float threshold[255];
} srgb_table;

srgb_table srgb_table_new(void);

// The 8-bit code of linear x: NaN and below 0 give 0, above 1 gives 255.
uint8_t srgb_code(const srgb_table *t, float x);

// The same with 16 bits: the integer nearest to 65535 srgb_encode(x).
uint16_t srgb_code16(float x);

// The stored pixels as numbers in [0, 1], grey spread to RGB, alpha left out;
// decoded to linear when `decode`.
image image_from_pixmap(arena *a, const pixmap *p, bool decode);

#endif
