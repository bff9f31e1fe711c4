// tally.h — what a worker counts while it renders.

#ifndef TALLY_H
#define TALLY_H

#include "path_world.h"

typedef struct tally {
  path_stats paths;
  uint64_t samples, non_finite;
  uint64_t bad_sample, bad_pixel;  // the first dropped one, sample before pixel
} tally;

// Note a sample that is not finite.  The first is the one with the lowest
// sample number, then the lowest pixel, for any number of threads and passes.
void tally_drop(tally *t, uint64_t sample, uint64_t pixel);

// Add what another worker has counted.
void tally_add(tally *t, const tally *other);

#endif
