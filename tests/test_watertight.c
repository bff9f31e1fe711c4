// test_watertight.c — from inside a closed mesh every ray hits something, also
// through its edges and corners, also through the trees.

#include "vessels.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

#include <cmocka.h>

// Rays at the edges of a vessel, and as many at its vertices.
enum { RAYS = 650000 };

// None of the vessels first to last lets a ray out, by either tree.
static void check_vessels(int first, int last, size_t rays) {
  arena mem = {0};
  pool *threads = pool_new(&mem, pool_default_threads());
  vessel all[VESSELS];
  if (getenv("FACET_QUICK") != NULL) rays /= 50;
  vessels_all(all, &mem);
  for (int i = first; i <= last; i++) {
    vessel_losses l = {{0}, {0}};
    vessel_pour(&l, &all[i], rays, 13, true, threads);
    if (l.lost[0] + l.lost[1] > 0)
      fail_msg("%s: %g and %g rays leak", all[i].s.name, l.lost[0], l.lost[1]);
    assert_true(l.tried[0] >= (double)rays && l.tried[1] >= (double)rays);
  }
  pool_free(threads);
  arena_free(&mem);
}

static int by_edge(const void *a, const void *b) {
  uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
  return (x > y) - (x < y);
}

// What the vessels are made of is closed: every edge belongs to two triangles,
// which run along it in opposite directions.
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

// Sizes 1e-6 to 1e6, about the origin.
static void spheres(void **unused) {
  (void)unused;
  check_vessels(0, 2, RAYS);
}

// A radius of 100 at 1e6, where floats lie 0.0625 apart.
static void far_away(void **unused) {
  (void)unused;
  check_vessels(3, 3, RAYS);
}

// An octahedron, and a cube whose faces are planes of boxes: edges lie in them.
static void flat(void **unused) {
  (void)unused;
  check_vessels(4, 5, RAYS);
}

// 1e7 times as long as wide, as flat, and a diagonal one, where a ray passes
// through so many boxes that fewer will do.
static void needles(void **unused) {
  (void)unused;
  check_vessels(VESSELS_FRIENDLY, VESSELS - 2, RAYS);
  check_vessels(VESSELS - 1, VESSELS - 1, RAYS / 4);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(meshes_are_closed), cmocka_unit_test(spheres),
      cmocka_unit_test(far_away),          cmocka_unit_test(flat),
      cmocka_unit_test(needles),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
