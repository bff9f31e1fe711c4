// wide_single.h — one ray down the wide tree.

#ifndef WIDE_SINGLE_H
#define WIDE_SINGLE_H

#include "wide_leaf.h"

// Places of a stack: each level of the tree leaves at most WIDE - 1.
enum { WIDE_STACK = (WIDE - 1) * BVH_MAX_DEPTH + 1 };

// A child to come back to, and where the ray enters it.
typedef struct wide_later {
  float near;
  uint32_t child;
} wide_later;

// Put the children of mask m on the stack, the nearest on top.
SIMD wide_later *push_sorted(wide_later *top, const wide_node *n, uint32_t m,
                             const float near[8]) {
  wide_later *first = top;
  for (; m != 0; m &= m - 1) {
    uint32_t i = (uint32_t)__builtin_ctz(m);
    wide_later it = {near[i], n->child[i]};
    wide_later *at = top++;
    for (; at > first && at[-1].near < it.near; at--)
      *at = at[-1];
    *at = it;
  }
  return top;
}

// Visit what the ray enters no later than the best hit, nearest first; `<=`
// and not `<`, as in bvh.c.  v, unless NULL, counts.
SIMD bool walk_tree(wide_walk *w, const wide_tree *t, bool any, bvh_visits *v) {
  wide_later stack[WIDE_STACK], *top = stack;
  bool found = false;
  *top++ = (wide_later){w->tmin, 0};
  while (top > stack) {
    wide_later it = *--top;
    if (it.near > w->best.t) continue;
    if (v != NULL) v->nodes++;
    if (it.child & WIDE_LEAF_BIT) {
      if (v != NULL) v->triangles += wide_leaf_count(it.child);
      if (!walk_leaf(w, t, it.child, any)) continue;
      if (any) return true;
      found = true;
      continue;
    }
    const wide_node *n = &t->nodes[it.child];
    f8 at;
    uint32_t m = cut_node(w, n, &at);
    float near[8];
    f8_store(near, at);
    top = push_sorted(top, n, m, near);
  }
  return found;
}

#endif
