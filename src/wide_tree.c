// wide_tree.c — a binary tree drawn together.

#include "wide_tree.h"

#include "clock.h"
#include "slab.h"

#include <string.h>

// A node to make: the binary node that it stands for.
typedef struct collapse_item {
  uint32_t from, to;
  int depth;
} collapse_item;

// A part of the tree, made by one thread: its root, where its other nodes go
// next, and the deepest node so far.
typedef struct collapse_part {
  collapse_item root;
  uint32_t next_node;
  int depth;
} collapse_part;

// Items that wait: each level of the tree leaves at most WIDE - 1.
enum { ITEMS = (WIDE - 1) * BVH_MAX_DEPTH + 1 };

// Whatever holds more than 1 / PARTS of the triangles is above the parts.
enum { PARTS = 64, ABOVE = PARTS * BVH_MAX_DEPTH };

// The corners of the triangle so many places ahead are asked for.
enum { AHEAD = 8 };

// So many bundles are copied in one go.
enum { BUNDLES = 1024 };

// What collapsing has at hand.
typedef struct collapse {
  const bvh *b;
  const wide_cost *costs;
  wide_tree *out;
  collapse_item *above;  // nodes above the parts
  collapse_part *parts;
  uint32_t above_count, part_count;
} collapse;

// The plane that byte q stands for.
static float plane_of(float base, float scale, int q) {
  return base + (float)q * scale;
}

// The next float above x >= 0 of which the last 8 bits are 0.
static float short_float(float x) {
  uint32_t bits;
  memcpy(&bits, &x, sizeof bits);
  bits = (bits | 0xff) + 1;
  memcpy(&x, &bits, sizeof x);
  return x;
}

// Base and scale of an axis such that byte 255 reaches hi.
static void frame_axis(wide_node *w, int k, float lo, float hi) {
  float s = short_float((float)(((double)hi - (double)lo) / 255));
  while (plane_of(lo, s, 255) < hi)
    s = short_float(s);
  w->base[k] = lo;
  w->scale[k] = s;
}

// The bytes of child i along an axis: rounded outwards, and then checked in
// the arithmetic of the kernel.
static void quantise_axis(wide_node *w, int k, uint32_t i, float lo, float hi) {
  float base = w->base[k], scale = w->scale[k];
  double a = 0, b = 0;
  if (scale > 0) {
    a = ((double)lo - (double)base) / (double)scale;
    b = ((double)hi - (double)base) / (double)scale;
  }
  int q = a < 0 ? 0 : a > 255 ? 255 : (int)a;
  while (q > 0 && plane_of(base, scale, q) > lo)
    q--;
  w->plane[k][0][i] = (uint8_t)q;
  q = b < 0 ? 0 : b > 255 ? 255 : (int)b;
  while (q < 255 && plane_of(base, scale, q) < hi)
    q++;
  w->plane[k][1][i] = (uint8_t)q;
}

// Copy n triangles of a leaf from `first` of the order to the same place of the
// tree.  On the way ask for what leaves after it will want: the indices of one
// triangle, and the corners of another, nearer one, whose indices are here.
static void write_triangles(const collapse *c, uint32_t first, uint32_t n) {
  const uint32_t *list = c->b->order + first, *index = c->b->index;
  const vec3 *p = c->b->positions;
  uint32_t *to = c->out->triangles + 10 * (size_t)first;
  bool more = c->b->refs - first >= n + 2 * AHEAD;
  for (uint32_t i = 0; i < n; i++) {
    if (more) {
      const uint32_t *near = index + 3 * (size_t)list[i + AHEAD];
      __builtin_prefetch(index + 3 * (size_t)list[i + 2 * AHEAD]);
      __builtin_prefetch(&p[near[0]]);
      __builtin_prefetch(&p[near[1]]);
      __builtin_prefetch(&p[near[2]]);
    }
    const uint32_t *v = index + 3 * (size_t)list[i];
    for (uint32_t k = 0; k < 3; k++) {
      memcpy(&to[(3 * k + 0) * n + i], &p[v[k]].x, sizeof(float));
      memcpy(&to[(3 * k + 1) * n + i], &p[v[k]].y, sizeof(float));
      memcpy(&to[(3 * k + 2) * n + i], &p[v[k]].z, sizeof(float));
    }
    to[9 * n + i] = list[i];
  }
}

// The child for all triangles below a binary node, which follow each other in
// the order.
static uint32_t write_leaf(const collapse *c, uint32_t from) {
  const bvh_node *node = &c->b->nodes[from];
  while (node->count == 0)
    node = &c->b->nodes[node->first];
  uint32_t n = c->costs[from].below, first = node->first;
  if (c->b->bundles == NULL) write_triangles(c, first, n);
  return WIDE_LEAF_BIT | (n - 1) << 28 | first;
}

// Leaves that are shared are copied once.
static void write_bundles(void *context, size_t item, int worker) {
  (void)worker;
  const collapse *c = context;
  const uint32_t *first = c->b->bundles, begin = (uint32_t)item * BUNDLES;
  for (uint32_t i = begin; i < c->b->bundle_count && i - begin < BUNDLES; i++)
    write_triangles(c, first[i], first[i + 1] - first[i]);
}

