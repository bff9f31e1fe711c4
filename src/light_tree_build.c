// light_tree_build.c — as a tree of boxes is built (chapter 4), but a group is
// also the worse the stronger it is and the more ways it shines.

#include "aabb.h"
#include "light_tree.h"

enum { BINS = 12 };

// The emitters of a node, by their place in the order.
typedef struct span {
  uint32_t first, count, node;
} span;

// What a group is judged by.
typedef struct lot {
  aabb box;
  vec3 axis;  // sum of power times normal
  float power;
  uint32_t count;
} lot;

typedef struct builder {
  const light_emitter *emitters;
  uint32_t *order, *spare;  // the emitters as the leaves will have them
  light_tree *tree;
  uint32_t node_count;
  span *stack;
  uint32_t depth;
} builder;

static void lot_add(lot *l, const light_emitter *e) {
  const light_triangle *t = &e->shape;
  l->box = aabb_add(l->box, t->a);
  l->box = aabb_add(l->box, vec3_add(t->a, t->ab));
  l->box = aabb_add(l->box, vec3_add(t->a, t->ac));
  l->axis = vec3_mad(l->axis, e->power, t->n);
  l->power += e->power;
  l->count++;
}

static lot lot_join(lot a, lot b) {
  return (lot){aabb_join(a.box, b.box), vec3_add(a.axis, b.axis),
               a.power + b.power, a.count + b.count};
}

// Power by size squared by spread: 1 when all shine one way, 4 when all ways.
static float lot_cost(const lot *l) {
  if (l->count == 0 || !(l->power > 0)) return 0;
  vec3 d = vec3_sub(l->box.hi, l->box.lo);
  float together = vec3_length(l->axis) / l->power;
  return l->power * vec3_dot(d, d) * (4 - 3 * float_min(together, 1));
}

static const light_emitter *emitter_at(const builder *b, uint32_t place) {
  return &b->emitters[b->order[place]];
}

// The sphere and the cone of a span.
static light_group group_of(const builder *b, const span *s) {
  lot all = {.box = AABB_EMPTY};
  for (uint32_t i = 0; i < s->count; i++)
    lot_add(&all, emitter_at(b, s->first + i));
  vec3 middle = vec3_scale(vec3_add(all.box.lo, all.box.hi), 0.5f);
  light_group g = {.middle = middle, .axis = vec3_unit(all.axis)};
  g.power = all.power;
  g.cos_cone = vec3_dot(g.axis, g.axis) > 0.5f ? 1 : -1;
  for (uint32_t i = 0; i < s->count; i++) {
    const light_emitter *e = emitter_at(b, s->first + i);
    vec3 d = vec3_sub(e->shape.middle, g.middle);
    g.radius = float_max(g.radius, vec3_length(d) + e->shape.radius);
    float c = e->is_point ? -1 : vec3_dot(g.axis, e->shape.n);
    g.cos_cone = float_min(g.cos_cone, c);
  }
  g.sin_cone = sqrtf(float_max(1 - g.cos_cone * g.cos_cone, 0));
  return g;
}

// A way to cut a span in two: the bins of an axis, up to one.
typedef struct cut {
  int axis, last;  // -1: none
  float lo, scale;
  float cost;
} cut;

static int bin_of(const cut *c, const light_emitter *e) {
  int bin = (int)((vec3_axis(e->shape.middle, c->axis) - c->lo) * c->scale);
  return bin < 0 ? 0 : bin < BINS ? bin : BINS - 1;
}

// The best cut across one axis, if better than *best.
static void try_axis(const builder *b, const span *s, cut c, cut *best) {
  lot bins[BINS], right[BINS], left = {.box = AABB_EMPTY};
  for (int i = 0; i < BINS; i++)
    bins[i] = left;
  for (uint32_t i = 0; i < s->count; i++) {
    const light_emitter *e = emitter_at(b, s->first + i);
    lot_add(&bins[bin_of(&c, e)], e);
  }
  right[BINS - 1] = bins[BINS - 1];
  for (int i = BINS - 2; i > 0; i--)
    right[i] = lot_join(bins[i], right[i + 1]);
  for (c.last = 0; c.last + 1 < BINS; c.last++) {
    left = lot_join(left, bins[c.last]);
    const lot *rest = &right[c.last + 1];
    if (left.count == 0 || rest->count == 0) continue;
    c.cost = lot_cost(&left) + lot_cost(rest);
    if (c.cost < best->cost) *best = c;
  }
}

static cut best_cut(const builder *b, const span *s) {
  aabb middles = AABB_EMPTY;
  for (uint32_t i = 0; i < s->count; i++)
    middles = aabb_add(middles, emitter_at(b, s->first + i)->shape.middle);
  cut best = {.axis = -1, .cost = INFINITY};
  for (int axis = 0; axis < 3; axis++) {
    float lo = vec3_axis(middles.lo, axis), hi = vec3_axis(middles.hi, axis);
    cut c = {.axis = axis, .lo = lo, .scale = BINS / (hi - lo)};
    if (c.scale > 0 && c.scale < INFINITY) try_axis(b, s, c, &best);
  }
  return best;
}

// Puts the left ones first, both sides in their old order; how many those are.
// Lights all in one place are halved.
static uint32_t divide(builder *b, const span *s) {
  cut c = best_cut(b, s);
  if (c.axis < 0) return s->count / 2;
  uint32_t *order = b->order + s->first, left = 0, right = 0;
  for (uint32_t i = 0; i < s->count; i++) {
    if (bin_of(&c, &b->emitters[order[i]]) <= c.last)
      order[left++] = order[i];
    else
      b->spare[right++] = order[i];
  }
  for (uint32_t i = 0; i < right; i++)
    order[left + i] = b->spare[i];
  return left;
}

static void build_node(builder *b, span s) {
  light_node *k = &b->tree->nodes[s.node];
  k->group = group_of(b, &s);
  if (s.count <= LIGHT_LEAF) {
    k->first = s.first;
    k->count = s.count;
    for (uint32_t i = 0; i < s.count; i++)
      b->tree->leaf_of[s.first + i] = s.node;
    return;
  }
  uint32_t left = divide(b, &s), child = b->node_count;
  b->node_count += 2;
  k->first = child;
  b->tree->nodes[child].parent = b->tree->nodes[child + 1].parent = s.node;
  b->stack[b->depth++] = (span){s.first + left, s.count - left, child + 1};
  b->stack[b->depth++] = (span){s.first, left, child};
}

void light_tree_build(light_tree *out, const light_emitter *emitters,
                      uint32_t count, arena *mem) {
  *out = (light_tree){.count = count};
  if (count == 0) return;
  out->emitters = ARENA_NEW(mem, light_emitter, count);
  out->leaf_of = ARENA_NEW(mem, uint32_t, count);
  out->nodes = ARENA_NEW(mem, light_node, 2 * (size_t)count);
  arena scratch = {0};
  builder b = {.emitters = emitters, .tree = out, .node_count = 1};
  b.order = ARENA_NEW(&scratch, uint32_t, count);
  b.spare = ARENA_NEW(&scratch, uint32_t, count);
  b.stack = ARENA_NEW(&scratch, span, (size_t)count + 1);
  for (uint32_t i = 0; i < count; i++)
    b.order[i] = i;
  b.stack[b.depth++] = (span){0, count, 0};
  while (b.depth > 0)
    build_node(&b, b.stack[--b.depth]);
  for (uint32_t i = 0; i < count; i++)
    out->emitters[i] = emitters[b.order[i]];
  arena_free(&scratch);
}
