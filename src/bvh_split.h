// bvh_split.h — a tree that keeps large triangles in several leaves.

#ifndef BVH_SPLIT_H
#define BVH_SPLIT_H

#include "bvh.h"

// Of 100 triangles that are kept, at most so many more are in the leaves.
enum { BVH_SPLIT_PERCENT = 50 };

// As bvh_build with BVH_SAH, but where it pays space is cut, and triangles
// across the plane are in the leaves of both sides, each with the box of its
// part.  The same hits to the bit, the same tree for any number of threads.
// Without large triangles (slab_large) it is bvh_build's own tree.
//
// Source: Stich, Friedrich, Dietrich 2009, "Spatial Splits in Bounding Volume
// Hierarchies".
void bvh_split_build(bvh *out, const vec3 *positions, const uint32_t *index,
                     uint32_t triangle_count, arena *mem, pool *threads);

#endif
