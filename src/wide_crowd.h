// wide_crowd.h — rays that stop at any hit, together down the wide tree.
//
// Nothing asks such rays to visit what is near first.  So they need not go
// each its own way: all that enter a node are asked for its children at once,
// and those that enter the same child go on as one list.
//
// Source: Tsakok 2009; Barringer, Akenine-Möller 2014.

#ifndef WIDE_CROWD_H
#define WIDE_CROWD_H

#include "wide_stream.h"

// Rays of a crowd, at most; how many numbers its lists may hold: all rays in
// each of the root's children, and again as many; the shortest list that stays
// together.
enum { CROWD = 1024, WAITING = 2 * WIDE * CROWD, TOGETHER = 3 };

// What a ray needs at nodes, in one line of the cache: slab_ray, but the
// origin moved up for the lower plane of an axis and down for the upper one,
// whichever the ray meets first.  The other numbers are those of wide_walk;
// `until` is tmax, or -1 once the ray is blocked.
typedef struct crowd_ray {
  float inv[3], reach, up[3], turn_x;
  float down[3], turn_y, until, begin, spare[2];
} crowd_ray;

_Static_assert(sizeof(crowd_ray) == 64, "one line");

// What it needs at leaves: wide_walk's first row, but for the last number: the
// longest axis.
typedef struct crowd_shear {
  float o[3], sx, sy, sz, tmin;
  uint32_t kz;
} crowd_shear;

// A child and the rays that enter it: `count` numbers from `first` on.
typedef struct crowd_part {
  uint32_t child, first, count;
} crowd_part;

// Lists of rays, one behind the other, and what is written beyond.
typedef struct crowd_lists {
  uint32_t count, used;
  crowd_part part[WAITING];
  uint32_t ray[WAITING + 8];
} crowd_lists;

// A crowd: `count` rays of a stream, from number `first` on.  Of `pending`,
// `flight` is a ray's number.
typedef struct crowd {
  stream *s;
  uint32_t first, count;
  _Alignas(64) crowd_ray at_node[CROWD];
  crowd_shear at_leaf[CROWD];
  crowd_lists nodes, leaves, now;
  lone_rays alone;
  pending pending;
} crowd;

// Rays that go alone, to the end.
static void crowd_alone(crowd *q) {
  stream *s = q->s;
  s->count = q->alone.count;
  s->taken = s->ready.next = s->ready.count = 0;
  stream_trace(s, true);
  q->alone.count = 0;
}

// Ray i goes alone from a child on.
SIMD void crowd_leave(crowd *q, uint32_t i, uint32_t child) {
  q->alone.ray[q->alone.count] = q->first + i;
  q->alone.child[q->alone.count++] = child;
  if (q->alone.count == LONELY) crowd_alone(q);
}

#endif
