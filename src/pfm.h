// pfm.h — portable float maps: the raw floats, nothing lost.

#ifndef PFM_H
#define PFM_H

#include "error.h"
#include "image.h"

#include <stdio.h>

// Read a colour (PF) or grey (Pf) map, either byte order, as it stands: also
// NaN and negative values.  name is for messages.
bool pfm_load(image *out, FILE *f, const char *name, arena *mem, error *err);

// Write a little-endian colour map, bottom row first as the format has it.
bool pfm_save(const image *im, FILE *f, const char *name, error *err);

#endif
