// num.h — elementary functions that give the same bits on every machine.
//
// glibc picks its sinf, powf, ... by what the CPU can do, and the variants
// differ in the last bit.  A picture is a pure function of its scene, so the
// functions that a sample depends on are these.  sqrtf and division are
// correctly rounded everywhere and stay as they are.

#ifndef NUM_H
#define NUM_H

#include "vec.h"

// cos and sin of 2 pi u for u in [0, 1].  Absolute error <= 1.2e-7.
vec2 num_circle(float u);

// Base-2 logarithm of x > 0 and power of two; relative error of pow <= 1e-6
// for results in the float range.  num_pow(0, y > 0) is 0; x must not be < 0.
float num_log2(float x);
float num_exp2(float x);
float num_pow(float x, float y);

// The angle of (x, y) in turns, in [0, 1), 0 along +x; and acos(x) / pi in
// [0, 1] for x clamped to [-1, 1].  Absolute error <= 2e-7.
float num_turns(float y, float x);
float num_acos_pi(float x);

#endif
