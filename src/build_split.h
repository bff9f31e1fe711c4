// build_split.h — a subtree by one thread, in lanes.  For AVX2.

#ifndef BUILD_SPLIT_H
#define BUILD_SPLIT_H

#include "build_move.h"

#if defined(__AVX2__)

// Counts of slices are exact up to so many.
enum { MOST = 1 << 24 };

// A node to be, as bvh_part, with boxes in lanes.
typedef struct lane_part {
  f8 box, centres;
  uint32_t begin, end, node;
  int depth;
} lane_part;

SIMD lane_part part_lanes(const bvh_part *p) {
  return (lane_part){box_load(&p->box), box_load(&p->centres),
                     p->begin,          p->end,
                     p->node,           p->depth};
}

// What is rare is left to the plain hands.
APART bool split_plainly(bvh_task *t, const lane_part *p, lane_part child[2]) {
  bvh_part to[2], from = {.begin = p->begin, .end = p->end};
  from.node = p->node;
  from.depth = p->depth;
  box_store(&from.box, p->box);
  box_store(&from.centres, p->centres);
  if (!bvh_task_split(t, &from, to)) return false;
  child[0] = part_lanes(&to[0]);
  child[1] = part_lanes(&to[1]);
  return true;
}

SIMD bool put_leaf(bvh_task *t, const lane_part *p) {
  sah_box box;
  box_store(&box, p->box);
  t->nodes[p->node] = bvh_node_of(&box, p->begin, p->end - p->begin);
  if (p->depth > t->depth) t->depth = p->depth;
  return false;
}

// Whether a leaf of n refs is cheaper than the cut, as bvh_cut_choose has it.
SIMD bool leaf_pays(const lane_part *p, const lane_cut *cut, uint32_t n) {
  sah_box box;
  box_store(&box, p->box);
  double area = sah_half_area(&box), unit = (double)cut->unit;
  double cost = (double)cut->price / (unit * unit) + SAH_NODE_COST * area;
  return !(cost < area * n);
}

// Part the refs of a node, and number its children.
SIMD void put_parts(bvh_task *t, const lane_part *p, const sah_grid *g,
                    const lane_cut *cut, lane_part child[2]) {
  sah_ref *refs = t->refs + p->begin;
  lane_ways ways = {.to = {refs, t->spare}};
  refs_part(&ways, refs, p->end - p->begin, g, cut, true);
  uint32_t rights = (uint32_t)(ways.to[1] - t->spare), middle = p->end - rights;
  for (uint32_t i = 0; i < rights; i++)
    ways.to[0][i] = t->spare[i];
  sah_box box;
  box_store(&box, p->box);
  t->nodes[p->node] = bvh_node_of(&box, t->node_count, 0);
  for (int side = 0; side < 2; side++) {
    child[side].centres = ways.centres[side];
    child[side].begin = side == 0 ? p->begin : middle;
    child[side].end = side == 0 ? middle : p->end;
    child[side].node = t->node_count++;
    child[side].depth = p->depth + 1;
  }
}

// bvh_task_split.  A ceiling of the logarithm of n is how often n is halved.
SIMD bool split_lanes(bvh_task *t, const lane_part *p, lane_part child[2]) {
  uint32_t n = p->end - p->begin;
  if (n == 1 || (t->method == BVH_COARSE && n <= BVH_COARSE_LEAF))
    return put_leaf(t, p);
  sah_grid g = grid_of(p->centres, bvh_bins_for(n, t->method));
  bool flat = g.scale[0] == 0 && g.scale[1] == 0 && g.scale[2] == 0;
  if (flat || n > MOST || t->method == BVH_MEDIAN ||
      p->depth + 32 - __builtin_clz(n - 1) >= BVH_MAX_DEPTH)
    return split_plainly(t, p, child);
  lane_bins bins;
  bins_fill(&bins, &g, t->refs + p->begin, n);
  lane_cut cut = cut_find(&bins, &g, p->box);
  if (cut.axis < 0) return split_plainly(t, p, child);
  if (n <= BVH_MAX_LEAF && t->method != BVH_ONES && leaf_pays(p, &cut, n))
    return put_leaf(t, p);
  child[0].box = slices_bound(bins.slice[cut.axis], 0, cut.after + 1);
  child[1].box = slices_bound(bins.slice[cut.axis], cut.after + 1, g.bins);
  put_parts(t, p, &g, &cut, child);
  return true;
}

// bvh_task_run.
static void run_lanes(bvh_task *t) {
  lane_part stack[BVH_MAX_DEPTH + 1], child[2];
  int top = 0;
  stack[top++] = part_lanes(&t->root);
  stack[0].node = 0;
  t->node_count = 1;
  t->depth = t->root.depth;
  while (top > 0) {
    lane_part p = stack[--top];
    while (split_lanes(t, &p, child)) {
      stack[top++] = child[1];
      p = child[0];
    }
  }
}

#endif

#endif
