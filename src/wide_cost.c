// wide_cost.c — from the leaves up, all ways to share eight places.

#include "wide_cost.h"

// What a leaf costs, and each of its triangles, in visits to nodes: all are
// tested at once, but each must be fetched.
#define LEAF_COST 0.8f
#define TRIANGLE_COST 0.1f

// About so many parts of the tree are work items.
enum { PARTS = 256 };

// What the threads share: nodes above the parts, and the roots of these.
typedef struct cost_job {
  const bvh *b;
  wide_cost *costs;
  double all;  // half the area of the root
  uint32_t *above, *part;
  uint32_t above_count, part_count;
} cost_job;

static float area_of(const bvh *b, double all, uint32_t node) {
  const bvh_node *n = &b->nodes[node];
  return (float)(aabb_half_area((aabb){n->lo, n->hi}) / all);
}

// The cost of all below a node as one leaf.
static float leaf_cost(float area, uint32_t count) {
  return area * (LEAF_COST + TRIANGLE_COST * (float)count);
}

// The least cost of left and right as `places` trees together, and how many
// of these the left one gets.
static float share_places(const wide_cost *l, const wide_cost *r, int places,
                          int *left) {
  float least = INFINITY;
  for (int k = 1; k < places; k++) {
    float cost = l->of[k - 1] + r->of[places - k - 1];
    if (cost >= least) continue;
    least = cost;
    *left = k;
  }
  return least;
}

// The costs of a node whose children have theirs.
static void find_cost(const cost_job *job, uint32_t node) {
  const bvh_node *n = &job->b->nodes[node];
  wide_cost *c = &job->costs[node];
  float area = area_of(job->b, job->all, node);
  if (n->count > 0) {
    c->below = n->count;
    for (int i = 0; i < WIDE; i++)
      c->of[i] = leaf_cost(area, n->count);
    return;
  }
  const wide_cost *l = &job->costs[n->first], *r = l + 1;
  int left;
  c->below = l->below + r->below;
  c->of[WIDE - 1] = share_places(l, r, WIDE, &left);
  c->of[0] = area + c->of[WIDE - 1];
  // What is shared has one layout, and is not joined to anything.
  if (c->below <= WIDE_LEAF && job->b->bundles == NULL)
    c->of[0] = fminf(c->of[0], leaf_cost(area, c->below));
  for (int i = 1; i < WIDE - 1; i++)
    c->of[i] = fminf(c->of[i - 1], share_places(l, r, i + 1, &left));
}

// A part of the tree, children before their parents: each node is met twice.
static void cost_part(void *context, size_t item, int worker) {
  (void)worker;
  const cost_job *job = context;
  uint32_t stack[2 * BVH_MAX_DEPTH + 2], top = 0;
  bool again[2 * BVH_MAX_DEPTH + 2];
  again[top] = false;
  stack[top++] = job->part[item];
  while (top > 0) {
    uint32_t node = stack[top - 1];
    const bvh_node *n = &job->b->nodes[node];
    if (n->count > 0 || again[top - 1]) {
      find_cost(job, node);
      top--;
      continue;
    }
    again[top - 1] = true;
    for (uint32_t k = 0; k < 2; k++) {
      again[top] = false;
      stack[top++] = n->first + 1 - k;
    }
  }
}

// Divide the tree into parts, level by level.
static void find_parts(cost_job *job, arena *scratch) {
  uint32_t room = job->b->node_count < PARTS ? job->b->node_count : PARTS;
  job->above = ARENA_NEW(scratch, uint32_t, 2 * (size_t)room);
  job->part = ARENA_NEW(scratch, uint32_t, 2 * (size_t)room);
  uint32_t *queue = ARENA_NEW(scratch, uint32_t, 4 * (size_t)room + 2);
  uint32_t head = 0, tail = 0;
  queue[tail++] = 0;
  while (head < tail) {
    uint32_t node = queue[head++];
    const bvh_node *n = &job->b->nodes[node];
    if (n->count > 0 || job->part_count + (tail - head) + 1 >= room) {
      job->part[job->part_count++] = node;
      continue;
    }
    job->above[job->above_count++] = node;
    queue[tail++] = n->first;
    queue[tail++] = n->first + 1;
  }
}

const wide_cost *wide_costs_of(const bvh *b, arena *mem, pool *threads) {
  arena scratch = {0};
  cost_job job = {.b = b};
  job.all = aabb_half_area((aabb){b->nodes[0].lo, b->nodes[0].hi});
  job.costs = ARENA_NEW(mem, wide_cost, b->node_count);
  find_parts(&job, &scratch);
  pool_run(threads, job.part_count, cost_part, &job);
  while (job.above_count > 0)
    find_cost(&job, job.above[--job.above_count]);
  arena_free(&scratch);
  return job.costs;
}

bool wide_is_leaf(const bvh *b, const wide_cost *costs, uint32_t node) {
  const wide_cost *c = &costs[node];
  if (b->nodes[node].count > 0) return true;
  if (c->below > WIDE_LEAF || b->bundles != NULL) return false;
  const bvh_node *root = &b->nodes[0];
  float area = area_of(b, aabb_half_area((aabb){root->lo, root->hi}), node);
  return leaf_cost(area, c->below) <= area + c->of[WIDE - 1];
}

uint32_t wide_children(const bvh *b, const wide_cost *costs, uint32_t from,
                       uint32_t child[WIDE]) {
  struct {
    uint32_t node;
    int places;
  } stack[WIDE];
  uint32_t top = 0, count = 0;
  stack[top].node = from;
  stack[top++].places = WIDE;
  if (wide_is_leaf(b, costs, from)) stack[0].places = 1;
  while (top > 0) {
    uint32_t node = stack[--top].node;
    int places = stack[top].places, left = 1;
    const bvh_node *n = &b->nodes[node];
    const wide_cost *l = &costs[n->first], *r = l + 1;
    bool whole = n->count > 0 || places == 1;
    while (!whole) {
      float cost = share_places(l, r, places, &left);
      if (places == WIDE || cost <= costs[node].of[places - 2]) break;
      whole = --places == 1;
    }
    if (whole) {
      child[count++] = node;
      continue;
    }
    stack[top].node = n->first + 1;
    stack[top++].places = places - left;
    stack[top].node = n->first;
    stack[top++].places = left;
  }
  return count;
}
