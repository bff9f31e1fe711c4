// scalar.h — the larger and smaller of two floats, and the bound below 1.
//
// Floor 0: includes nothing of ours.

#ifndef SCALAR_H
#define SCALAR_H

// The greatest float below 1.
#define FLOAT_BELOW_1 0x1.fffffep-1f

// fmaxf and fminf, which compilers call from a library because they need not
// trust that no number is a NaN: a number beside a NaN wins.
static inline float float_max(float a, float b) {
  return a > b || b != b ? a : b;
}

static inline float float_min(float a, float b) {
  return a < b || b != b ? a : b;
}

#endif
