// ready_num.h — functions of num.h without branches, for loops over lanes.

#ifndef READY_NUM_H
#define READY_NUM_H

#include "num.h"

// num_circle for u in [0, 1].
static inline vec2 lane_circle(float u) {
  int quarter = (int)(u * 4 + 0.5f);
  float x = (u - (float)quarter * 0.25f) * (2 * PI), x2 = x * x;
  float s = x + x * x2 *
                    (-1.0f / 6 +
                     x2 * (1.0f / 120 + x2 * (-1.0f / 5040 + x2 / 362880)));
  float c = 1 + x2 * (-0.5f + x2 * (1.0f / 24 +
                                    x2 * (-1.0f / 720 + x2 * (1.0f / 40320))));
  float cosine = (quarter & 1) != 0 ? s : c, sine = (quarter & 1) != 0 ? c : s;
  return (vec2){((quarter + 1) & 2) != 0 ? -cosine : cosine,
                (quarter & 2) != 0 ? -sine : sine};
}

// first_octant_turns of num.c.
static inline float lane_octant(float y, float x) {
  int far = y > 0.41421356f * x;
  float z = (far ? y - x : y) / (far ? y + x : x), z2 = z * z;
  float tail =
      z2 * (-1.0f / 3 +
            z2 * (1.0f / 5 +
                  z2 * (-1.0f / 7 +
                        z2 * (1.0f / 9 + z2 * (-1.0f / 11 +
                                               z2 * (1.0f / 13 - z2 / 15))))));
  float angle = z + z * tail;
  return (far ? 0.125f : 0) + angle * 0.159154943f;
}

static inline float lane_turns(float y, float x) {
  float ax = fabsf(x), ay = fabsf(y);
  int flat = ay <= ax;
  float t = lane_octant(flat ? ay : ax, flat ? ax : ay);
  t = flat ? t : 0.25f - t;
  t = x < 0 ? 0.5f - t : t;
  t = y < 0 ? 1 - t : t;
  t = ax + ay > 0 ? t : 0;
  return t < 1 ? t : 0;
}

#endif
