// test_bvh_shared.c — trees whose leaves share triangles find what the list
// finds.

#include "bvh_shared.h"
#include "bvh_split.h"
#include "cut_groves.h"
#include "slab.h"
#include "wide_patch.h"

// Prisms of 16 sides that lean across each other, and small triangles around
// them, which land in the same bundles now and then.
static shape shape_columns(arena *mem, uint32_t n) {
  enum { SIDES = 16 };
  shape s = shape_new(mem, "columns", 2 * n * SIDES + 3 * n, 2 * n * SIDES + n);
  uint64_t state = 5;
  for (uint32_t c = 0; c < n; c++) {
    vec3 foot = shape_point(&state), top = shape_point(&state);
    uint32_t first = s.vertices;
    foot.y = -1;
    top = vec3_mad(foot, 0.2f, top);
    top.y = 1;
    for (int k = 0; k < SIDES; k++) {
      vec2 u = num_circle((float)k / SIDES);
      vec3 round = {0.02f * u.x, 0, 0.02f * u.y};
      shape_vertex(&s, vec3_add(foot, round));
      shape_vertex(&s, vec3_add(top, round));
    }
    for (uint32_t k = 0; k < SIDES; k++) {
      uint32_t a = first + 2 * k, b = first + 2 * ((k + 1) % SIDES);
      shape_triangle(&s, a, a + 1, b);
      shape_triangle(&s, b, a + 1, b + 1);
    }
    vec3 p = vec3_mad(foot, shape_random(&state), vec3_sub(top, foot));
    shape_three(&s, p, vec3_mad(p, 0.004f, shape_point(&state)),
                vec3_mad(p, 0.004f, shape_point(&state)));
  }
  return s;
}

// Walls along the axes and across them, on a coarse grid.
static shape shape_fences(arena *mem, uint32_t n) {
  shape s = shape_new(mem, "fences", 4 * n, 2 * n);
  uint64_t state = 7;
  for (uint32_t i = 0; i < n; i++) {
    vec3 p = vec3_scale(shape_point(&state), 9);
    vec3 at = {floorf(p.x), floorf(p.y), floorf(p.z)};
    vec3 along = {1 + (float)(i % 4), i % 3 ? 0 : 2, (float)(i % 5)};
    vec3 up = {0, 1, 0};
    uint32_t first = s.vertices;
    shape_vertex(&s, at);
    shape_vertex(&s, vec3_add(at, along));
    shape_vertex(&s, vec3_add(at, up));
    shape_vertex(&s, vec3_add(vec3_add(at, along), up));
    shape_triangle(&s, first, first + 1, first + 2);
    shape_triangle(&s, first + 3, first + 2, first + 1);
  }
  return s;
}

enum { SHAPES = 5 };

static void shapes_all(shape out[SHAPES], arena *mem) {
  const vec3 one = {1, 1, 1}, zero = {0, 0, 0};
  out[0] = shape_columns(mem, 60);
  out[1] = shape_fences(mem, 200);
  out[2] = shape_moved(shape_columns(mem, 20), "huge", vec3_all(1e30f), zero);
  out[3] = shape_moved(shape_columns(mem, 20), "tiny", vec3_all(1e-20f), zero);
  out[4] =
      shape_moved(shape_columns(mem, 40), "far", one, (vec3){3e4f, 0, -3e4f});
}

// A point of a triangle.
static vec3 point_on(const shape *s, uint32_t t, uint64_t *state) {
  const uint32_t *v = s->index + 3 * (size_t)t;
  float a = shape_random(state), b = (1 - a) * shape_random(state);
  vec3 p = s->positions[v[0]];
  p = vec3_mad(p, a, vec3_sub(s->positions[v[1]], s->positions[v[0]]));
  return vec3_mad(p, b, vec3_sub(s->positions[v[2]], s->positions[v[0]]));
}

static uint32_t some_triangle(const shape *s, uint64_t *state) {
  uint32_t t = (uint32_t)(shape_random(state) * (float)s->triangles);
  return t < s->triangles ? t : 0;
}

// From before a point of a triangle; every other ray lies in its plane.
static ray ray_at(const cut_grove *g, int i, uint64_t *state) {
  uint32_t t = some_triangle(&g->s, state);
  vec3 a = point_on(&g->s, t, state);
  if (i % 2) t = some_triangle(&g->s, state);
  vec3 d = vec3_sub(point_on(&g->s, t, state), a);
  return ray_from(vec3_mad(a, -shape_random(state), d), d);
}

// All ways to ask agree (cut_groves.h).
static void tree_equals_list(void **unused) {
  (void)unused;
  arena mem = {0};
  pool *threads = pool_new(&mem, pool_default_threads());
  shape all[SHAPES];
  shapes_all(all, &mem);
  for (int i = 0; i < SHAPES; i++) {
    cut_grove g;
    cut_grove_plant(&g, all[i], bvh_shared_build, &mem);
    // Fences are cut one by one.
    assert_true((g.cut.bundles == NULL) ==
                (strcmp(all[i].name, "fences") == 0));
    g.ray = ray_at;
    cut_grove_check(&g, many(10000), threads);
  }
  pool_free(threads);
  arena_free(&mem);
}

