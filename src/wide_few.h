// wide_few.h — rays that stop at any hit, where there are few triangles.
//
// Then a tree is not worth its stacks and lists.  Eight rays with the same
// longest axis ask the box of every leaf, and in it triangle after triangle, a
// ray a lane.

#ifndef WIDE_FEW_H
#define WIDE_FEW_H

#include "wide_faces.h"
#include "wide_together.h"

// So many triangles are few; rays that are sorted by axis together.
enum { FEW_TRIANGLES = 64, FEW_RAYS = 1024 };

// The leaves of a tree and their boxes.
typedef struct few_leaves {
  const wide_tree *t;
  uint32_t count, child[FEW_TRIANGLES];
  float lo[FEW_TRIANGLES][3], hi[FEW_TRIANGLES][3];
} few_leaves;

// Eight rays along axis[2], ray i with numbers at row i of a stream; bit i of
// alive: nothing stops ray i so far.  As columns and, for triangles that those
// do not decide, one by one.
typedef struct few_rays {
  leaf_tests of;
  f8 begin, end, error;  // end: tmax and a bit
  const uint32_t *axis;
  const ray *ray[8];
  uint32_t alive;
  float sx[8], sy[8], sz[8], inv[3][8], enter[3][8], leave[3][8];
} few_rays;

SIMD bool is_few(const wide_tree *t) {
  return t->nodes != NULL && t->triangle_count <= FEW_TRIANGLES &&
         t->node_count <= WIDE;
}

// Of few nodes: there is room for all of their children.
SIMD void few_leaves_of(few_leaves *l, const wide_tree *t) {
  l->t = t;
  l->count = 0;
  for (uint32_t i = 0; i < t->node_count; i++) {
    const wide_node *n = &t->nodes[i];
    for (uint32_t m = n->valid; m != 0; m &= m - 1) {
      uint32_t c = (uint32_t)__builtin_ctz(m);
      if ((n->child[c] & WIDE_LEAF_BIT) == 0) continue;
      for (int k = 0; k < 3; k++) {
        float lower = n->plane[k][0][c], upper = n->plane[k][1][c];
        l->lo[l->count][k] = n->base[k] + lower * n->scale[k];
        l->hi[l->count][k] = n->base[k] + upper * n->scale[k];
      }
      l->child[l->count++] = n->child[c];
    }
  }
}

#endif
