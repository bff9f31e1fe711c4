// build_avx2.c — hands for AVX2, where the Makefile could ask for it.

#include "build_levels.h"

#if defined(__AVX2__)
#include "build_split.h"

const bvh_hands build_avx2 = {bin_lanes, move_lanes, run_lanes};
#else
const bvh_hands build_avx2 = {NULL, NULL, NULL};
#endif
