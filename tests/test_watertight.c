// test_watertight.c — from inside a closed mesh every ray hits something, also
// through its edges and corners, also through the trees.

#include "shapes.h"
#include "wide.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

#include <cmocka.h>

// Rays by one work item, and by one mesh to its edges and as many to its
// vertices.
enum { BATCH = 10000, RAYS = 650000 };

// A closed mesh, star-shaped about its centre: every ray from near there hits.
typedef struct closed_mesh {
  shape s;
  bvh b;
  wide_tree wide;
  tracer many;        // of the wide tree
  vec3 centre, room;  // where rays start: centre +- room
  uint32_t *leaks;    // of each batch
} closed_mesh;

// An aim of ray k: a vertex, or a point of an edge, rounded to floats.
static vec3 aim_of(const shape *s, bool vertex, uint64_t *state) {
  uint32_t t = (uint32_t)(shape_random(state) * (float)s->triangles);
  uint32_t side = (uint32_t)(shape_random(state) * 3);
  const uint32_t *v = s->index + 3 * (size_t)(t < s->triangles ? t : 0);
  vec3 a = s->positions[v[side % 3]], b = s->positions[v[(side + 1) % 3]];
  return vertex ? a : vec3_lerp(a, b, shape_random(state));
}

static void try_rays(void *context, size_t item, int worker) {
  (void)worker;
  closed_mesh *m = context;
  uint64_t state = 7919 * item + 13;
  uint32_t leaks = 0;
  ray rays[BATCH];
  hit hits[BATCH];
  for (int i = 0; i < BATCH; i++) {
    vec3 u = vec3_mul(m->room, shape_point(&state));
    vec3 o = vec3_add(m->centre, u);
    vec3 aim = aim_of(&m->s, item % 2, &state);
    ray r = ray_from(o, vec3_sub(aim, o));
    hit h;
    leaks += !bvh_closest(&m->b, &r, &h);
    rays[i] = r;
  }
  m->many.closest_many(&m->wide, rays, hits, BATCH);
  for (int i = 0; i < BATCH; i++)
    leaks += hits[i].triangle == HIT_NONE;
  m->leaks[item] = leaks;
}

// Rays that found a way out.
static uint32_t leaks_of(shape s, vec3 centre, vec3 room, uint32_t rays) {
  arena mem = {0};
  pool *threads = pool_new(&mem, pool_default_threads());
  if (getenv("FACET_QUICK") != NULL) rays /= 50;
  size_t batches = 2 * (size_t)(rays / BATCH + 1);
  closed_mesh m = {s, .centre = centre, .room = room};
  m.leaks = ARENA_NEW(&mem, uint32_t, batches);
  bvh_build(&m.b, s.positions, s.index, s.triangles, BVH_SAH, &mem, threads);
  assert_int_equal(m.b.dropped, 0);
  wide_tree_build(&m.wide, &m.b, &mem, threads);
  m.many = wide_tracer(&m.wide);
  pool_run(threads, batches, try_rays, &m);
  uint32_t leaks = 0;
  for (size_t i = 0; i < batches; i++)
    leaks += m.leaks[i];
  if (leaks > 0) print_message("# %s: %u rays leak\n", s.name, leaks);
  pool_free(threads);
  arena_free(&mem);
  return leaks;
}

static int by_edge(const void *a, const void *b) {
  uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
  return (x > y) - (x < y);
}

// The test meshes are closed: every edge belongs to two triangles, which run
// along it in opposite directions.
static void meshes_are_closed(void **unused) {
  (void)unused;
  arena mem = {0};
  for (uint32_t n = 1; n < 20; n += 3) {
    shape s = shape_sphere(&mem, n);
    assert_int_equal(s.vertices, 4 * n * n + 2);
    assert_int_equal(s.triangles, 8 * n * n);
    size_t count = 3 * (size_t)s.triangles;
    uint64_t *edges = ARENA_NEW(&mem, uint64_t, 2 * count);
    for (size_t i = 0; i < count; i++) {
      uint64_t a = s.index[i], b = s.index[i % 3 == 2 ? i - 2 : i + 1];
      edges[i] = a << 32 | b;
      edges[count + i] = b << 32 | a;
    }
    qsort(edges, count, sizeof *edges, by_edge);
    qsort(edges + count, count, sizeof *edges, by_edge);
    for (size_t i = 0; i < count; i++) {
      assert_true(edges[i] == edges[count + i]);
      assert_true(i == 0 || edges[i] != edges[i - 1]);
    }
  }
  arena_free(&mem);
}

