// wide_cost.h — which nodes of a binary tree become children of a wide one.
//
// Source: Ylitie, Karras, Laine 2017, section 3.1: the cheapest way to draw a
// binary tree together, by dynamic programming from its leaves.

#ifndef WIDE_COST_H
#define WIDE_COST_H

#include "bvh.h"

// Children of a node at most, triangles of a leaf at most.
enum { WIDE = 8, WIDE_LEAF = 8 };

// For each node of the binary tree: the triangles below it; how it is drawn
// together where it has 2 to 8 places, three bits each from the lowest: so many
// of them are its left child's, or with 0 it needs one fewer; and how many wide
// nodes are below one that stands for it.
typedef struct wide_cost {
  uint32_t below, ways, inner;
} wide_cost;

// Of all nodes, in mem; the same for any threads.
const wide_cost *wide_costs_of(const bvh *b, arena *mem, pool *threads);

// Whether all below a node is cheapest as one leaf.
static inline bool wide_is_leaf(const wide_cost *c) {
  return c->ways >> 31 != 0;
}

// The cheapest children of a node of the wide tree that stands for all below
// node `from`; their number.
uint32_t wide_children(const bvh *b, const wide_cost *costs, uint32_t from,
                       uint32_t child[WIDE]);

#endif
