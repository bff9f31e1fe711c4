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

// What collapsing has at hand.
typedef struct collapse {
  const bvh *b;
  const wide_cost *costs;
  wide_tree *out;
  collapse_item *items;
  uint32_t item_count;
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
    a = floor(((double)lo - (double)base) / (double)scale);
    b = ceil(((double)hi - (double)base) / (double)scale);
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

// Copy the triangles below a binary node to the end and return its reference.
static uint32_t write_leaf(collapse *c, uint32_t from) {
  uint32_t list[WIDE_LEAF], n = 0, stack[WIDE_LEAF + 1], top = 0;
  stack[top++] = from;
  while (top > 0) {
    const bvh_node *node = &c->b->nodes[stack[--top]];
    if (node->count == 0) {
      stack[top++] = node->first + 1;
      stack[top++] = node->first;
    }
    for (uint32_t i = 0; i < node->count; i++)
      list[n++] = c->b->order[node->first + i];
  }
  wide_tree *t = c->out;
  uint32_t *to = t->triangles + 10 * (size_t)t->triangle_count;
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t *v = c->b->index + 3 * (size_t)list[i];
    for (uint32_t k = 0; k < 3; k++) {
      const vec3 *p = &c->b->positions[v[k]];
      memcpy(&to[(3 * k + 0) * n + i], &p->x, sizeof(float));
      memcpy(&to[(3 * k + 1) * n + i], &p->y, sizeof(float));
      memcpy(&to[(3 * k + 2) * n + i], &p->z, sizeof(float));
    }
    to[9 * n + i] = list[i];
  }
  uint32_t child = WIDE_LEAF_BIT | (n - 1) << 28 | t->triangle_count;
  t->triangle_count += n;
  return child;
}

// Make the wide node of an item; its inner children become items.
static void write_node(collapse *c, collapse_item it) {
  uint32_t child[WIDE];
  const bvh_node *nodes = c->b->nodes, *from = &nodes[it.from];
  uint32_t n = wide_children(c->b, c->costs, it.from, child);
  wide_node *w = &c->out->nodes[it.to];
  w->valid = (1u << n) - 1;
  frame_axis(w, 0, from->lo.x, from->hi.x);
  frame_axis(w, 1, from->lo.y, from->hi.y);
  frame_axis(w, 2, from->lo.z, from->hi.z);
  if (it.depth > c->out->depth) c->out->depth = it.depth;
  for (uint32_t i = 0; i < n; i++) {
    const bvh_node *box = &nodes[child[i]];
    quantise_axis(w, 0, i, box->lo.x, box->hi.x);
    quantise_axis(w, 1, i, box->lo.y, box->hi.y);
    quantise_axis(w, 2, i, box->lo.z, box->hi.z);
    if (wide_is_leaf(c->b, c->costs, child[i])) {
      w->child[i] = write_leaf(c, child[i]);
      continue;
    }
    w->child[i] = c->out->node_count++;
    c->items[c->item_count++] =
        (collapse_item){child[i], w->child[i], it.depth + 1};
  }
}

// n objects of `size` bytes at the beginning of a line of the cache.
static void *aligned_alloc_of(arena *mem, size_t n, size_t size) {
  char *p = arena_alloc(mem, n * size + 128, 1);
  return p + (128 - (uintptr_t)p % 128) % 128;
}

void wide_tree_build(wide_tree *out, const bvh *b, arena *mem, pool *threads) {
  double start = clock_seconds();
  *out = (wide_tree){0};
  if (b->nodes == NULL || b->refs > WIDE_MAX_TRIANGLES) return;
  arena scratch = {0};
  collapse c = {.b = b, .out = out};
  c.items = ARENA_NEW(&scratch, collapse_item, b->node_count);
  c.costs = wide_costs_of(b, &scratch, threads);
  memcpy(out->lo, &b->nodes[0].lo, sizeof(vec3));
  memcpy(out->hi, &b->nodes[0].hi, sizeof(vec3));
  out->large = slab_large(&(aabb){b->nodes[0].lo, b->nodes[0].hi});
  out->nodes = aligned_alloc_of(mem, b->node_count / 2 + 1, sizeof(wide_node));
  out->triangles = aligned_alloc_of(mem, c.costs[0].below + WIDE_LEAF,
                                    10 * sizeof(uint32_t));
  out->node_count = 1;
  c.items[c.item_count++] = (collapse_item){0, 0, 0};
  while (c.item_count > 0)
    write_node(&c, c.items[--c.item_count]);
  arena_free(&scratch);
  out->seconds = clock_seconds() - start;
}

size_t wide_tree_bytes(const wide_tree *t) {
  return t->node_count * sizeof(wide_node) +
         (size_t)t->triangle_count * 10 * sizeof(uint32_t);
}
