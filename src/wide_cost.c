// wide_cost.c — from the leaves up, all ways to share eight places.

#include "wide_cost.h"

// What a leaf costs, and each of its triangles, in visits to nodes: all are
// tested at once, but each must be fetched.
#define LEAF_COST 0.8f
#define TRIANGLE_COST 0.1f

// About so many parts of the tree are work items.
enum { PARTS = 256 };

// Bit of ways: cheapest as a leaf.
#define IS_LEAF (UINT32_C(1) << 31)

// Costs in visits to nodes per random ray: of[i], i < 7, is what all below a
// node costs as at most i + 1 trees side by side; of[7], as up to 8 of which
// the node itself is none.  And how many wide nodes these have.
typedef struct node_cost {
  float of[WIDE];
  uint32_t inner[WIDE];
} node_cost;

// A node above the parts, whose children are those at `first` and after it, or
// with first 0 the root of a part.
typedef struct cost_item {
  uint32_t node, first;
  node_cost cost;
} cost_item;

// What the threads share.
typedef struct cost_job {
  const bvh *b;
  wide_cost *costs;
  double all;  // half the area of the root
  cost_item *items;
  uint32_t *part;  // those that are roots of parts
  uint32_t item_count, part_count;
} cost_job;

static float area_of(const bvh *b, double all, uint32_t node) {
  const bvh_node *n = &b->nodes[node];
  return (float)(aabb_half_area((aabb){n->lo, n->hi}) / all);
}

// The cost of all below a node as one leaf.
static float leaf_cost(float area, uint32_t count) {
  return area * (LEAF_COST + TRIANGLE_COST * (float)count);
}

// The least costs of left and right as 2 to 8 trees together, at places - 1,
// and how many of these the left one gets: of equal ways the fewest.
static void share_places(const float l[WIDE], const float r[WIDE],
                         float least[WIDE], uint32_t left[WIDE]) {
  for (uint32_t i = 1; i < WIDE; i++) {
    float best = l[0] + r[i - 1];
    uint32_t which = 1;
    for (uint32_t k = 2; k <= i; k++) {
      float cost = l[k - 1] + r[i - k];
      which = cost < best ? k : which;
      best = cost < best ? cost : best;
    }
    least[i] = best;
    left[i] = which;
  }
}

// The same where more places do not help the right one: it gets one.
static void share_left(const float l[WIDE], float r, float least[WIDE],
                       uint32_t left[WIDE]) {
  least[0] = INFINITY;
  left[0] = 0;
  for (uint32_t i = 1; i < WIDE; i++) {
    float cost = l[i - 1] + r;
    bool less = cost < least[i - 1];
    least[i] = less ? cost : least[i - 1];
    left[i] = less ? i : left[i - 1];
  }
}

// The same where more do not help the left one.
static void share_right(float l, const float r[WIDE], float least[WIDE],
                        uint32_t left[WIDE]) {
  for (uint32_t i = 1; i < WIDE; i++) {
    least[i] = l + r[i - 1];
    left[i] = 1;
  }
}

static void cost_of_leaf(const cost_job *job, uint32_t node, node_cost *c) {
  uint32_t n = job->b->nodes[node].count;
  float cost = leaf_cost(area_of(job->b, job->all, node), n);
  for (int i = 0; i < WIDE; i++) {
    c->of[i] = cost;
    c->inner[i] = 0;
  }
  job->costs[node] = (wide_cost){n, IS_LEAF, 0};
}

// The costs of a node whose children have theirs; c may be l.
static void cost_of_node(const cost_job *job, uint32_t node, const node_cost *l,
                         const node_cost *r, node_cost *c) {
  const bvh *b = job->b;
  uint32_t first = b->nodes[node].first, left[WIDE];
  float area = area_of(b, job->all, node), least[WIDE];
  if (b->nodes[first].count > 0)
    share_right(l->of[0], r->of, least, left);
  else if (b->nodes[first + 1].count > 0)
    share_left(l->of, r->of[0], least, left);
  else
    share_places(l->of, r->of, least, left);
  wide_cost *w = &job->costs[node];
  node_cost to = {.of[WIDE - 1] = least[WIDE - 1]};
  *w = (wide_cost){.below = w[0].below};
  w->below = job->costs[first].below + job->costs[first + 1].below;
  to.inner[WIDE - 1] = l->inner[left[7] - 1] + r->inner[7 - left[7]];
  w->inner = to.inner[WIDE - 1];
  to.of[0] = area + to.of[WIDE - 1];
  to.inner[0] = 1 + w->inner;
  // What is shared has one layout, and is not joined to anything.
  if (w->below <= WIDE_LEAF && b->bundles == NULL &&
      leaf_cost(area, w->below) <= to.of[0]) {
    to.of[0] = leaf_cost(area, w->below);
    to.inner[0] = w->inner = 0;
    w->ways = IS_LEAF;
  }
  w->ways |= left[WIDE - 1] << 3 * (WIDE - 2);
  for (uint32_t i = 1; i < WIDE - 1; i++) {
    to.of[i] = to.of[i - 1];
    to.inner[i] = to.inner[i - 1];
    if (!(least[i] <= to.of[i - 1])) continue;
    to.of[i] = least[i];
    to.inner[i] = l->inner[left[i] - 1] + r->inner[i - left[i]];
    w->ways |= left[i] << 3 * (i - 1);
  }
  *c = to;
}

