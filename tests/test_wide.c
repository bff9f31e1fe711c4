// test_wide.c — the wide tree against the list, to the bit, on every set of
// instructions that this machine has.

#include "groves.h"
#include "wide.h"

#include <string.h>

// A grove with its wide tree, and how it is asked.
typedef struct wide_grove {
  grove g;
  wide_tree wide;
  const wide_level *level;
} wide_grove;

enum { BATCH = 500 };

// The list's answers to a batch and those of the four ways to ask.
typedef struct answers {
  ray rays[BATCH];
  hit list[BATCH], many[BATCH];
  bool blocked[BATCH];
} answers;

static void ask_list(answers *a, const grove *g) {
  for (int i = 0; i < BATCH; i++) {
    a->list[i] = (hit){.t = a->rays[i].tmax, .triangle = HIT_NONE};
    brute_closest(&g->b, &a->rays[i], &a->list[i]);
  }
}

// Whether the single questions about ray i agree with the list.
static bool single_agrees(const answers *a, const wide_grove *w, int i) {
  const ray *r = &a->rays[i];
  hit one = {.t = r->tmax, .triangle = HIT_NONE}, counted = one;
  bvh_visits v = {0};
  bool found = a->list[i].triangle != HIT_NONE;
  return w->level->closest(&w->wide, r, &one) == found &&
         w->level->closest_counted(&w->wide, r, &counted, &v) == found &&
         w->level->any(&w->wide, r) == found &&
         memcmp(&one, &a->list[i], sizeof one) == 0 &&
         memcmp(&counted, &a->list[i], sizeof one) == 0;
}

// The same for many at once, in streams of uneven length.
static bool many_agree(answers *a, const wide_grove *w) {
  static const int lengths[] = {1, 0, 2, 7, 64, 100, 326};
  int at = 0;
  for (size_t k = 0; k < sizeof lengths / sizeof *lengths; k++) {
    size_t n = (size_t)lengths[k];
    w->level->closest_many(&w->wide, a->rays + at, NULL, a->many + at, n);
    w->level->any_many(&w->wide, a->rays + at, a->blocked + at, n);
    at += lengths[k];
  }
  assert_int_equal(at, BATCH);
  for (int i = 0; i < BATCH; i++)
    if (a->blocked[i] != (a->list[i].triangle != HIT_NONE) ||
        memcmp(&a->many[i], &a->list[i], sizeof(hit)) != 0)
      return false;
  return true;
}

// The same for a tree too deep for streams, or so its depth says.
static bool deep_agree(answers *a, const wide_grove *w) {
  wide_grove deep = *w;
  deep.wide.depth = BVH_MAX_DEPTH;
  return many_agree(a, &deep);
}

static void try_batch(void *context, size_t item, int worker) {
  (void)worker;
  wide_grove *w = context;
  answers a;
  uint64_t state = 977 * item + 1;
  for (int i = 0; i < BATCH; i++)
    a.rays[i] = ray_near(&w->g, &state);
  ask_list(&a, &w->g);
  for (int level = 0; level < WIDE_LEVELS; level++) {
    wide_grove of = *w;
    of.level = wide_level_at(level);
    if (of.level == NULL) continue;
    bool agree = many_agree(&a, &of) && deep_agree(&a, &of);
    for (int i = 0; i < BATCH && agree; i++)
      agree = single_agrees(&a, &of, i);
    if (!agree) w->g.wrong = 1;  // only told apart from 0
  }
}

// Rays in fans of 48 that the kernels may take as packets of 16: copies of one
// ray or rays nearly like it, from one origin or close together; here and
// there one that fits nowhere.
static void fill_fans(answers *a, const grove *g, uint64_t *state) {
  ray like = {{0, 0, 0}, {0, 0, 0}, 0, 0};
  float spread = 0, apart = 0;
  for (int i = 0; i < BATCH; i++) {
    ray other = ray_near(g, state);
    if (i % 48 == 0) {
      like = other;
      spread = ldexpf(vec3_peak(vec3_abs(like.d)), -2 * (i / 48 % 12) - 2);
      apart = i / 48 % 3 == 0 ? ldexpf(vec3_peak(g->extent), -7) : 0;
      if (i / 48 % 4 == 3) spread = 0;
    }
    a->rays[i] = shape_random(state) < 0.01f ? other : like;
    ray *r = &a->rays[i];
    r->d = vec3_mad(r->d, spread, shape_point(state));
    r->o = vec3_mad(r->o, apart, shape_point(state));
    if (i % 7 == 0) r->tmax = other.tmax;
  }
}

