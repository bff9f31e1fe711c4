// test_bvh_split.c — trees that cut triangles find what the list finds.

#include "bvh_split.h"
#include "bvh_split_clip.h"
#include "cut_groves.h"

// Triangles of all lengths between random points, most of them small.
static shape shape_mix(arena *mem, uint32_t n) {
  shape s = shape_new(mem, "mix", 3 * n, n);
  uint64_t state = 11;
  for (uint32_t i = 0; i < n; i++) {
    vec3 p = shape_point(&state);
    float size = i % 3 ? 0.002f : num_exp2(6 * shape_random(&state) - 5);
    vec3 a = vec3_mad(p, size, shape_point(&state));
    shape_three(&s, p, a, vec3_mad(p, size, shape_point(&state)));
  }
  return s;
}

// Walls along the axes on a coarse grid, so that planes of cuts, faces of
// boxes and triangles coincide.
static shape shape_walls(arena *mem, uint32_t n) {
  shape s = shape_new(mem, "walls", 4 * n, 2 * n);
  uint64_t state = 7;
  for (uint32_t i = 0; i < n; i++) {
    uint32_t first = s.vertices;
    float at[3], size[2];
    for (int k = 0; k < 3; k++)
      at[k] = floorf(9 * shape_random(&state));
    for (int k = 0; k < 2; k++)
      size[k] = 1 + floorf(4 * shape_random(&state));
    for (int k = 0; k < 4; k++) {
      float p[3] = {at[0], at[1], at[2]};
      if (k & 1) p[i % 3] += size[0];
      if (k & 2) p[(i + 1) % 3] += size[1];
      shape_vertex(&s, (vec3){p[0], p[1], p[2]});
    }
    shape_triangle(&s, first, first + 1, first + 2);
    shape_triangle(&s, first + 3, first + 2, first + 1);
  }
  return s;
}

// One large triangle over and over.
static shape shape_same(arena *mem, uint32_t n) {
  shape s = shape_new(mem, "same", 3, n);
  shape_three(&s, (vec3){0, 0, 0}, (vec3){1, 0.5f, 0.25f}, (vec3){0, 1, 1});
  while (s.triangles < n)
    shape_triangle(&s, 0, 1, 2);
  return s;
}

// Nested ones of sizes that double, which cuts by cost would part one by one.
static shape shape_nested(arena *mem) {
  enum { STEPS = 240 };
  shape s = shape_new(mem, "nested", 3 * STEPS * 4, STEPS * 4);
  for (int i = 0; i < STEPS * 4; i++) {
    float f = ldexpf(1, 100 - i % STEPS), g = f * (1 + 0.1f * (float)(i & 3));
    shape_three(&s, (vec3){g, -f, 0}, (vec3){-g, f * 0.5f, f},
                (vec3){g, 0, f * 0.01f});
  }
  return s;
}

// Every fourth triangle of a mesh made such that it cannot be hit.
static shape shape_broken(shape s) {
  s.name = "broken";
  for (uint32_t t = 0; t < s.triangles; t += 4) {
    vec3 *p = s.positions + 3 * (size_t)t;
    if (t % 12 == 0) p[1].y = NAN;
    if (t % 12 == 4) p[2].x = INFINITY;
    if (t % 12 == 8) p[2] = p[0];
  }
  return s;
}

enum { SHAPES = 14 };

static void shapes_all(shape out[SHAPES], arena *mem) {
  const vec3 one = {1, 1, 1}, zero = {0, 0, 0};
  int n = 0;
  out[n++] = shape_new(mem, "none", 0, 0);
  out[n++] = shape_mix(mem, 1);
  out[n++] = shape_mix(mem, 2);
  out[n++] = shape_mix(mem, 600);
  out[n++] = shape_needles(mem, 300, 1e-2f);
  out[n++] = shape_needles(mem, 300, 1e-6f);
  out[n++] = shape_walls(mem, 150);
  out[n++] = shape_same(mem, 100);
  out[n++] = shape_nested(mem);
  out[n++] = shape_broken(shape_mix(mem, 600));
  out[n++] = shape_moved(shape_mix(mem, 400), "huge", vec3_all(1e30f), zero);
  out[n++] = shape_moved(shape_mix(mem, 400), "tiny", vec3_all(1e-20f), zero);
  out[n++] =
      shape_moved(shape_mix(mem, 400), "far", one, (vec3){3e4f, -3e4f, 3e4f});
  out[n++] =
      shape_moved(shape_walls(mem, 100), "plate", (vec3){1, 1e-5f, 1}, zero);
  assert_int_equal(n, SHAPES);
}

