// bvh_part.h — one node of a tree on its way: decide, part, go below.

#ifndef BVH_PART_H
#define BVH_PART_H

#include "bvh.h"
#include "sah.h"

// A node to be: refs begin..end-1 of an array, the bounds of their boxes and
// those of their centres, and the node's number.
typedef struct bvh_part {
  uint32_t begin, end, node;
  int depth;
  sah_box box, centres;
} bvh_part;

// How to part it: a cut of its grid, or halves by position where split.axis
// is -1.
typedef struct bvh_cut {
  sah_grid grid;
  sah_split split;
} bvh_cut;

// Slices for a part of n refs.
int bvh_bins_for(uint32_t n, bvh_method method);

// The grid to bin the part's refs on, before bvh_cut_choose; with 0 bins where
// the part can only be halved: its centres agree, or the depth runs out.
sah_grid bvh_part_grid(const bvh_part *p, bvh_method method);

// Decide by the bins of all refs of the part.  False: make it a leaf.
bool bvh_cut_choose(bvh_cut *cut, const bvh_part *p, const sah_bins *bins,
                    bvh_method method);

// Whether the ref at a position of the array goes left.
static inline bool bvh_cut_left(const bvh_cut *cut, const bvh_part *p,
                                const sah_ref *ref, uint32_t position) {
  if (cut->split.axis < 0)
    return position - p->begin < (p->end - p->begin + 1) / 2;
  // sah_slices_of along one axis, without the rounding down.
  int k = cut->split.axis;
  float centre = 0.5f * ref->as.lo[k] + 0.5f * ref->as.hi[k];
  float x = (centre - cut->grid.lo[k]) * cut->grid.scale[k];
  return x < (float)(cut->split.after + 1);
}

// The bounds of the centres of a part's refs.
sah_box bvh_part_centres(const sah_ref *refs, const bvh_part *p);

// Refs begin..end-1 of a part that is cut, and where the left and the right
// ones go, in their order; found on the way are the bounds of their centres.
typedef struct bvh_move {
  const bvh_part *part;
  const bvh_cut *cut;
  const sah_ref *refs;
  uint32_t begin, end;
  sah_ref *to[2];
  sah_box centres[2];
} bvh_move;

// A subtree for one thread: refs and root are given, nodes has room for two a
// ref, spare for each once.  On return the root is nodes[0], inner nodes count
// from there, leaves count in the array of refs, which is reordered.
typedef struct bvh_task {
  bvh_part root;
  sah_ref *refs, *spare;
  bvh_method method;
  bvh_node *nodes;
  uint32_t node_count;
  int depth;
} bvh_task;

void bvh_task_run(bvh_task *t);

// Make part p of a task an inner node and its two parts; false when it became
// a leaf.
bool bvh_task_split(bvh_task *t, const bvh_part *p, bvh_part child[2]);

// Who does the work on refs: bins n of them, moves them, runs a task.
typedef struct bvh_hands {
  void (*bin)(sah_bins *bins, const sah_grid *g, const sah_ref *refs, size_t n);
  void (*move)(bvh_move *m);
  void (*run)(bvh_task *t);
} bvh_hands;

// The functions of this module.  Others may do the same by other instructions,
// to the bit.
extern const bvh_hands bvh_plain_hands;

// The expected cost of a tree, as in bvh; the same for any threads.
double bvh_cost(const bvh *b, pool *threads);

// A node with the bounds of a box.
bvh_node bvh_node_of(const sah_box *b, uint32_t first, uint32_t count);

#endif