// Whether many at once agree with the list, on all levels.
static void try_many(answers *a, wide_grove *w) {
  ask_list(a, &w->g);
  for (int level = 0; level < WIDE_LEVELS; level++) {
    wide_grove of = *w;
    of.level = wide_level_at(level);
    if (of.level != NULL && !many_agree(a, &of)) w->g.wrong = 1;
  }
}

static void try_fans(void *context, size_t item, int worker) {
  (void)worker;
  wide_grove *w = context;
  answers a;
  uint64_t state = 3571 * item + 7;
  fill_fans(&a, &w->g, &state);
  try_many(&a, w);
}

// Rays of all kinds, but 16 from one point, as crowds begin.
static void try_points(void *context, size_t item, int worker) {
  (void)worker;
  wide_grove *w = context;
  answers a;
  uint64_t state = 1201 * item + 5;
  for (int i = 0; i < BATCH; i++) {
    a.rays[i] = ray_near(&w->g, &state);
    if (i % 16 != 0) a.rays[i].o = a.rays[i - 1].o;
  }
  try_many(&a, w);
}

// A point of a triangle, or nearly.
static vec3 point_on(const grove *g, uint64_t *state) {
  uint32_t t = (uint32_t)(shape_random(state) * (float)g->s.triangles);
  const uint32_t *corner = &g->s.index[3 * t];
  float b = shape_random(state), c = (1 - b) * shape_random(state);
  vec3 p = vec3_scale(g->s.positions[corner[0]], 1 - b - c);
  p = vec3_mad(p, b, g->s.positions[corner[1]]);
  return vec3_mad(p, c, g->s.positions[corner[2]]);
}

// Shadow rays, from triangle to triangle, and others.
static void try_shadows(void *context, size_t item, int worker) {
  (void)worker;
  wide_grove *w = context;
  answers a;
  uint64_t state = 733 * item + 11;
  for (int i = 0; i < BATCH; i++) {
    a.rays[i] = ray_near(&w->g, &state);
    if (i % 3 == 0) continue;
    ray *r = &a.rays[i];
    if (i % 6 != 1) r->o = point_on(&w->g, &state);
    r->d = vec3_sub(point_on(&w->g, &state), r->o);
    r->tmin = 0;
    r->tmax = i % 3 == 1 ? 1 - 0x1p-12f : 1;
  }
  try_many(&a, w);
}

static void wide_plant(wide_grove *w, shape s, arena *mem, bvh_method method) {
  *w = (wide_grove){0};
  grove_plant(&w->g, s, mem, method);
  wide_tree_build(&w->wide, &w->g.b, mem, NULL);
}

// The wide tree finds what testing every triangle finds: the same triangle, t
// and weights to the bit, and the same yes or no, on 30,000 rays a mesh, asked
// one by one and in streams, with all sets of instructions.
static void wide_equals_list(void **unused) {
  (void)unused;
  arena mem = {0};
  pool *threads = pool_new(&mem, pool_default_threads());
  shape all[SHAPES];
  shapes_all(all, &mem);
  for (int i = 0; i < 2 * SHAPES; i++) {
    wide_grove w;
    wide_plant(&w, all[i / 2], &mem, i % 2 ? BVH_MEDIAN : BVH_SAH);
    pool_run(threads, many(i % 2 ? 10000 : 30000) / BATCH, try_batch, &w);
    if (w.g.wrong) print_message("# %s differs\n", w.g.s.name);
    assert_int_equal(w.g.wrong, 0);
  }
  pool_free(threads);
  arena_free(&mem);
}

// The same for batches of other rays.
static void try_batches(void (*batch)(void *, size_t, int)) {
  arena mem = {0};
  pool *threads = pool_new(&mem, pool_default_threads());
  shape all[SHAPES];
  shapes_all(all, &mem);
  for (int i = 0; i < SHAPES; i++) {
    wide_grove w;
    wide_plant(&w, all[i], &mem, BVH_SAH);
    pool_run(threads, many(30000) / BATCH, batch, &w);
    if (w.g.wrong) print_message("# %s differs\n", w.g.s.name);
    assert_int_equal(w.g.wrong, 0);
  }
  pool_free(threads);
  arena_free(&mem);
}

// The same for rays next to each other, which go in packets.
static void packets_equal_list(void **unused) {
  (void)unused;
  try_batches(try_fans);
}

// The same for rays of common points, which go in crowds.
static void crowds_equal_list(void **unused) {
  (void)unused;
  try_batches(try_points);
}

