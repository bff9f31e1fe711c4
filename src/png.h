// png.h — PNG files through libpng.

#ifndef PNG_FILE_H
#define PNG_FILE_H

#include "error.h"
#include "image.h"

#include <stdio.h>

// Read all of a PNG of any colour type, depth and interlace; name is for
// messages.  Limits: IMAGE_MAX_SIDE a side.  out and mem untouched on failure.
bool png_load(pixmap *out, FILE *f, const char *name, arena *mem, error *err);

// Write im as sRGB with depth 8 or 16 bits a channel, with the chunks sRGB,
// gAMA and cHRM that say so.  NaN becomes 0, values are clamped to [0, 1].
bool png_save(const image *im, int depth, FILE *f, const char *name,
              error *err);

#endif
