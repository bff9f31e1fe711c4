// test_bvh.c — the tree against the list, to the bit.

#include "groves.h"
#include "slab.h"
#include "triangle.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

// Whether the four ways to ask agree about r.
static bool all_agree(const bvh *b, const ray *r) {
  hit list = {0}, tree = {0}, counted = {0};
  bvh_visits v = {0};
  bool found = brute_closest(b, r, &list);
  return bvh_closest(b, r, &tree) == found &&
         bvh_closest_counted(b, r, &counted, &v) == found &&
         brute_any(b, r) == found && bvh_any(b, r) == found &&
         memcmp(&tree, &list, sizeof list) == 0 &&
         memcmp(&counted, &list, sizeof list) == 0;
}

enum { BATCH = 500 };

static void try_batch(void *context, size_t item, int worker) {
  (void)worker;
  grove *g = context;
  uint64_t state = 977 * item + 1;
  for (int i = 0; i < BATCH; i++) {
    ray r = ray_near(g, &state);
    if (all_agree(&g->b, &r)) continue;
    // Only told apart from 0.
    g->wrong = 1;
  }
}

// The tree finds what testing every triangle finds: the same triangle, t and
// weights to the bit, and the same yes or no, on 100,000 rays a mesh.
static void tree_equals_list(void **unused) {
  (void)unused;
  arena mem = {0};
  pool *threads = pool_new(&mem, pool_default_threads());
  shape all[SHAPES];
  shapes_all(all, &mem);
  for (int i = 0; i < 2 * SHAPES; i++) {
    grove g;
    grove_plant(&g, all[i / 2], &mem, i % 2 ? BVH_MEDIAN : BVH_SAH);
    // The median's tree is the same code's: a tenth of the rays.
    pool_run(threads, many(i % 2 ? 10000 : 100000) / BATCH, try_batch, &g);
    if (g.wrong) print_message("# %s differs\n", g.s.name);
    assert_int_equal(g.wrong, 0);
  }
  pool_free(threads);
  arena_free(&mem);
}

// A million triangles in one place: the tree holds them all, is no deeper than
// halving makes it, and gives the lowest number.  30 rays, since each costs
// the list, and the tree too, a million tests.
static void coincident_triangles(void **unused) {
  (void)unused;
  arena mem = {0};
  uint32_t n = many(1000000);
  shape s = shape_new(&mem, "coincident", 3, n);
  shape_three(&s, (vec3){0, 0, 0}, (vec3){1, 0, 0.5f}, (vec3){0, 1, 0.25f});
  while (s.triangles < n)
    shape_triangle(&s, 0, 1, 2);
  grove g;
  grove_plant(&g, s, &mem, BVH_SAH);
  assert_int_equal(g.b.kept, n);
  assert_true(g.b.depth <= 20);
  uint64_t state = 3;
  int hits = 0;
  for (int i = 0; i < 30; i++) {
    ray r = ray_near(&g, &state);
    hit h;
    assert_true(all_agree(&g.b, &r));
    if (!bvh_closest(&g.b, &r, &h)) continue;
    assert_int_equal(h.triangle, 0);
    hits++;
  }
  assert_true(hits > 2);
  arena_free(&mem);
}

// Whether box a lies in box b.
static bool box_within(vec3 alo, vec3 ahi, vec3 blo, vec3 bhi) {
  return alo.x >= blo.x && alo.y >= blo.y && alo.z >= blo.z && ahi.x <= bhi.x &&
         ahi.y <= bhi.y && ahi.z <= bhi.z;
}

// One leaf: its triangles lie in its box; marks them as seen.
static void check_leaf(const bvh *b, const bvh_node *n, unsigned char *seen) {
  assert_true(n->count <= BVH_MAX_LEAF && n->first + n->count <= b->kept);
  for (uint32_t i = n->first; i < n->first + n->count; i++) {
    uint32_t t = b->order[i];
    assert_true(t < b->triangle_count);
    assert_int_equal(seen[t]++, 0);
    for (int k = 0; k < 3; k++) {
      vec3 p = b->positions[b->index[3 * (size_t)t + (size_t)k]];
      assert_true(box_within(p, p, n->lo, n->hi));
    }
  }
}

