// wide_pending.h — triangles that rays may hit, of many rays and leaves.
//
// Of the triangles of a leaf a ray passes through one or two.  They are put
// side by side with those of other rays, and eight at a time are looked at more
// closely.

#ifndef WIDE_PENDING_H
#define WIDE_PENDING_H

#include "wide_flight.h"

// As many as the leaves of all flights can give, and what is written beyond.
enum { PENDING = FLIGHTS * WIDE_LEAF + 8 };

// A candidate is a column: its corners, axes turned; its triangle; the number
// of its flight.
typedef struct pending {
  uint32_t count;
  uint32_t flight[PENDING], triangle[PENDING];
  float corner[9][PENDING];
} pending;

// Empty.  Lanes beyond the last candidate name flight 0, which there is.
SIMD void pending_clear(pending *q) {
  q->count = 0;
  memset(q->flight, 0, sizeof q->flight);
}

// Write the lanes m of a leaf behind the first `count` and return the new
// count. There is no branch, whatever m is.
SIMD uint32_t pending_add(pending *q, uint32_t count, const leaf_corners *at,
                          const uint32_t *list, uint32_t m) {
  f8_lanes lanes = f8_lanes_of(m);
  f8_squeeze(q->corner[0] + count, at->of[0], lanes);
  f8_squeeze(q->corner[1] + count, at->of[1], lanes);
  f8_squeeze(q->corner[2] + count, at->of[2], lanes);
  f8_squeeze(q->corner[3] + count, at->of[3], lanes);
  f8_squeeze(q->corner[4] + count, at->of[4], lanes);
  f8_squeeze(q->corner[5] + count, at->of[5], lanes);
  f8_squeeze(q->corner[6] + count, at->of[6], lanes);
  f8_squeeze(q->corner[7] + count, at->of[7], lanes);
  f8_squeeze(q->corner[8] + count, at->of[8], lanes);
  f8 number = f8_load((const float *)(const void *)list);
  f8_squeeze(q->triangle + count, number, lanes);
  return count + (uint32_t)__builtin_popcount(m);
}

// The corners of the eight candidates from number i on.
SIMD void pending_corners(leaf_corners *at, const pending *q, uint32_t i) {
  at->of[0] = f8_load(q->corner[0] + i);
  at->of[1] = f8_load(q->corner[1] + i);
  at->of[2] = f8_load(q->corner[2] + i);
  at->of[3] = f8_load(q->corner[3] + i);
  at->of[4] = f8_load(q->corner[4] + i);
  at->of[5] = f8_load(q->corner[5] + i);
  at->of[6] = f8_load(q->corner[6] + i);
  at->of[7] = f8_load(q->corner[7] + i);
  at->of[8] = f8_load(q->corner[8] + i);
}

// The eight candidates from number i on, with their rays.
SIMD void pending_tests(leaf_tests *of, const pending *q, uint32_t i,
                        const flight *flights, float large) {
  const char *row[8];
  const uint32_t *from = q->flight + i;
  for (int k = 0; k < 8; k++)
    row[k] = (const char *)&flights[from[k]].w;
  tests_of_walks(of, row, large);
  pending_corners(&of->at, q, i);
}

#endif