static vec3 point_near(const cut_grove *g, uint64_t *state) {
  vec3 u = vec3_mad(vec3_all(0.5f), 0.75f, shape_point(state));
  float pick = shape_random(state);
  if (pick > 0.9f) u.x = pick > 0.95f ? 0 : 0.5f;
  if (pick > 0.8f) u.y = pick > 0.85f ? 0 : 0.25f;
  return vec3_add(g->lo, vec3_mul(u, g->extent));
}

// A ray that lies in the plane of some triangle as nearly as rounding allows,
// from outside of it or from inside: its t is mostly rounding.
static ray ray_edge_on(const cut_grove *g, uint64_t *state) {
  uint32_t t = (uint32_t)(shape_random(state) * (float)g->s.triangles);
  const uint32_t *v = g->s.index + 3 * (size_t)t;
  const vec3 *p = g->s.positions;
  float u[4];
  for (int i = 0; i < 4; i++)
    u[i] = 3 * shape_random(state) - 1;
  vec3 e = vec3_sub(p[v[1]], p[v[0]]), f = vec3_sub(p[v[2]], p[v[0]]);
  vec3 a = vec3_mad(vec3_mad(p[v[0]], u[0], e), u[1], f);
  vec3 b = vec3_mad(vec3_mad(p[v[0]], u[2], e), u[3], f);
  float size = 1e-6f * vec3_peak(vec3_abs(e)) * shape_random(state);
  a = vec3_mad(a, size, shape_point(state));
  return ray_from(a, vec3_sub(b, a));
}

static ray ray_near(const cut_grove *g, int i, uint64_t *state) {
  (void)i;
  vec3 o = point_near(g, state), d = vec3_sub(point_near(g, state), o);
  float pick = shape_random(state);
  if (pick < 0.2f) d.x = pick < 0.1f ? 0 : 1e-39f;
  if (pick < 0.15f && pick > 0.05f) d.z = pick > 0.1f ? -0.0f : 1e-20f * d.z;
  ray r = ray_from(o, d);
  if (pick > 0.5f && g->s.triangles > 0) r = ray_edge_on(g, state);
  if (pick > 0.8f) r.tmax = shape_random(state) * 2;
  if (pick > 0.9f) r.tmin = shape_random(state);
  return r;
}

// All ways to ask agree (cut_groves.h), on 30,000 rays a mesh, a good part of
// them edge-on.
static void tree_equals_list(void **unused) {
  (void)unused;
  arena mem = {0};
  pool *threads = pool_new(&mem, pool_default_threads());
  shape all[SHAPES];
  shapes_all(all, &mem);
  for (int i = 0; i < SHAPES; i++) {
    cut_grove g;
    cut_grove_plant(&g, all[i], bvh_split_build, &mem);
    g.ray = ray_near;
    cut_grove_check(&g, many(30000), threads);
  }
  pool_free(threads);
  arena_free(&mem);
}

// Children lie in their parents, all is reached once, every kept triangle is
// in a leaf, none is twice in one, and the numbers are as told and promised.
static void check_tree(const bvh *b) {
  assert_int_equal(b->kept + b->dropped, b->triangle_count);
  assert_true(b->refs >= b->kept &&
              b->refs - b->kept <= (uint64_t)b->kept * BVH_SPLIT_PERCENT / 100);
  if (b->nodes == NULL) return;
  arena mem = {0};
  uint32_t *last = ARENA_NEW(&mem, uint32_t, b->triangle_count);
  int *depth = ARENA_NEW(&mem, int, b->node_count), deepest = 0;
  uint32_t refs = 0, kept = 0, inner = 0;
  for (uint32_t i = 0; i < b->node_count; i++) {
    const bvh_node *n = &b->nodes[i];
    if (depth[i] > deepest) deepest = depth[i];
    for (uint32_t k = 0; k < n->count; k++) {
      uint32_t t = b->order[n->first + k];
      assert_true(t < b->triangle_count && last[t] != i + 1);
      kept += last[t] == 0;
      last[t] = i + 1;
    }
    refs += n->count;
    assert_true(n->count <= BVH_MAX_LEAF);
    if (n->count > 0) assert_true(n->first + n->count <= b->refs);
    if (n->count > 0) continue;
    inner++;
    for (uint32_t c = n->first; c < n->first + 2; c++) {
      assert_true(c > i && c < b->node_count && depth[c] == 0);
      assert_true(box_within(b->nodes[c].lo, b->nodes[c].hi, n->lo, n->hi));
      depth[c] = depth[i] + 1;
    }
  }
  assert_int_equal(b->node_count, 2 * inner + 1);
  assert_int_equal(refs, b->refs);
  assert_int_equal(kept, b->kept);
  assert_int_equal(deepest, b->depth);
  assert_true(b->depth <= BVH_MAX_DEPTH);
  arena_free(&mem);
}

