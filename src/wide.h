// wide.h — the wide tree with the instructions of this machine.

#ifndef WIDE_H
#define WIDE_H

#include "wide_tree.h"

// How many levels there are: base (what every processor of the architecture
// has), AVX2, AVX-512.
enum { WIDE_LEVELS = 3 };

// The kernel of a level, 0 .. WIDE_LEVELS - 1; NULL where this machine or this
// build does not have it.  Level 0 is always there.
const wide_level *wide_level_at(int level);

// The highest that there is.
const wide_level *wide_level_best(void);

// The tracer with the highest level that this machine has.  closest, any and
// both for many rays agree to the bit with the bvh and the list, on all levels.
tracer wide_tracer(const wide_tree *t);
tracer wide_tracer_at(const wide_tree *t, const wide_level *level);

#endif
