// part_set.h — parts that are to become one picture.

#ifndef PART_SET_H
#define PART_SET_H

#include "part.h"
#include "report.h"

typedef struct part_set {
  const char *const *paths;
  part *parts;  // heads
  size_t count;
} part_set;

// Read the heads of count > 0 files.
bool part_set_read(part_set *out, const char *const *paths, size_t count,
                   arena *mem, error *err);

// Whether they are finished parts of one picture, and have each of its tiles
// once.  What is wrong is said in why, a warning each.
bool part_set_fits(const part_set *s, report *why);

// The whole of a set that fits.
bool part_set_join(part *out, const part_set *s, arena *mem, error *err);

#endif
