// wide_patch.h — what a ray that leaves a surface need not look at: the part
// of the tree around it that lies below the facet it leaves.

#ifndef WIDE_PATCH_H
#define WIDE_PATCH_H

#include "wide_tree.h"

// It pays where a triangle sends out this many rays.
enum { WIDE_PATCH_RAYS = 64 };

// Look for the patches of a tree over so many triangles, and set t->patch where
// they are large enough to pay.  The patch of a triangle is a child of the tree
// that holds it, the largest found that no ray can hit which ray_climbs away
// from the triangle, on the side of its normal by the winding: each triangle in
// it is below the plane of the one that is left, or below a plane through one
// of its edges that rises outwards by RAY_CLIMB.  The same for any threads; in
// time that grows as the triangles.
void wide_patches_find(wide_tree *t, uint32_t triangles, arena *mem,
                       pool *threads);

// Patches of large triangles only, each the leaf that it is in: few, and soon
// found, but most rays may leave them.
void wide_patches_large(wide_tree *t, uint32_t triangles, arena *mem);

#endif
