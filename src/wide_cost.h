// wide_cost.h — which nodes of a binary tree become children of a wide one.
//
// Source: Ylitie, Karras, Laine 2017, section 3.1: the cheapest way to draw a
// binary tree together, by dynamic programming from its leaves.

#ifndef WIDE_COST_H
#define WIDE_COST_H

#include "bvh.h"

// Children of a node at most, triangles of a leaf at most.
enum { WIDE = 8, WIDE_LEAF = 8 };

// For each node of the binary tree: the triangles below it, and costs in visits
// to nodes per random ray.  For i < 7, of[i] is what all below costs as at most
// i + 1 trees side by side; of[7], as up to 8 of which the node itself is none.
typedef struct wide_cost {
  float of[WIDE];
  uint32_t below;
} wide_cost;

// The costs of all nodes, in mem; the same for any threads.
const wide_cost *wide_costs_of(const bvh *b, arena *mem, pool *threads);

// Whether all below a node is cheapest as one leaf.
bool wide_is_leaf(const bvh *b, const wide_cost *costs, uint32_t node);

// The cheapest children of a node of the wide tree that stands for all below
// node `from`; their number.
uint32_t wide_children(const bvh *b, const wide_cost *costs, uint32_t from,
                       uint32_t child[WIDE]);

#endif