// The same where there are few triangles, which go without a tree.
static void few_equal_list(void **unused) {
  (void)unused;
  arena mem = {0};
  pool *threads = pool_new(&mem, pool_default_threads());
  const vec3 small = vec3_all(1e-4f), large = {1e4f, 300, 1e5f};
  const vec3 far = {700, -20, 3}, zero = {0, 0, 0};
  const shape all[] = {
      shape_cubes(&mem, 1),
      shape_flat(&mem, 4),
      shape_soup(&mem, 5, 0.3f),
      shape_soup(&mem, 60, 0.5f),
      shape_soup(&mem, 64, 3),
      shape_needles(&mem, 50, 1e-6f),
      shape_moved(shape_soup(&mem, 30, 1), "small", small, zero),
      shape_moved(shape_soup(&mem, 30, 1), "large", large, zero),
      shape_moved(shape_cubes(&mem, 1), "far", vec3_all(1), far)};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
    wide_grove w;
    wide_plant(&w, all[i], &mem, BVH_SAH);
    assert_in_range(w.wide.triangle_count, 1, 64);
    pool_run(threads, many(30000) / BATCH, try_shadows, &w);
    if (w.g.wrong) print_message("# %s differs\n", w.g.s.name);
    assert_int_equal(w.g.wrong, 0);
  }
  pool_free(threads);
  arena_free(&mem);
}

// Slivers through the middle of space: a ray enters nearly all boxes, so that
// more lists wait than a crowd has room for.
static void crowds_find_no_room(void **unused) {
  (void)unused;
  enum { SLIVERS = 12000, RAYS = 3000 };
  arena mem = {0};
  shape s = shape_new(&mem, "slivers", 3 * SLIVERS, SLIVERS);
  uint64_t state = 29;
  for (int i = 0; i < SLIVERS; i++) {
    vec3 p = shape_point(&state);
    shape_three(&s, p, vec3_mad(p, 0x1p-9f, shape_point(&state)),
                vec3_scale(p, -1));
  }
  wide_grove w;
  wide_plant(&w, s, &mem, BVH_SAH);
  ray *rays = ARENA_NEW(&mem, ray, RAYS);
  bool *blocked = ARENA_NEW(&mem, bool, RAYS);
  bool *list = ARENA_NEW(&mem, bool, RAYS);
  int hits = 0;
  for (int i = 0; i < RAYS; i++) {
    vec3 o = i % 16 ? rays[i - 1].o : shape_point(&state);
    rays[i] = (ray){o, vec3_mad(o, -1.5f, shape_point(&state)), 0, INFINITY};
    hit h = {.t = INFINITY, .triangle = HIT_NONE};
    list[i] = brute_closest(&w.g.b, &rays[i], &h);
    hits += list[i];
  }
  assert_in_range(hits, RAYS / 10, RAYS * 9 / 10);
  for (int level = 0; level < WIDE_LEVELS; level++) {
    if (wide_level_at(level) == NULL) continue;
    wide_level_at(level)->any_many(&w.wide, rays, blocked, RAYS);
    assert_memory_equal(blocked, list, RAYS * sizeof(bool));
  }
  arena_free(&mem);
}

// What is no ray hits nothing and harms nothing, in a stream of others too.
static void no_rays(void **unused) {
  (void)unused;
  arena mem = {0};
  wide_grove w;
  wide_plant(&w, shape_sphere(&mem, 4), &mem, BVH_SAH);
  const vec3 z = {0, 0, 0}, x = {1, 0, 0};
  const ray rays[] = {{z, z, 0, INFINITY},
                      {z, {1e-40f, -0.0f, 1e-39f}, 0, INFINITY},
                      {z, {NAN, 0, 0}, 0, INFINITY},
                      {z, x, 0, INFINITY},
                      {z, {1, INFINITY, 0}, 0, INFINITY},
                      {{NAN, 0, 0}, x, 0, INFINITY},
                      {{-INFINITY, 0, 0}, x, 0, INFINITY},
                      {z, x, 2, 1},
                      {z, x, NAN, INFINITY},
                      {z, x, 0, NAN},
                      {z, x, 0, 0.5f},
                      {z, x, -INFINITY, 1.5f},
                      {z, x, 1.5f, INFINITY}};
  enum { N = sizeof rays / sizeof *rays };
  for (int level = 0; level < WIDE_LEVELS; level++) {
    const wide_level *l = wide_level_at(level);
    if (l == NULL) continue;
    hit h[N], one;
    bool blocked[N];
    l->closest_many(&w.wide, rays, NULL, h, N);
    l->any_many(&w.wide, rays, blocked, N);
    for (int i = 0; i < N; i++) {
      bool hits = i == 3 || i == 11;
      assert_int_equal(h[i].triangle != HIT_NONE, hits);
      assert_int_equal(blocked[i], hits);
      assert_int_equal(l->closest(&w.wide, &rays[i], &one), hits);
      assert_int_equal(l->any(&w.wide, &rays[i]), hits);
      if (!hits) assert_memory_equal(&h[i].t, &rays[i].tmax, sizeof(float));
    }
  }
  arena_free(&mem);
}

