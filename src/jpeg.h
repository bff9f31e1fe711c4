// jpeg.h — JPEG files through libjpeg.

#ifndef JPEG_H
#define JPEG_H

#include "error.h"
#include "image.h"

#include <stdio.h>

// Read a baseline or progressive JPEG with Huffman codes, grey or colour, as
// 8-bit samples.  Damaged or incomplete data is an error.  name is for
// messages.  Limits: IMAGE_MAX_SIDE a side.  out and mem untouched on failure.
bool jpeg_load(pixmap *out, FILE *f, const char *name, arena *mem, error *err);

#endif