// The law on which the equality rests: every point of a large triangle, between
// neighbouring floats, is in the box of a leaf that has it, and a small one is
// whole in one.
static void leaves_cover_triangles(void **unused) {
  (void)unused;
  arena mem = {0};
  shape all[SHAPES];
  shapes_all(all, &mem);
  uint64_t state = 3;
  uint32_t small = 0;
  for (int i = 0; i < SHAPES; i++) {
    cut_grove g;
    cut_grove_plant(&g, all[i], bvh_shared_build, &mem);
    float least = slab_large(&(aabb){g.lo, g.plain.nodes[0].hi});
    for (uint32_t k = 0; k < many(4000); k++) {
      uint32_t t = some_triangle(&g.s, &state);
      vec3 p[3], lo, hi;
      corners_of(p, &g.s, t);
      point_between(&lo, &hi, p, k % 4 == 0, &state);
      vec3 low = vec3_min(p[0], vec3_min(p[1], p[2]));
      vec3 high = vec3_max(p[0], vec3_max(p[1], p[2]));
      bool whole = !(vec3_peak(vec3_sub(high, low)) > least);
      small += whole;
      assert_true(whole ? leaf_holds(&g.cut, t, low, high)
                        : leaf_holds(&g.cut, t, lo, hi));
    }
  }
  assert_true(small > many(100));
  arena_free(&mem);
}

// Bundles follow each other, every leaf has all of one, every bundle a leaf,
// and there are no more leaves than promised.
static void check_bundles(const bvh *b, arena *mem) {
  uint32_t *size = ARENA_NEW(mem, uint32_t, b->kept), leaves = 0, met = 0;
  bool *seen = ARENA_NEW(mem, bool, b->kept);
  assert_int_equal(b->bundles[0], 0);
  assert_int_equal(b->bundles[b->bundle_count], b->kept);
  for (uint32_t i = 0; i < b->bundle_count; i++)
    size[b->bundles[i]] = b->bundles[i + 1] - b->bundles[i];
  for (uint32_t i = 0; i < b->node_count; i++) {
    const bvh_node *n = &b->nodes[i];
    if (n->count == 0) continue;
    assert_true(n->first < b->kept && n->count == size[n->first]);
    leaves++;
    met += !seen[n->first];
    seen[n->first] = true;
  }
  assert_int_equal(met, b->bundle_count);
  assert_int_equal(leaves - b->bundle_count, b->parts);
  assert_true(b->parts <= (uint64_t)b->kept * BVH_SHARED_PERCENT / 100);
  assert_true(b->depth <= BVH_MAX_DEPTH && b->refs == b->kept);
}

// Where long triangles lie side by side rays cost less than half, at
// no more than 64 bytes a triangle; where strangers cross, they are cut one by
// one; and few rays do not repay either.
static void cuts_where_it_pays(void **unused) {
  (void)unused;
  arena mem = {0};
  cut_grove g;
  cut_grove_plant(&g, shape_columns(&mem, 1000), bvh_shared_build, &mem);
  assert_non_null(g.cut.bundles);
  check_bundles(&g.cut, &mem);
  assert_true(g.cut.cost < 0.5 * g.plain.cost);
  assert_true(wide_tree_bytes(&g.wide) <= 64 * (size_t)g.s.triangles);
  assert_int_equal(g.wide.triangle_count, g.s.triangles);
  bvh few, of = mesh_of(&g.s);
  bvh_shared_build(&few, &of, 0.9 * g.cut.cut_rays, &mem, NULL);
  assert_int_equal(few.node_count, g.plain.node_count);
  assert_memory_equal(few.nodes, g.plain.nodes,
                      few.node_count * sizeof *few.nodes);
  bvh_shared_build(&few, &of, 1.1 * g.cut.cut_rays, &mem, NULL);
  assert_int_equal(few.node_count, g.cut.node_count);
  shape soup = shape_needles(&mem, 3000, 0.3f);
  cut_grove_plant(&g, soup, bvh_shared_build, &mem);
  assert_null(g.cut.bundles);
  bvh split;
  of = mesh_of(&soup);
  bvh_split_build(&split, &of, (double)INFINITY, &mem, NULL);
  assert_int_equal(g.cut.node_count, split.node_count);
  assert_memory_equal(g.cut.nodes, split.nodes,
                      split.node_count * sizeof *split.nodes);
  cut_grove_plant(&g, shape_sphere(&mem, 280), bvh_shared_build, &mem);
  assert_int_equal(g.cut.node_count, g.plain.node_count);
  arena_free(&mem);
}

// 1 and 7 threads make the same tree, wide tree and patches, to the byte.
static void threads_do_not_matter(void **unused) {
  (void)unused;
  arena mem = {0};
  shape s = shape_columns(&mem, 1000);
  bvh b[2], of = mesh_of(&s);
  wide_tree w[2];
  for (int j = 0; j < 2; j++) {
    pool *p = pool_new(&mem, 1 + 6 * j);
    bvh_shared_build(&b[j], &of, (double)INFINITY, &mem, p);
    wide_tree_build(&w[j], &b[j], &mem, p);
    wide_patches_find(&w[j], s.triangles, &mem, p);
    pool_free(p);
  }
  assert_int_equal(b[1].node_count, b[0].node_count);
  assert_memory_equal(b[1].nodes, b[0].nodes,
                      b[0].node_count * sizeof(bvh_node));
  assert_int_equal(w[1].node_count, w[0].node_count);
  assert_memory_equal(w[1].nodes, w[0].nodes,
                      w[0].node_count * sizeof(wide_node));
  assert_memory_equal(w[1].triangles, w[0].triangles, w[0].triangle_count * 40);
  assert_int_equal(w[1].patch_count, w[0].patch_count);
  if (w[0].patch != NULL)
    assert_memory_equal(w[1].patch, w[0].patch, w[0].patch_count * 4);
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(cuts_where_it_pays),
      cmocka_unit_test(leaves_cover_triangles),
      cmocka_unit_test(tree_equals_list),
      cmocka_unit_test(threads_do_not_matter),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
