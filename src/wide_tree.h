// wide_tree.h — a tree whose nodes have up to eight children.

#ifndef WIDE_TREE_H
#define WIDE_TREE_H

#include "wide_cost.h"

// Eight boxes in two lines of the cache.  Along axis k, byte q of lo or hi
// stands for the plane base[k] + q scale[k], rounded to float: never inside
// the child that it bounds.  scale has 16 bits or fewer, so that the product is
// exact.  Bit i of valid: child i is there.
typedef struct wide_node {
  float base[3], scale[3];
  uint8_t plane[3][2][WIDE];  // of an axis the lower ones, then the upper ones
  uint32_t child[WIDE];       // see wide_leaf_first
  uint32_t valid, spare[5];
} wide_node;

// A tree made of a bvh.  The triangles of a leaf are copied together: with n
// of them, x of corner 0 n times, y, z, then corners 1 and 2, then their n
// numbers; 40 bytes a triangle and no gaps, in the order of the bvh.  Leaves
// may share their triangles.
typedef struct wide_tree {
  float lo[4], hi[4];   // its box; the fourth number is never read
  float large;          // slab_large of the box
  wide_node *nodes;     // nodes[0] is the root; NULL when there is nothing
  uint32_t *triangles;  // ten words a triangle, floats but for the numbers
  uint32_t node_count, triangle_count;
  int depth;
  double seconds;  // to make it of the bvh
  // By number of triangle, its patch (wide_patch.h), or 0; NULL: none is known.
  uint32_t *patch;
  uint32_t patch_count;  // triangles that may have one, if patch is not NULL
  bool patches_looked_for;
} wide_tree;

// No triangle more can be numbered by a child.
#define WIDE_MAX_TRIANGLES (UINT32_C(1) << 28)
#define WIDE_LEAF_BIT (UINT32_C(1) << 31)

// A child is a node's number, or with WIDE_LEAF_BIT a run of 1..8 triangles.
static inline uint32_t wide_leaf_first(uint32_t child) {
  return child & (WIDE_MAX_TRIANGLES - 1);
}

static inline uint32_t wide_leaf_count(uint32_t child) {
  return (child >> 28 & 7) + 1;
}

// Make the wide tree over the same triangles; the same for any threads.  The
// bvh is not needed after it.  Empty when b is, or beyond WIDE_MAX_TRIANGLES.
void wide_tree_build(wide_tree *out, const bvh *b, arena *mem, pool *threads);

// Room in mem for the nodes and triangles that t counts.
void wide_tree_room(wide_tree *t, arena *mem);

// Bytes of nodes, triangles and patches.
size_t wide_tree_bytes(const wide_tree *t);

// A leaf, the node that it is a child of, and the parent of every node; and by
// how much n . x of unit n may be wrong in single precision.
typedef struct wide_leaf_place {
  const uint32_t *parent;
  uint32_t node, leaf;
  float unsure;
} wide_leaf_place;

// The instructions that a kernel was compiled for, and its entries; tree is a
// wide_tree.  NULL entries where the compiler could not make them.
typedef struct wide_level {
  const char *name;
  bool (*closest)(const void *tree, const ray *r, hit *h);
  bool (*any)(const void *tree, const ray *r);
  void (*closest_many)(const void *tree, const ray *rays, const uint32_t *left,
                       hit *hits, size_t n);
  void (*any_many)(const void *tree, const ray *rays, bool *blocked, size_t n);
  // closest, counting into *v; a leaf is a node.
  bool (*closest_counted)(const void *tree, const ray *r, hit *h,
                          bvh_visits *v);
  // The patches of the triangles of a leaf, or 0 (wide_patch.h); the sum of
  // the levels that they are above the leaf.
  uint32_t (*patches)(const wide_tree *t, const wide_leaf_place *at,
                      uint32_t *patch);
} wide_level;

#endif