// Make the wide node of an item; its inner children follow in items, and their
// number is returned.
static uint32_t write_node(const collapse *c, collapse_part *p,
                           collapse_item it, collapse_item *items) {
  uint32_t child[WIDE], inner = 0;
  const bvh_node *nodes = c->b->nodes, *from = &nodes[it.from];
  uint32_t n = wide_children(c->b, c->costs, it.from, child);
  wide_node *w = &c->out->nodes[it.to];
  w->valid = (1u << n) - 1;
  frame_axis(w, 0, from->lo.x, from->hi.x);
  frame_axis(w, 1, from->lo.y, from->hi.y);
  frame_axis(w, 2, from->lo.z, from->hi.z);
  if (it.depth > p->depth) p->depth = it.depth;
  for (uint32_t i = 0; i < n; i++) {
    const bvh_node *box = &nodes[child[i]];
    quantise_axis(w, 0, i, box->lo.x, box->hi.x);
    quantise_axis(w, 1, i, box->lo.y, box->hi.y);
    quantise_axis(w, 2, i, box->lo.z, box->hi.z);
    if (wide_is_leaf(&c->costs[child[i]])) {
      w->child[i] = write_leaf(c, child[i]);
      continue;
    }
    w->child[i] = p->next_node++;
    items[inner++] = (collapse_item){child[i], w->child[i], it.depth + 1};
  }
  return inner;
}

// The inner children of the wide node of an item, in items, and their number.
static uint32_t inner_children(const collapse *c, uint32_t from,
                               collapse_item *items) {
  uint32_t child[WIDE], inner = 0;
  uint32_t n = wide_children(c->b, c->costs, from, child);
  for (uint32_t i = 0; i < n; i++)
    if (!wide_is_leaf(&c->costs[child[i]])) items[inner++].from = child[i];
  return inner;
}

static void write_part(void *context, size_t item, int worker) {
  (void)worker;
  const collapse *c = context;
  collapse_part *p = &c->parts[item];
  collapse_item items[ITEMS + WIDE];
  uint32_t count = 1;
  items[0] = p->root;
  while (count > 0) {
    collapse_item it = items[--count];
    count += write_node(c, p, it, items + count);
  }
}

// Divide the tree: nodes above, level by level, and parts below them.
static void find_parts(collapse *c, arena *scratch) {
  uint32_t room = c->b->node_count < ABOVE ? c->b->node_count : ABOVE;
  uint32_t most = c->costs[0].below / PARTS, done = 0;
  c->above = ARENA_NEW(scratch, collapse_item, room + WIDE);
  c->parts = ARENA_NEW(scratch, collapse_part, WIDE * (size_t)room + WIDE);
  c->above_count = 1;
  while (done < c->above_count) {
    collapse_item items[WIDE];
    uint32_t inner = inner_children(c, c->above[done++].from, items);
    for (uint32_t i = 0; i < inner; i++) {
      if (c->costs[items[i].from].below > most)
        c->above[c->above_count++].from = items[i].from;
      else
        c->parts[c->part_count++].root.from = items[i].from;
    }
  }
}

// Write the nodes above the parts; these learn where their nodes and triangles
// go.  The order of above is that in which find_parts met them.
static void write_above(collapse *c) {
  collapse_part top = {.next_node = 1};
  uint32_t most = c->costs[0].below / PARTS, above = 1, part = 0;
  for (uint32_t i = 0; i < c->above_count; i++) {
    collapse_item items[WIDE];
    uint32_t inner = write_node(c, &top, c->above[i], items);
    for (uint32_t k = 0; k < inner; k++) {
      if (c->costs[items[k].from].below > most)
        c->above[above++] = items[k];
      else
        c->parts[part++].root = items[k];
    }
  }
  c->out->depth = top.depth;
  for (uint32_t i = 0; i < c->part_count; i++) {
    collapse_part *p = &c->parts[i];
    p->next_node = top.next_node;
    top.next_node += c->costs[p->root.from].inner;
  }
}

// n objects of `size` bytes at the beginning of a line of the cache.
static void *aligned_alloc_of(arena *mem, size_t n, size_t size) {
  char *p = arena_alloc(mem, n * size + 128, 1);
  return p + (128 - (uintptr_t)p % 128) % 128;
}

void wide_tree_room(wide_tree *t, arena *mem) {
  t->nodes = aligned_alloc_of(mem, t->node_count, sizeof(wide_node));
  t->triangles = aligned_alloc_of(mem, t->triangle_count + WIDE_LEAF,
                                  10 * sizeof(uint32_t));
}

void wide_tree_build(wide_tree *out, const bvh *b, arena *mem, pool *threads) {
  double start = clock_seconds();
  *out = (wide_tree){0};
  if (b->nodes == NULL || b->refs > WIDE_MAX_TRIANGLES) return;
  arena scratch = {0};
  collapse c = {.b = b, .out = out};
  c.costs = wide_costs_of(b, &scratch, threads);
  memcpy(out->lo, &b->nodes[0].lo, sizeof(vec3));
  memcpy(out->hi, &b->nodes[0].hi, sizeof(vec3));
  out->large = slab_large(&(aabb){b->nodes[0].lo, b->nodes[0].hi});
  find_parts(&c, &scratch);
  out->node_count = 1 + c.costs[0].inner;
  out->triangle_count = b->refs;
  wide_tree_room(out, mem);
  write_above(&c);
  pool_run_near(threads, c.part_count, write_part, &c);
  pool_run(threads, (b->bundle_count + BUNDLES - 1) / BUNDLES, write_bundles,
           &c);
  for (uint32_t i = 0; i < c.part_count; i++)
    if (c.parts[i].depth > out->depth) out->depth = c.parts[i].depth;
  arena_free(&scratch);
  out->seconds = clock_seconds() - start;
}

size_t wide_tree_bytes(const wide_tree *t) {
  return t->node_count * sizeof(wide_node) +
         (size_t)t->triangle_count * 10 * sizeof(uint32_t) +
         t->patch_count * sizeof(uint32_t);
}
