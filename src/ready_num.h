// ready_num.h — functions of num.h without branches, for loops over lanes.

#ifndef READY_NUM_H
#define READY_NUM_H

#include "num.h"

#include <stdint.h>

// num_circle for u in [0, 1].
static inline vec2 lane_circle(float u) {
  int quarter = (int)(u * 4 + 0.5f);
  vec2 r = num_octant_circle((u - (float)quarter * 0.25f) * (2 * PI));
  float cosine = (quarter & 1) != 0 ? r.y : r.x,
        sine = (quarter & 1) != 0 ? r.x : r.y;
  return (vec2){((quarter + 1) & 2) != 0 ? -cosine : cosine,
                (quarter & 2) != 0 ? -sine : sine};
}

// floorf of what an int32_t holds.
static inline float lane_floor(float x) {
  float near = (float)(int32_t)x;
  return x < near ? near - 1 : near;
}

// num_turns.
static inline float lane_turns(float y, float x) {
  float ax = fabsf(x), ay = fabsf(y);
  int flat = ay <= ax;
  float t = num_octant_turns(flat ? ay : ax, flat ? ax : ay);
  t = flat ? t : 0.25f - t;
  t = x < 0 ? 0.5f - t : t;
  t = y < 0 ? 1 - t : t;
  t = ax + ay > 0 ? t : 0;
  return t < 1 ? t : 0;
}

#endif
