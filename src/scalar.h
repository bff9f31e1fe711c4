// scalar.h — the larger and smaller of two floats, the integer below one, and
// the bound below 1.
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

// floorf, which compilers call from a library because not every processor has
// an instruction for it.  From 2^23 on all floats are integers.
static inline float float_floor(float x) {
  int small = (x > -0x1p23f) & (x < 0x1p23f);
  float near = (float)(int)(small ? x : 0);
  float below = x < near ? near - 1 : near;
  return small ? below : x;
}

#endif