// Walk the whole tree: children lie in their parents, every node is reached
// once, every kept triangle is in one leaf, and the depth is as told.
static void check_tree(const bvh *b) {
  if (b->nodes == NULL) {
    assert_int_equal(b->kept, 0);
    return;
  }
  arena mem = {0};
  unsigned char *seen = ARENA_NEW(&mem, unsigned char, b->triangle_count);
  int *depth = ARENA_NEW(&mem, int, b->node_count), deepest = 0;
  uint32_t *todo = ARENA_NEW(&mem, uint32_t, b->node_count);
  uint32_t top = 1, reached = 0, triangles = 0;
  while (top > 0) {
    const bvh_node *n = &b->nodes[todo[--top]];
    int d = depth[n - b->nodes];
    if (d > deepest) deepest = d;
    reached++;
    if (n->count > 0) {
      check_leaf(b, n, seen);
      triangles += n->count;
      continue;
    }
    for (uint32_t c = n->first; c < n->first + 2; c++) {
      assert_true(c > 0 && c < b->node_count);
      const bvh_node *child = &b->nodes[c];
      assert_true(box_within(child->lo, child->hi, n->lo, n->hi));
      depth[c] = d + 1;
      todo[top++] = c;
    }
  }
  assert_int_equal(reached, b->node_count);
  assert_int_equal(triangles, b->kept);
  assert_int_equal(b->kept + b->dropped, b->triangle_count);
  assert_int_equal(deepest, b->depth);
  assert_true(b->depth <= BVH_MAX_DEPTH);
  arena_free(&mem);
}

// Trees of all meshes are trees, and what cannot be hit is dropped.
static void trees_are_whole(void **unused) {
  (void)unused;
  arena mem = {0};
  shape all[SHAPES];
  shapes_all(all, &mem);
  for (int i = 0; i < 4 * SHAPES; i++) {
    grove g;
    grove_plant(&g, all[i / 4], &mem, (bvh_method)(i % 4));
    check_tree(&g.b);
    if (strcmp(g.s.name, "broken") == 0)
      assert_int_equal(g.b.dropped, 100 + 50 + 50);
    else
      assert_int_equal(g.b.dropped, 0);
  }
  arena_free(&mem);
}

// Nested fans, each 2^-1 of the one before and with as many triangles as all
// that follow: without a bound, the cuts by cost go deeper than any stack.
static void depth_is_bounded(void **unused) {
  (void)unused;
  arena mem = {0};
  enum { STEPS = 240 };
  shape s = shape_new(&mem, "nested", 3 * STEPS * 16, STEPS * 16);
  for (int i = 0; i < STEPS * 16; i++) {
    float f = ldexpf(1, 100 - i % STEPS);
    float g = f * (1 + 0.01f * (float)(i / STEPS));
    shape_three(&s, (vec3){g, 0, 0}, (vec3){g, f * 0.01f, 0},
                (vec3){g, 0, f * 0.01f});
  }
  for (int method = 0; method < 2; method++) {
    grove g;
    grove_plant(&g, s, &mem, method ? BVH_MEDIAN : BVH_SAH);
    check_tree(&g.b);
    // The bound was reached, or this tests nothing.
    assert_true(g.b.depth > BVH_MAX_DEPTH - 8);
    uint64_t state = 9;
    for (uint32_t i = 0; i < 100; i++) {
      ray r = ray_near(&g, &state);
      assert_true(all_agree(&g.b, &r));
    }
  }
  arena_free(&mem);
}

