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

// A box for the part of triangle p that lies in `box` and in the slice: it
// lies in both, and holds every point of both that is within 2^-41 of the
// triangle along each axis, in units of its largest coordinate there.  False
// when there is no such point.
bool bvh_split_clip(sah_box *out, const sah_box *box, const vec3 p[3],
                    bvh_slice slice);

#endif