static void trees_are_whole(void **unused) {
  (void)unused;
  arena mem = {0};
  shape all[SHAPES];
  shapes_all(all, &mem);
  uint32_t more = 0;
  for (int i = 0; i < SHAPES; i++) {
    cut_grove g;
    cut_grove_plant(&g, all[i], bvh_split_build, &mem);
    check_tree(&g.cut);
    assert_int_equal(g.cut.kept, g.plain.kept);
    if (g.cut.nodes == NULL) continue;
    // The same root: margins and hits depend on it.
    assert_memory_equal(&g.cut.nodes[0].lo, &g.plain.nodes[0].lo, 12);
    assert_memory_equal(&g.cut.nodes[0].hi, &g.plain.nodes[0].hi, 12);
    more += g.cut.refs - g.cut.kept;
  }
  // Triangles are cut, or this tests nothing.
  assert_true(more > 500);
  arena_free(&mem);
}

// The law on which the equality rests: every point of a triangle, between
// neighbouring floats along each axis, is in the box of a leaf that has the
// triangle.
static void leaves_cover_triangles(void **unused) {
  (void)unused;
  arena mem = {0};
  shape all[SHAPES];
  shapes_all(all, &mem);
  uint64_t state = 3;
  for (int i = 0; i < SHAPES; i++) {
    cut_grove g;
    cut_grove_plant(&g, all[i], bvh_split_build, &mem);
    if (g.cut.kept == 0) continue;
    for (uint32_t k = 0; k < many(20000); k++) {
      uint32_t at = (uint32_t)(shape_random(&state) * (float)g.cut.refs);
      uint32_t t = g.cut.order[at < g.cut.refs ? at : 0];
      vec3 p[3], lo, hi;
      corners_of(p, &g.s, t);
      point_between(&lo, &hi, p, k % 4 == 0, &state);
      assert_true(leaf_holds(&g.cut, t, lo, hi));
    }
  }
  arena_free(&mem);
}

// 1, 2 and 7 threads build the same nodes and the same order, to the byte.
static void threads_do_not_matter(void **unused) {
  (void)unused;
  arena mem = {0};
  shape s[2] = {shape_mix(&mem, 40000), shape_needles(&mem, 20000, 1e-3f)};
  for (int k = 0; k < 2; k++) {
    bvh b[3];
    const int threads[3] = {1, 2, 7};
    for (int j = 0; j < 3; j++) {
      pool *p = pool_new(&mem, threads[j]);
      bvh of = mesh_of(&s[k]);
      bvh_split_build(&b[j], &of, (double)INFINITY, &mem, p);
      pool_free(p);
    }
    check_tree(&b[0]);
    assert_true(b[0].refs > b[0].kept + 1000);
    for (int j = 1; j < 3; j++) {
      assert_int_equal(b[j].node_count, b[0].node_count);
      assert_int_equal(b[j].refs, b[0].refs);
      assert_memory_equal(b[j].nodes, b[0].nodes,
                          b[0].node_count * sizeof(bvh_node));
      assert_memory_equal(b[j].order, b[0].order, b[0].refs * sizeof(uint32_t));
    }
  }
  arena_free(&mem);
}

