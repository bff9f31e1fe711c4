// bvh_part.c — what one thread does to one node, and to all below it.

#include "bvh_part.h"

#include <string.h>

// A leaf of the median method: nothing is priced, so the size decides.
enum { MEDIAN_LEAF = 4 };

// How often n triangles must be halved until one is left.
static int halvings(uint32_t n) {
  int k = 0;
  for (; n > 1; n -= n / 2)
    k++;
  return k;
}

// Few triangles need few.
int bvh_bins_for(uint32_t n, bvh_method method) {
  if (method == BVH_MEDIAN) return 2;
  int most = method == BVH_SAH_16 ? 16 : method == BVH_SAH_8 ? 8 : SAH_MAX_BINS;
  int bins = n < 8 * SAH_MAX_BINS ? 4 + (int)(n / 8) : SAH_MAX_BINS;
  return bins < most ? bins : most;
}

// Every part keeps depth + halvings <= BVH_MAX_DEPTH: cuts may be as uneven as
// they like until only halving can keep it.
sah_grid bvh_part_grid(const bvh_part *p, bvh_method method) {
  uint32_t n = p->end - p->begin;
  sah_grid none = {0};
  if (n < 2 || p->depth + halvings(n) >= BVH_MAX_DEPTH) return none;
  if (method == BVH_COARSE && n <= BVH_COARSE_LEAF) return none;
  sah_grid g = sah_grid_of(&p->centres, bvh_bins_for(n, method));
  bool flat = g.scale[0] == 0 && g.scale[1] == 0 && g.scale[2] == 0;
  return flat ? none : g;
}

bool bvh_cut_choose(bvh_cut *cut, const bvh_part *p, const sah_bins *bins,
                    bvh_method method) {
  uint32_t n = p->end - p->begin;
  cut->split = (sah_split){.axis = -1};
  if (method == BVH_MEDIAN) {
    if (n <= MEDIAN_LEAF) return false;
    if (cut->grid.bins > 0)
      cut->split = sah_middle_split(bins, &cut->grid, &p->centres);
    return true;
  }
  if (method == BVH_COARSE && n <= BVH_COARSE_LEAF) return false;
  double area = sah_half_area(&p->box);
  if (cut->grid.bins > 0)
    cut->split = sah_best_split(bins, &cut->grid, &p->box);
  if (method == BVH_ONES) return n > 1;
  if (n > BVH_MAX_LEAF) return true;
  return cut->split.axis >= 0 && cut->split.cost < area * n;
}

bvh_node bvh_node_of(const sah_box *b, uint32_t first, uint32_t count) {
  return (bvh_node){{b->lo[0], b->lo[1], b->lo[2]},
                    first,
                    {b->hi[0], b->hi[1], b->hi[2]},
                    count};
}

sah_box bvh_part_centres(const sah_ref *refs, const bvh_part *p) {
  sah_box all = sah_box_empty();
  sah_lanes lo = sah_load(all.lo), hi = sah_load(all.hi);
  for (uint32_t i = p->begin; i < p->end; i++) {
    sah_lanes c = sah_centre(&refs[i].box);
    lo = sah_min(c, lo);
    hi = sah_max(c, hi);
  }
  sah_grow(&all, lo, hi);
  return all;
}

static void bin_refs(sah_bins *bins, const sah_grid *g, const sah_ref *refs,
                     size_t n) {
  sah_bins_clear(bins, g);
  sah_bins_add(bins, g, refs, n);
}

static void move_refs(bvh_move *m) {
  sah_ref *left = m->to[0], *right = m->to[1];
  for (uint32_t i = m->begin; i < m->end; i++) {
    const sah_ref *r = &m->refs[i];
    bool goes_left = bvh_cut_left(m->cut, m->part, r, i);
    *(goes_left ? left : right) = *r;
    left += goes_left;
    right += !goes_left;
  }
  bvh_part side[2] = {{.end = (uint32_t)(left - m->to[0])},
                      {.end = (uint32_t)(right - m->to[1])}};
  for (int k = 0; k < 2; k++)
    m->centres[k] = bvh_part_centres(m->to[k], &side[k]);
}

