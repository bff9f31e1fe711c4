// bvh_split.h — a tree that keeps large triangles in several leaves.

#ifndef BVH_SPLIT_H
#define BVH_SPLIT_H

#include "bvh_read.h"

// Of 100 triangles that are kept, at most so many more are in the leaves.
enum { BVH_SPLIT_PERCENT = 30 };

// A tree over the mesh that another bvh names (positions, index and
// triangle_count; nothing else of it is read).  As bvh_build with BVH_COARSE,
// but where it pays space is cut, and triangles across the plane are in the
// leaves of both sides, each with the box of its part.  The same hits to the
// bit, the same tree for any number of threads.  It is bvh_build's own tree
// where none is large (slab_large) or so few `rays` are to be traced that a
// better tree would not repay its making; INFINITY: never mind.  Sets cut_rays,
// which is INFINITY where nothing is worth cutting.
//
// Source: Stich, Friedrich, Dietrich 2009, "Spatial Splits in Bounding Volume
// Hierarchies".
void bvh_split_build(bvh *out, const bvh *mesh, double rays, arena *mem,
                     pool *threads);

// cut_rays for a mesh of which all that can be hit has been read; b has its
// positions and index.  mem is for scratch.
double bvh_split_rays(const bvh *b, const bvh_source *from, arena *mem,
                      pool *threads);

#endif
