// bvh_bundle.h — triangles that stay together, and parts of all of them.

#ifndef BVH_BUNDLE_H
#define BVH_BUNDLE_H

#include "bvh.h"
#include "sah_box.h"

// Triangles of a bundle at most.
enum { BVH_BUNDLE = 8 };

// Triangles order[first .. first + count - 1] of a tree.  A box around all of
// them is entered by flat + excess rays, in units of those that enter the box
// of the tree; in k parts, by about flat + excess / k.  Parts at + 0, 1, ... of
// a list of all are its own: so many were asked for and so many made.
typedef struct bvh_bundle {
  uint32_t first, count, parts, made;
  uint64_t at;
  double flat, excess;
} bvh_bundle;

// Whether a box is longer than `least` along an axis.
bool bvh_bundle_large(const sah_box *box, float least);

// Cut a bundle into at most `parts` >= 1 parts, and write their boxes; the
// number of these.  Triangles longer than `least`, slab_large, are cut: every
// point of one that may be hit is, as a box of neighbouring floats, in a box of
// out, and every other triangle is whole in one.
uint32_t bvh_bundle_cut(const bvh *b, const bvh_bundle *u, float least,
                        uint32_t parts, sah_ref *out);

// Set flat and excess; `all` is half the area of the tree's box.
void bvh_bundle_measure(const bvh *b, bvh_bundle *u, float least, double all);

#endif
