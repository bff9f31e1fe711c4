// wide_patch.h — what a ray that leaves a surface need not look at: the part
// of the tree around it that lies below the facet it leaves.

#ifndef WIDE_PATCH_H
#define WIDE_PATCH_H

#include "wide_tree.h"

// It pays where a triangle sends out this many rays.
enum { WIDE_PATCH_RAYS = 64 };

// Look for the patches of a tree over so many triangles, and set t->patch where
// many of these have one of more than a leaf.  The patch of a triangle is a
// child of the tree that holds it, the largest that is found to lie below: no
// corner in it is on the side of the triangle's plane to which its normal by
// the winding points, so that what ray_climbs from the triangle hits nothing of
// it.  The same for any threads; in time that grows as the triangles.
void wide_patches_find(wide_tree *t, uint32_t triangles, arena *mem,
                       pool *threads);

#endif