// A scan has no large triangles, and its tree is the plain one; walls across
// a room of small things cost a good part less when they are cut.
static void cuts_only_where_it_pays(void **unused) {
  (void)unused;
  arena mem = {0};
  cut_grove g;
  shape ball = shape_sphere(&mem, 280);
  cut_grove_plant(&g, ball, bvh_split_build, &mem);
  assert_int_equal(g.cut.node_count, g.plain.node_count);
  assert_memory_equal(g.cut.nodes, g.plain.nodes,
                      g.plain.node_count * sizeof(bvh_node));
  cut_grove_plant(&g, shape_mix(&mem, 20000), bvh_split_build, &mem);
  assert_true(g.cut.cost < 0.7 * g.plain.cost);
  // However many rays: a few large triangles among many, but not needles of
  // which there is no room to cut more than a third.
  bvh tree;
  bvh_split_build(&tree, &g.plain, 1e15, &mem, NULL);
  assert_int_equal(tree.node_count, g.cut.node_count);
  cut_grove_plant(&g, shape_needles(&mem, 3000, 1e-3f), bvh_split_build, &mem);
  bvh_split_build(&tree, &g.plain, 1e15, &mem, NULL);
  assert_int_equal(tree.refs, tree.kept);
  assert_memory_equal(tree.nodes, g.plain.nodes,
                      g.plain.node_count * sizeof(bvh_node));
  arena_free(&mem);
}

// Points of a triangle in a slice are in the box of its part, for triangles of
// all sizes and places; and the box is no larger than the slice and the box
// that it was cut from.
static void clips_are_conservative(void **unused) {
  (void)unused;
  uint64_t state = 17;
  uint32_t inside = 0;
  for (uint32_t i = 0; i < many(500000); i++) {
    float size = num_exp2(60 * shape_random(&state) - 30);
    float far = num_exp2(60 * shape_random(&state) - 30);
    vec3 c = vec3_scale(shape_point(&state), far), p[3];
    for (int k = 0; k < 3; k++)
      p[k] = vec3_mad(c, size, shape_point(&state));
    vec3 a = vec3_min(p[0], vec3_min(p[1], p[2]));
    vec3 b = vec3_max(p[0], vec3_max(p[1], p[2]));
    sah_box own = {{a.x, a.y, a.z, 0}, {b.x, b.y, b.z, 0}}, out;
    int axis = (int)(i % 3);
    float u = shape_random(&state), span = own.hi[axis] - own.lo[axis];
    bvh_slice s = {axis, own.lo[axis] + u * span, INFINITY};
    if (i & 1) s.hi = s.lo + 0.1f * span;
    double w[3] = {(double)shape_random(&state), 0, 0};
    w[1] = (1 - w[0]) * (double)shape_random(&state);
    w[2] = 1 - w[0] - w[1];
    double q[3];
    for (int k = 0; k < 3; k++)
      q[k] = weighted(p, w, k);
    if (q[axis] < (double)s.lo || q[axis] > (double)s.hi) continue;
    bvh_outline t = bvh_outline_of(p);
    assert_true(bvh_split_clip(&out, &own, &t, s));
    assert_true(out.lo[axis] >= s.lo && out.hi[axis] <= s.hi);
    for (int k = 0; k < 3; k++) {
      assert_true(out.lo[k] >= own.lo[k] && out.hi[k] <= own.hi[k]);
      assert_true(q[k] >= (double)out.lo[k] && q[k] <= (double)out.hi[k]);
    }
    inside++;
  }
  assert_true(inside > many(100000));
}

// A hundred thousand large triangles in one place: no blow-up, no deep tree.
static void coincident_triangles(void **unused) {
  (void)unused;
  arena mem = {0};
  cut_grove g;
  cut_grove_plant(&g, shape_same(&mem, many(100000)), bvh_split_build, &mem);
  check_tree(&g.cut);
  uint64_t state = 3;
  for (int i = 0; i < 30; i++) {
    ray r = ray_near(&g, i, &state);
    assert_true(cut_grove_agrees(&g, &r));
  }
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(trees_are_whole),
      cmocka_unit_test(clips_are_conservative),
      cmocka_unit_test(leaves_cover_triangles),
      cmocka_unit_test(tree_equals_list),
      cmocka_unit_test(threads_do_not_matter),
      cmocka_unit_test(cuts_only_where_it_pays),
      cmocka_unit_test(coincident_triangles),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