// Halves by position: only the bounds must be found.
static void part_in_halves(const bvh_part *p, const sah_ref *refs,
                           bvh_part child[2]) {
  uint32_t middle = p->begin + (p->end - p->begin + 1) / 2;
  child[0].end = child[1].begin = middle;
  for (int side = 0; side < 2; side++) {
    bvh_part *c = &child[side];
    c->box = c->centres = sah_box_empty();
    for (uint32_t i = c->begin; i < c->end; i++) {
      sah_box_join(&c->box, &refs[i].box);
      sah_box_join_centre(&c->centres, &refs[i].box);
    }
  }
}

// Left ones to the front, right ones behind them, both in their order; every
// ref is written to both sides, so that the processor need not guess.
static void part_by_cut(const bvh_task *t, const bvh_part *p,
                        const bvh_cut *cut, bvh_part child[2]) {
  sah_ref *left = t->refs + p->begin, *right = t->spare;
  for (uint32_t i = p->begin; i < p->end; i++) {
    sah_ref r = t->refs[i];
    size_t goes_left = bvh_cut_left(cut, p, &r, i);
    *left = *right = r;
    left += goes_left;
    right += 1 - goes_left;
  }
  memcpy(left, t->spare, (size_t)(right - t->spare) * sizeof *left);
  child[0].end = child[1].begin = (uint32_t)(left - t->refs);
  child[0].box = cut->split.left;
  child[1].box = cut->split.right;
  for (int side = 0; side < 2; side++)
    child[side].centres = bvh_part_centres(t->refs, &child[side]);
}

bool bvh_task_split(bvh_task *t, const bvh_part *p, bvh_part child[2]) {
  bvh_cut cut = {.grid = bvh_part_grid(p, t->method)};
  sah_bins bins;
  if (cut.grid.bins > 0)
    bin_refs(&bins, &cut.grid, t->refs + p->begin, p->end - p->begin);
  if (!bvh_cut_choose(&cut, p, &bins, t->method)) {
    t->nodes[p->node] = bvh_node_of(&p->box, p->begin, p->end - p->begin);
    if (p->depth > t->depth) t->depth = p->depth;
    return false;
  }
  t->nodes[p->node] = bvh_node_of(&p->box, t->node_count, 0);
  for (int side = 0; side < 2; side++) {
    child[side] = (bvh_part){.begin = p->begin, .end = p->end};
    child[side].node = t->node_count++;
    child[side].depth = p->depth + 1;
  }
  if (cut.split.axis < 0)
    part_in_halves(p, t->refs, child);
  else
    part_by_cut(t, p, &cut, child);
  return true;
}

// Depth first, left side first, so that a walk down the left finds its nodes
// beside each other.  The stack holds one right side a level.
void bvh_task_run(bvh_task *t) {
  bvh_part stack[BVH_MAX_DEPTH + 1], child[2];
  int top = 0;
  stack[top++] = t->root;
  stack[0].node = 0;
  t->node_count = 1;
  t->depth = t->root.depth;
  while (top > 0) {
    bvh_part p = stack[--top];
    while (bvh_task_split(t, &p, child)) {
      stack[top++] = child[1];
      p = child[0];
    }
  }
}

const bvh_hands bvh_plain_hands = {bin_refs, move_refs, bvh_task_run};

// Costs of so many nodes are added up in one go.
enum { NODES = 4096 };

// Sums of costs: sum[i] of all nodes from i NODES on.
typedef struct cost_sums {
  const bvh *b;
  double *sum;
} cost_sums;

// Each node costs what it does times the chance that a line through the root's
// box meets its box.
static void sum_costs(void *context, size_t item, int worker) {
  (void)worker;
  const cost_sums *to = context;
  uint32_t begin = (uint32_t)item * NODES, count = to->b->node_count;
  double sum = 0;
  for (uint32_t i = begin; i < count && i - begin < NODES; i++) {
    const bvh_node *n = &to->b->nodes[i];
    double price = n->count > 0 ? (double)n->count : SAH_NODE_COST;
    sum += price * aabb_half_area((aabb){n->lo, n->hi});
  }
  to->sum[item] = sum;
}

double bvh_cost(const bvh *b, pool *threads) {
  arena mem = {0};
  size_t items = b->node_count / NODES + 1;
  cost_sums to = {b, ARENA_NEW(&mem, double, items)};
  pool_run_near(threads, items, sum_costs, &to);
  double sum = 0;
  for (size_t i = 0; i < items; i++)
    sum += to.sum[i];
  arena_free(&mem);
  double all = aabb_half_area((aabb){b->nodes[0].lo, b->nodes[0].hi});
  return all > 0 ? sum / all : 0;
}