// A plane as the kernels compute it.
static float plane_at(const wide_node *n, int axis, int side, uint32_t child) {
  return n->base[axis] + (float)n->plane[axis][side][child] * n->scale[axis];
}

// The triangles of a leaf are those of the mesh and lie in the leaf's box.
static void check_leaf(const wide_grove *w, const wide_node *node,
                       uint32_t child, unsigned char *seen) {
  uint32_t ref = node->child[child], n = wide_leaf_count(ref);
  const uint32_t *leaf = w->wide.triangles + 10 * (size_t)wide_leaf_first(ref);
  for (uint32_t i = 0; i < n; i++) {
    uint32_t t = leaf[9 * n + i];
    assert_true(t < w->g.s.triangles);
    seen[t]++;
    for (uint32_t k = 0; k < 9; k++) {
      float x;
      memcpy(&x, leaf + k * n + i, sizeof x);
      const vec3 *p = &w->g.s.positions[w->g.s.index[3 * t + k / 3]];
      float want = k % 3 == 0 ? p->x : k % 3 == 1 ? p->y : p->z;
      assert_memory_equal(&x, &want, sizeof x);
      assert_true(x >= plane_at(node, (int)k % 3, 0, child));
      assert_true(x <= plane_at(node, (int)k % 3, 1, child));
    }
  }
}

// Walk it all: every node is reached once, every kept triangle lies in one
// leaf inside of all the boxes above it, at most 64 bytes a triangle.
static void trees_are_whole(void **unused) {
  (void)unused;
  arena mem = {0};
  shape all[SHAPES];
  shapes_all(all, &mem);
  for (int i = 0; i < SHAPES; i++) {
    wide_grove w;
    wide_plant(&w, all[i], &mem, BVH_SAH);
    if (w.g.b.kept == 0) {
      assert_null(w.wide.nodes);
      continue;
    }
    unsigned char *seen = ARENA_NEW(&mem, unsigned char, w.g.s.triangles);
    uint32_t reached = 1, triangles = 0;
    for (uint32_t k = 0; k < w.wide.node_count; k++) {
      const wide_node *n = &w.wide.nodes[k];
      assert_true(n->valid > 0 && (n->valid & (n->valid + 1)) == 0);
      for (uint32_t c = 0; n->valid >> c != 0; c++) {
        if (n->child[c] & WIDE_LEAF_BIT) {
          check_leaf(&w, n, c, seen);
          triangles += wide_leaf_count(n->child[c]);
          continue;
        }
        assert_true(n->child[c] > k && n->child[c] < w.wide.node_count);
        reached++;
      }
    }
    assert_int_equal(reached, w.wide.node_count);
    assert_int_equal(triangles, w.g.b.kept);
    for (uint32_t t = 0; t < w.g.s.triangles; t++)
      assert_true(seen[t] <= 1);
    if (triangles > 50) assert_true(wide_tree_bytes(&w.wide) <= 64 * triangles);
  }
  arena_free(&mem);
}

// 1, 2 and 7 threads make the same nodes and triangles, to the byte.
static void threads_do_not_matter(void **unused) {
  (void)unused;
  arena mem = {0};
  wide_grove w;
  wide_plant(&w, shape_sphere(&mem, 120), &mem, BVH_SAH);
  for (int n = 2; n < 8; n += 5) {
    pool *threads = pool_new(&mem, n);
    wide_tree t;
    wide_tree_build(&t, &w.g.b, &mem, threads);
    pool_free(threads);
    assert_int_equal(t.node_count, w.wide.node_count);
    assert_int_equal(t.depth, w.wide.depth);
    assert_memory_equal(t.nodes, w.wide.nodes,
                        t.node_count * sizeof(wide_node));
    assert_memory_equal(t.triangles, w.wide.triangles,
                        t.triangle_count * 10 * sizeof(uint32_t));
  }
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(trees_are_whole),
      cmocka_unit_test(wide_equals_list),
      cmocka_unit_test(packets_equal_list),
      cmocka_unit_test(crowds_equal_list),
      cmocka_unit_test(few_equal_list),
      cmocka_unit_test(crowds_find_no_room),
      cmocka_unit_test(threads_do_not_matter),
      cmocka_unit_test(no_rays),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
