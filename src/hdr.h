// hdr.h — Radiance pictures: RGB with a shared exponent, four bytes a pixel.

#ifndef HDR_H
#define HDR_H

#include "error.h"
#include "image.h"

#include <stdio.h>

// Read a Radiance picture: flat, old and new run lengths, all eight
// orientations; EXPOSURE and COLORCORR are divided out; XYZE is converted.
// name is for messages.
bool hdr_load(image *out, FILE *f, const char *name, arena *mem, error *err);

// Write with new run lengths.  Rounds to nearest; negative and NaN become 0.
bool hdr_save(const image *im, FILE *f, const char *name, error *err);

#endif
