// bvh_shared.h — a tree in which long triangles have several boxes.

#ifndef BVH_SHARED_H
#define BVH_SHARED_H

#include "bvh.h"

// Of 100 triangles that are kept, at most so many boxes more are in leaves.
enum { BVH_SHARED_PERCENT = 75 };

// A tree for many rays over the mesh that another bvh names (positions, index
// and triangle_count; nothing else of it is read).  Bundles of up to eight
// triangles are cut where it pays, and each part is a leaf: leaves of a bundle
// share its triangles, and `bundles` is set.  It is bvh_split_build's tree
// where bundles would stay large, and bvh_build's for BVH_COARSE where
// nothing large (slab_large) is worth cutting, or so few `rays` are to be
// traced that a better tree would not repay its making; INFINITY: never mind.
// The same hits to the bit, the same tree for any number of threads.  Sets
// cut_rays, which is INFINITY where nothing is worth cutting.
//
// Source: Ernst, Greiner 2007, "Early Split Clipping for Bounding Volume
// Hierarchies".
void bvh_shared_build(bvh *out, const bvh *mesh, double rays, arena *mem,
                      pool *threads);

#endif
