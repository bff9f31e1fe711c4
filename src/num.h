// num.h — elementary functions that give the same bits on every machine.
//
// glibc picks its sinf, powf, ... by what the CPU can do, and the variants
// differ in the last bit.  A picture is a pure function of its scene, so the
// functions that a sample depends on are these.  sqrtf and division are
// correctly rounded everywhere and stay as they are.

#ifndef NUM_H
#define NUM_H

#include "vec.h"

#define NUM_TURNS_PER_RADIAN 0.159154943f

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

// What these do once they know the octant, without branches, so that many can
// be done at once.  The first: cos and sin of x in [-pi / 4, pi / 4].
static inline vec2 num_octant_circle(float x) {
  float x2 = x * x;
  float s = x + x * x2 *
                    (-1.0f / 6 +
                     x2 * (1.0f / 120 + x2 * (-1.0f / 5040 + x2 / 362880)));
  float c = 1 + x2 * (-0.5f + x2 * (1.0f / 24 +
                                    x2 * (-1.0f / 720 + x2 * (1.0f / 40320))));
  return (vec2){c, s};
}

// atan(y / x) in turns for 0 <= y <= x, x > 0.  Above tan(pi / 8) the angle
// from the diagonal is smaller; the series ends where the next term is below
// 4e-9 turns.
static inline float num_octant_turns(float y, float x) {
  int far = y > 0.41421356f * x;
  float z = (far ? y - x : y) / (far ? y + x : x), z2 = z * z;
  float tail =
      z2 * (-1.0f / 3 +
            z2 * (1.0f / 5 +
                  z2 * (-1.0f / 7 +
                        z2 * (1.0f / 9 + z2 * (-1.0f / 11 +
                                               z2 * (1.0f / 13 - z2 / 15))))));
  float angle = z + z * tail;
  return (far ? 0.125f : 0) + angle * NUM_TURNS_PER_RADIAN;
}

#endif