// 1, 2 and 7 threads build the same nodes and the same order, to the byte.
static void threads_do_not_matter(void **unused) {
  (void)unused;
  arena mem = {0};
  const uint32_t n = 60000;
  shape s[3] = {shape_soup(&mem, n, 0.02f), shape_sphere(&mem, 80),
                shape_soup(&mem, n, 0.02f)};
  // Most of the last one in a corner, so that cuts are uneven.
  for (uint32_t i = 0; i < s[2].vertices; i++)
    if (i > 600) s[2].positions[i] = vec3_scale(s[2].positions[i], 1e-3f);
  for (int k = 0; k < 6; k++) {
    bvh b[3];
    const int threads[3] = {1, 2, 7};
    for (int j = 0; j < 3; j++) {
      pool *p = pool_new(&mem, threads[j]);
      bvh_build(&b[j], s[k / 2].positions, s[k / 2].index, s[k / 2].triangles,
                k % 2 ? BVH_MEDIAN : BVH_SAH, &mem, p);
      pool_free(p);
    }
    check_tree(&b[0]);
    for (int j = 1; j < 3; j++) {
      assert_int_equal(b[j].node_count, b[0].node_count);
      assert_memory_equal(b[j].nodes, b[0].nodes,
                          b[0].node_count * sizeof(bvh_node));
      assert_memory_equal(b[j].order, b[0].order, b[0].kept * sizeof(uint32_t));
      assert_true(memcmp(&b[j].cost, &b[0].cost, sizeof b[0].cost) == 0);
    }
  }
  arena_free(&mem);
}

// A ray along an axis that lies in a face of the boxes hits what lies there:
// 0 * infinity is no reason to miss.  Each of 6 directions, down onto every
// edge of the grid of the flat square and of the block of cubes.
static void rays_in_box_faces(void **unused) {
  (void)unused;
  arena mem = {0};
  grove g;
  grove_plant(&g, shape_cubes(&mem, 4), &mem, BVH_SAH);
  for (int i = 0; i < 6 * 5 * 9; i++) {
    int axis = i % 3;
    float sign = i % 6 < 3 ? 1.0f : -1.0f;
    float o[3] = {0}, d[3] = {i & 1 ? 0.0f : -0.0f, 0, i & 2 ? 0.0f : -0.0f};
    o[(axis + 1) % 3] = (float)(i / 6 % 5);
    o[(axis + 2) % 3] = 0.5f * (float)(i / 30);
    o[axis] = sign > 0 ? -1.0f : 5.0f;
    d[axis] = sign;
    ray r = ray_from((vec3){o[0], o[1], o[2]}, (vec3){d[0], d[1], d[2]});
    hit h;
    assert_true(bvh_closest(&g.b, &r, &h));
    assert_true(h.t == 1.0f);
    assert_true(all_agree(&g.b, &r));
  }
  grove_plant(&g, shape_flat(&mem, 8), &mem, BVH_SAH);
  for (int i = 0; i < 9 * 17; i++) {
    vec3 p = {0.25f * (float)(i % 9) - 1, 1, 0.125f * (float)(i / 9) - 1};
    ray r = ray_from(p, (vec3){0, -1, 0});
    assert_true(bvh_any(&g.b, &r));
    r = ray_from(p, (vec3){-0.0f, -1, -0.0f});
    assert_true(bvh_any(&g.b, &r));
  }
  arena_free(&mem);
}

// What is no ray hits nothing and harms nothing: a direction of zeros or
// denormals, NaN or infinity anywhere, an interval that is empty.
static void no_rays(void **unused) {
  (void)unused;
  arena mem = {0};
  grove g;
  grove_plant(&g, shape_sphere(&mem, 4), &mem, BVH_SAH);
  const vec3 z = {0, 0, 0}, x = {1, 0, 0};
  const ray bad[] = {{z, z, 0, INFINITY},
                     {z, {1e-40f, -0.0f, 1e-39f}, 0, INFINITY},
                     {z, {NAN, 0, 0}, 0, INFINITY},
                     {z, {1, INFINITY, 0}, 0, INFINITY},
                     {{NAN, 0, 0}, x, 0, INFINITY},
                     {{-INFINITY, 0, 0}, x, 0, INFINITY},
                     {z, x, 2, 1},
                     {z, x, NAN, INFINITY},
                     {z, x, 0, NAN},
                     {z, x, 0, 0.5f},
                     {z, x, 1.5f, INFINITY}};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    hit h;
    assert_false(bvh_closest(&g.b, &bad[i], &h));
    assert_false(brute_closest(&g.b, &bad[i], &h));
    assert_false(bvh_any(&g.b, &bad[i]));
    assert_false(brute_any(&g.b, &bad[i]));
  }
  arena_free(&mem);
}

