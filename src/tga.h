// tga.h — Truevision TGA files, an old format that OBJ textures still use.

#ifndef TGA_H
#define TGA_H

#include "error.h"
#include "image.h"

#include <stdio.h>

// Whether the first n bytes of a file can be a TGA header.  The format has no
// magic number: ask after all others have said no.
bool tga_is_plausible(const unsigned char *bytes, size_t n);

// Read types 1, 2, 3 (palette, colour, grey) and 9, 10, 11 (the same in run
// lengths) with 8, 15, 16, 24 or 32 bits, from any corner, as 8-bit samples.
// name is for messages.  out and mem untouched on failure.
bool tga_load(pixmap *out, FILE *f, const char *name, arena *mem, error *err);

#endif
