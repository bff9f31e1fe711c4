// test_build.c — trees by more lanes, and drawn together by fewer steps, are
// those of the plain ways.

#include "build.h"
#include "bvh_read.h"
#include "groves.h"
#include "wide_cost.h"

#include <string.h>

// A tree by the given hands, as bvh_build would build it.
static void build_by(bvh *out, const shape *s, bvh_method method,
                     const bvh_hands *hands, arena *mem, pool *threads) {
  *out = (bvh){.positions = s->positions,
               .index = s->index,
               .triangle_count = s->triangles};
  arena refs = {0};
  bvh_source from = {.method = method, .mem = &refs, .hands = hands};
  from.root = bvh_read(&from.refs, out, 0, &refs, threads);
  bvh_build_source(out, &from, mem, threads);
}

static void check_same(const bvh *a, const bvh *b) {
  assert_int_equal(a->node_count, b->node_count);
  assert_int_equal(a->kept, b->kept);
  assert_int_equal(a->depth, b->depth);
  assert_true(memcmp(&a->cost, &b->cost, sizeof a->cost) == 0);
  if (a->nodes == NULL) return;
  assert_memory_equal(a->nodes, b->nodes, a->node_count * sizeof(bvh_node));
  assert_memory_equal(a->order, b->order, a->kept * sizeof(uint32_t));
}

enum { LARGE = 4, METHODS = BVH_ONES + 1 };

// Meshes of many tasks: even ones, one with most of its triangles in a corner,
// and one whose coordinates are zeros of both signs, half of them.
static void shapes_large(shape out[LARGE], arena *mem) {
  const uint32_t n = 30000;
  out[0] = shape_soup(mem, n, 0.02f);
  out[1] = shape_sphere(mem, 60);
  out[2] = shape_soup(mem, n, 0.02f);
  for (uint32_t i = 601; i < out[2].vertices; i++)
    out[2].positions[i] = vec3_scale(out[2].positions[i], 1e-3f);
  out[3] = shape_soup(mem, n, 0.02f);
  for (uint32_t i = 0; i < out[3].vertices; i++) {
    vec3 *p = &out[3].positions[i];
    if (i % 2) p->x = i % 4 == 1 ? 0.0f : -0.0f;
    if (i % 3) p->y = i % 3 == 1 ? 0.0f : -0.0f;
  }
}

// All meshes, and threads.
static pool *prepare(shape s[SHAPES + LARGE], arena *mem) {
  shapes_all(s, mem);
  shapes_large(s + SHAPES, mem);
  return pool_new(mem, 3);
}

// The same bytes by any hands, any number of threads, for every method.
static void hands_do_not_matter(void **unused) {
  (void)unused;
  const bvh_hands *hands = build_avx2_hands();
  if (hands == NULL) skip();
  arena mem = {0};
  shape s[SHAPES + LARGE];
  pool *threads = prepare(s, &mem);
  for (int i = 0; i < SHAPES + LARGE; i++) {
    for (int method = 0; method < METHODS; method++) {
      arena once = {0};
      bvh plain, quick[2];
      build_by(&plain, &s[i], (bvh_method)method, NULL, &once, NULL);
      build_by(&quick[0], &s[i], (bvh_method)method, hands, &once, NULL);
      build_by(&quick[1], &s[i], (bvh_method)method, hands, &once, threads);
      check_same(&plain, &quick[0]);
      check_same(&plain, &quick[1]);
      arena_free(&once);
    }
  }
  pool_free(threads);
  arena_free(&mem);
}

// The costs of one node by the formulas of chapter 12: of[i] for i + 1 places,
// split[i] how many of these the left child gets, or 0.
typedef struct plain_cost {
  float of[WIDE];
  uint32_t split[WIDE], below;
  bool leaf;
} plain_cost;

static float plain_leaf(float area, uint32_t count) {
  return area * (0.8f + 0.1f * (float)count);
}