// A plane at 0 * infinity from the origin cuts nothing, on either side, and a
// box beside a ray along an axis is missed.
static void nan_cuts_nothing(void **unused) {
  (void)unused;
  const slab_span all = {0, INFINITY};
  for (int k = 0; k < 24; k++) {
    float inv[3] = {1, 1, 1}, enter[3] = {0}, leave[3] = {0};
    float lo[3] = {3, 3, 3}, hi[3] = {4, 4, 4};
    int axis = k / 8;
    bool back = k & 1;
    inv[axis] = back ? -INFINITY : INFINITY;
    lo[axis] = 1;
    hi[axis] = 2;
    slab_box box = {.lo = {lo[0], lo[1], lo[2]}, .hi = {hi[0], hi[1], hi[2]}};
    slab_ray s = {.inv = {inv[0], inv[1], inv[2]},
                  .x = back && axis == 0 ? 16 : 0,
                  .y = back && axis == 1 ? 20 : 4,
                  .z = back && axis == 2 ? 24 : 8};
    enter[axis] = k & 2 ? 1 : 2;
    leave[axis] = k & 4 ? 1 : 2;
    s.o_enter = (vec3){enter[0], enter[1], enter[2]};
    s.o_leave = (vec3){leave[0], leave[1], leave[2]};
    slab_span in = slab_cut(&s, &box, all);
    assert_true(in.near == 3 && in.far == 4);
    enter[axis] = leave[axis] = k & 2 ? 0.5f : 2.5f;
    s.o_enter = s.o_leave = (vec3){enter[0], enter[1], enter[2]};
    in = slab_cut(&s, &box, all);
    assert_false(in.near <= in.far);
  }
}

// What triangle_hit accepts lies in its box as slab_cut sees it, whatever the
// sizes: random triangles of all shapes around a ray, their edges and corners
// within rounding of it; and needles that pass beside its origin, far longer
// than they are away.  There the shear errs by more than the needle is wide.
static void slabs_are_conservative(void **unused) {
  (void)unused;
  uint64_t state = 31;
  uint32_t hits = 0;
  for (uint32_t i = 0; i < many(3000000); i++) {
    float e[4];
    for (int k = 0; k < 4; k++)
      e[k] = num_exp2(40 * shape_random(&state) - 20);
    vec3 o = vec3_scale(shape_point(&state), e[0]);
    vec3 d = vec3_mul(shape_point(&state), (vec3){1, e[1] < 1 ? e[1] : 1, 1});
    vec3 q = vec3_mad(o, e[2], d), p[3];
    for (int k = 0; k < 3; k++)
      p[k] = vec3_mad(q, e[3], shape_point(&state));
    // Every other one with an edge or corner through the ray.
    if (i % 2) p[1] = vec3_mad(q, i % 4 == 1 ? -1.0f : 0.0f, vec3_sub(p[0], q));
    for (int k = 0; k < 3 && i % 8 == 3; k++) {
      vec3 beside = vec3_scale(vec3_mad(vec3_all(0.3f), 0.1f, q), 1e-5f);
      vec3 wide = vec3_mad(beside, 1e-6f, shape_point(&state));
      wide.z = 1000 * shape_random(&state) * (k == 0 ? -1.0f : 1.0f);
      p[k] = vec3_add(o = vec3_all(0), wide);
    }
    ray r = {o, ray_flush(d), 0, INFINITY};
    ray_shear shear = ray_shear_of(r.d);
    hit h;
    if (!triangle_hit(&r, &shear, p[0], p[1], p[2], &h)) continue;
    aabb all = aabb_add(aabb_add(aabb_add(AABB_EMPTY, p[0]), p[1]), p[2]);
    slab_ray s = slab_ray_of(r.o, r.d, &all);
    slab_box box = {.lo = all.lo, .hi = all.hi};
    slab_span in = slab_cut(&s, &box, (slab_span){-INFINITY, INFINITY});
    assert_true(in.near <= in.far);
    hits++;
  }
  assert_true(hits > many(300000));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(trees_are_whole),
      cmocka_unit_test(tree_equals_list),
      cmocka_unit_test(coincident_triangles),
      cmocka_unit_test(depth_is_bounded),
      cmocka_unit_test(threads_do_not_matter),
      cmocka_unit_test(rays_in_box_faces),
      cmocka_unit_test(no_rays),
      cmocka_unit_test(nan_cuts_nothing),
      cmocka_unit_test(slabs_are_conservative),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
