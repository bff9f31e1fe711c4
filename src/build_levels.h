// build_levels.h — hands for sets of instructions.

#ifndef BUILD_LEVELS_H
#define BUILD_LEVELS_H

#include "bvh_part.h"

// All NULL where the compiler could not make them.
extern const bvh_hands build_avx2;

#endif
