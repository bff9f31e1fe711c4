// bvh_split_clip.h — the box of a part of a triangle, never too small.

#ifndef BVH_SPLIT_CLIP_H
#define BVH_SPLIT_CLIP_H

#include "sah.h"
#include "vec.h"

#include <stdbool.h>

// Between two planes across an axis.
typedef struct bvh_slice {
  int axis;
  float lo, hi;
} bvh_slice;

// A triangle ready to be cut: its corners, and by how much along each axis
// parts of it are widened.
typedef struct bvh_outline {
  double v[3][3], margin[3];
} bvh_outline;

bvh_outline bvh_outline_of(const vec3 p[3]);

// A box for the part of a triangle that lies in `box` and in the slice: it
// lies in both, and holds every point of both that is within 2^-41 of the
// triangle along each axis, in units of its largest coordinate there.  False
// when there is no such point.
bool bvh_split_clip(sah_box *out, const sah_box *box, const bvh_outline *t,
                    bvh_slice slice);

#endif
