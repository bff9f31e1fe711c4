// picture.h — whole image files, by suffix, read safely and written whole.

#ifndef PICTURE_H
#define PICTURE_H

#include "error.h"
#include "image.h"
#include "report.h"

typedef enum picture_format {
  PICTURE_UNKNOWN,
  PICTURE_PNG,
  PICTURE_PFM,
  PICTURE_HDR,
  PICTURE_JPEG,  // read only
  PICTURE_TGA    // read only
} picture_format;

// By the suffix of a path (".png", any case) or a bare name ("png").
picture_format picture_format_of(const char *path);

// What the first bytes of a file say it is.
picture_format picture_sniff(const unsigned char *bytes, size_t n);

// An image as it lies in its file: linear floats (PFM, HDR) or pixmap samples.
typedef struct picture {
  bool is_linear;
  image linear;   // when is_linear
  pixmap stored;  // else
} picture;

// Read path, whose content decides its format.  Refuses anything that is not
// a regular file.  Non-finite and negative radiance is repaired and counted
// with one warning: NaN and below 0 become 0, infinity the largest float.
bool picture_read(picture *out, const char *path, arena *mem, report *r,
                  error *err);

// The same as linear light: 8 and 16-bit samples are taken as sRGB.
bool picture_read_linear(image *out, const char *path, arena *mem, report *r,
                         error *err);

// Write im (linear) to path in the given format: into a temporary file beside
// it, flushed, then renamed, so that path is either the old file or the whole
// new one.  A path that exists and is no regular file (a pipe, /dev/null) is
// written directly; "-" is standard output.  depth is 8 or 16, PNG only.
bool picture_write(const image *im, const char *path, picture_format format,
                   int depth, error *err);

#endif