static void plain_cost_of(plain_cost *costs, const bvh *b, uint32_t node) {
  const bvh_node *n = &b->nodes[node], *root = &b->nodes[0];
  plain_cost *c = &costs[node], *l = &costs[n->first], *r = l + 1;
  float area = (float)(aabb_half_area((aabb){n->lo, n->hi}) /
                       aabb_half_area((aabb){root->lo, root->hi}));
  float least[WIDE];
  *c = (plain_cost){.below = n->count, .leaf = true};
  for (int i = 0; i < WIDE; i++)
    c->of[i] = plain_leaf(area, n->count);
  if (n->count > 0) return;
  c->below = l->below + r->below;
  for (uint32_t i = 1; i < WIDE; i++) {
    least[i] = INFINITY;
    for (uint32_t k = 1; k <= i; k++) {
      float cost = l->of[k - 1] + r->of[i - k];
      if (cost >= least[i]) continue;
      least[i] = cost;
      c->split[i] = k;
    }
  }
  c->of[WIDE - 1] = least[WIDE - 1];
  c->of[0] = area + c->of[WIDE - 1];
  c->leaf = c->below <= WIDE_LEAF && plain_leaf(area, c->below) <= c->of[0];
  if (c->leaf) c->of[0] = plain_leaf(area, c->below);
  for (int i = 1; i < WIDE - 1; i++) {
    c->of[i] = fminf(c->of[i - 1], least[i]);
    if (least[i] > c->of[i - 1]) c->split[i] = 0;
  }
}

// The wide nodes below one that stands for all below `node`, whose children are
// checked against those by the formulas.
static uint32_t check_children(const bvh *b, const wide_cost *costs,
                               const plain_cost *plain, uint32_t node) {
  uint32_t child[WIDE], want[WIDE], count = 0, top = 0, inner = 0;
  struct {
    uint32_t node, places;
  } stack[WIDE];
  stack[top].node = node;
  stack[top++].places = WIDE;
  while (top > 0) {
    uint32_t at = stack[--top].node, places = stack[top].places;
    while (places > 1 && plain[at].split[places - 1] == 0)
      places--;
    if (places == 1) {
      want[count++] = at;
      continue;
    }
    stack[top].node = b->nodes[at].first + 1;
    stack[top++].places = places - plain[at].split[places - 1];
    stack[top].node = b->nodes[at].first;
    stack[top++].places = plain[at].split[places - 1];
  }
  assert_int_equal(wide_children(b, costs, node, child), count);
  assert_memory_equal(child, want, count * sizeof *child);
  for (uint32_t i = 0; i < count; i++) {
    if (plain[child[i]].leaf) continue;
    inner += 1 + costs[child[i]].inner;
  }
  return inner;
}

// Children of every node that might be one of the wide tree, whether it is a
// leaf, what is below and how many nodes: as by the formulas, on any number of
// threads.
static void collapse_is_cheapest(void **unused) {
  (void)unused;
  arena mem = {0};
  shape s[SHAPES + LARGE];
  pool *threads = prepare(s, &mem);
  for (int i = 0; i < SHAPES + LARGE; i++) {
    arena once = {0};
    bvh b;
    build_by(&b, &s[i], i % 2 ? BVH_COARSE : BVH_ONES, NULL, &once, NULL);
    if (b.nodes == NULL) {
      arena_free(&once);
      continue;
    }
    const wide_cost *costs[2] = {wide_costs_of(&b, &once, NULL),
                                 wide_costs_of(&b, &once, threads)};
    assert_memory_equal(costs[0], costs[1], b.node_count * sizeof **costs);
    plain_cost *plain = ARENA_NEW(&once, plain_cost, b.node_count);
    // Children have higher numbers than their parents, in whatever order.
    for (uint32_t k = b.node_count; k-- > 0;)
      plain_cost_of(plain, &b, k);
    for (uint32_t k = 0; k < b.node_count; k++) {
      assert_int_equal(wide_is_leaf(&costs[0][k]), plain[k].leaf);
      assert_int_equal(costs[0][k].below, plain[k].below);
      if (plain[k].leaf) continue;
      uint32_t inner = check_children(&b, costs[0], plain, k);
      assert_int_equal(costs[0][k].inner, inner);
    }
    arena_free(&once);
  }
  pool_free(threads);
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(hands_do_not_matter),
      cmocka_unit_test(collapse_is_cheapest),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