// No leaks on spheres of sizes 1e-6 to 1e6, about the origin.
static void spheres(void **unused) {
  (void)unused;
  arena mem = {0};
  const float sizes[] = {1, 1e-6f, 1e6f};
  for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
    float r = sizes[i];
    shape s = shape_moved(shape_sphere(&mem, 40), "sphere", vec3_all(r),
                          (vec3){0, 0, 0});
    assert_int_equal(leaks_of(s, (vec3){0, 0, 0}, vec3_all(0.5f * r), RAYS), 0);
  }
  arena_free(&mem);
}

// No leaks on a sphere of radius 100 at 1e6, where floats lie 0.0625 apart.
static void far_away(void **unused) {
  (void)unused;
  arena mem = {0};
  vec3 at = {1e6f, -1e6f, 1e6f};
  shape s = shape_moved(shape_sphere(&mem, 12), "far", vec3_all(100), at);
  assert_int_equal(leaks_of(s, at, vec3_all(40), RAYS), 0);
  arena_free(&mem);
}

// No leaks on needles: spheres stretched 1e7 times along one axis, flattened as
// much, and stretched along a diagonal, where floats allow 1e5.
static void needles(void **unused) {
  (void)unused;
  arena mem = {0};
  const vec3 zero = {0, 0, 0};
  shape s =
      shape_moved(shape_sphere(&mem, 20), "needle", (vec3){1, 1, 1e7f}, zero);
  assert_int_equal(leaks_of(s, zero, (vec3){0.4f, 0.4f, 4e6f}, RAYS), 0);
  s = shape_moved(shape_sphere(&mem, 20), "disc", (vec3){1, 1e-7f, 1}, zero);
  assert_int_equal(leaks_of(s, zero, (vec3){0.4f, 4e-8f, 0.4f}, RAYS), 0);
  s = shape_sphere(&mem, 20);
  s.name = "diagonal needle";
  for (uint32_t i = 0; i < s.vertices; i++) {
    vec3 p = s.positions[i];
    float along = 1e5f * (p.x + p.y + p.z);
    s.positions[i] = vec3_add(p, vec3_all(along));
  }
  assert_int_equal(leaks_of(s, zero, vec3_all(0), RAYS / 4), 0);
  arena_free(&mem);
}

// No leaks from inside a cube whose faces are planes of boxes, along edges
// that lie in them; the grid's corners are exact floats.
static void cube(void **unused) {
  (void)unused;
  arena mem = {0};
  shape s = shape_sphere(&mem, 16);
  s.name = "octahedron";
  for (uint32_t i = 0; i < s.vertices; i++) {
    vec3 p = s.positions[i];
    float sum = fabsf(p.x) + fabsf(p.y) + fabsf(p.z);
    s.positions[i] = vec3_scale(p, 1 / sum);
  }
  const vec3 zero = {0, 0, 0};
  assert_int_equal(leaks_of(s, zero, vec3_all(0.3f), RAYS), 0);
  s.name = "cube";
  for (uint32_t i = 0; i < s.vertices; i++)
    s.positions[i] =
        vec3_scale(s.positions[i], 1 / vec3_peak(vec3_abs(s.positions[i])));
  assert_int_equal(leaks_of(s, zero, vec3_all(0.9f), RAYS), 0);
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(meshes_are_closed),
      cmocka_unit_test(spheres),
      cmocka_unit_test(far_away),
      cmocka_unit_test(needles),
      cmocka_unit_test(cube),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