// A part of the tree, children before their parents: each node is met twice,
// and what its children cost is then on the top of a stack.
static void cost_part(void *context, size_t item, int worker) {
  (void)worker;
  const cost_job *job = context;
  cost_item *root = &job->items[job->part[item]];
  uint32_t stack[2 * BVH_MAX_DEPTH + 2], top = 0, known = 0;
  bool again[2 * BVH_MAX_DEPTH + 2];
  node_cost cost[BVH_MAX_DEPTH + 2];
  again[top] = false;
  stack[top++] = root->node;
  while (top > 0) {
    uint32_t node = stack[top - 1];
    const bvh_node *n = &job->b->nodes[node];
    if (n->count > 0) {
      cost_of_leaf(job, node, &cost[known++]);
      top--;
    } else if (again[top - 1]) {
      known--;
      cost_of_node(job, node, &cost[known - 1], &cost[known], &cost[known - 1]);
      top--;
    } else {
      again[top - 1] = true;
      for (uint32_t k = 0; k < 2; k++) {
        again[top] = false;
        stack[top++] = n->first + 1 - k;
      }
    }
  }
  root->cost = cost[0];
}

// Divide the tree into parts, level by level.
static void find_parts(cost_job *job, arena *scratch) {
  uint32_t room = job->b->node_count < PARTS ? job->b->node_count : PARTS;
  job->items = ARENA_NEW(scratch, cost_item, 4 * (size_t)room + 2);
  job->part = ARENA_NEW(scratch, uint32_t, 2 * (size_t)room);
  uint32_t head = 0, tail = 1;
  for (; head < tail; head++) {
    cost_item *it = &job->items[head];
    const bvh_node *n = &job->b->nodes[it->node];
    if (n->count > 0 || job->part_count + (tail - head) >= room) {
      job->part[job->part_count++] = head;
      continue;
    }
    it->first = tail;
    job->items[tail++].node = n->first;
    job->items[tail++].node = n->first + 1;
  }
  job->item_count = tail;
}

const wide_cost *wide_costs_of(const bvh *b, arena *mem, pool *threads) {
  arena scratch = {0};
  cost_job job = {.b = b};
  job.all = aabb_half_area((aabb){b->nodes[0].lo, b->nodes[0].hi});
  job.costs = ARENA_NEW(mem, wide_cost, b->node_count);
  find_parts(&job, &scratch);
  pool_run_near(threads, job.part_count, cost_part, &job);
  for (uint32_t i = job.item_count; i-- > 0;) {
    cost_item *it = &job.items[i];
    if (it->first == 0) continue;
    const cost_item *child = &job.items[it->first];
    cost_of_node(&job, it->node, &child[0].cost, &child[1].cost, &it->cost);
  }
  arena_free(&scratch);
  return job.costs;
}

uint32_t wide_children(const bvh *b, const wide_cost *costs, uint32_t from,
                       uint32_t child[WIDE]) {
  struct {
    uint32_t node, places;
  } stack[WIDE];
  uint32_t top = 0, count = 0;
  stack[top].node = from;
  stack[top++].places = wide_is_leaf(&costs[from]) ? 1 : WIDE;
  while (top > 0) {
    uint32_t node = stack[--top].node, places = stack[top].places, left = 0;
    for (; places > 1 && left == 0; places--)
      left = costs[node].ways >> 3 * (places - 2) & 7;
    if (left == 0) {
      child[count++] = node;
      continue;
    }
    uint32_t first = b->nodes[node].first;
    stack[top].node = first + 1;
    stack[top++].places = places + 1 - left;
    stack[top].node = first;
    stack[top++].places = left;
  }
  return count;
}
