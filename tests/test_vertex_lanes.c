// test_vertex_lanes.c — sixteen vertices at once are the vertices one by one,
// to the bit, by every set of instructions that runs here.

#include "ready.h"
#include "wide.h"
#include "world_hits.h"

#include <string.h>

enum { LONGEST = 40 };

static void assert_same(const void *a, const void *b, size_t bytes) {
  assert_memory_equal(a, b, bytes);
}

// All but the frame, which vertex_matter sets.
static void assert_same_vertex(const vertex *a, const vertex *b) {
  assert_same(&a->at.p, &b->at.p, sizeof(vec3));
  assert_same(&a->at.p_error, &b->at.p_error, sizeof(vec3));
  assert_same(&a->at.p_smooth, &b->at.p_smooth, sizeof(vec3));
  assert_same(&a->at.inward, &b->at.inward, sizeof(vec3));
  assert_same(&a->at.ng, &b->at.ng, sizeof(vec3));
  assert_same(&a->at.ns, &b->at.ns, sizeof(vec3));
  assert_same(&a->at.uv, &b->at.uv, sizeof(vec2));
  assert_same(&a->at.color, &b->at.color, sizeof(vec3));
  assert_int_equal(a->at.front, b->at.front);
  assert_int_equal(a->at.smooth, b->at.smooth);
  assert_int_equal(a->at.triangle, b->at.triangle);
  assert_ptr_equal(a->at.material, b->at.material);
  assert_same(&a->wo, &b->wo, sizeof(vec3));
  assert_same(&a->ns, &b->ns, sizeof(vec3));
  assert_same(&a->ng, &b->ng, sizeof(vec3));
}

// All vertices in runs of every length up to LONGEST, with no lights to ask.
static void find(const world *w, ready_function *by, const hit *hits,
                 const ray *rays, size_t n, vertex *out) {
  sampler numbers[LONGEST];
  path_ready ready[(LONGEST + LANES - 1) / LANES];
  for (uint32_t i = 0; i < LONGEST; i++)
    numbers[i] = sampler_of(SAMPLER_SOBOL, 5, i, i);
  for (size_t from = 0, run = 1; from < n;
       from += run, run = run % LONGEST + 1) {
    if (run > n - from) run = n - from;
    ready_job j = {.scene = &w->scene,
                   .dimension = 2,
                   .hits = hits + from,
                   .rays = rays + from,
                   .numbers = numbers,
                   .at = out + from,
                   .ready = ready};
    by(&j, run);
  }
}

// Every level that runs here.
static void check(const char *name, world *w) {
  world_ready(w, 0);
  hit *hits = ARENA_NEW(&w->mem, hit, HITS);
  ray *rays = ARENA_NEW(&w->mem, ray, HITS);
  vertex *out = ARENA_NEW(&w->mem, vertex, HITS);
  size_t n = world_hits(w, 3, hits, rays);
  assert_true(n > LONGEST);
  int levels = 0;
  for (int level = 0; level < WIDE_LEVELS; level++) {
    ready_function *by = ready_by(level);
    if (by == NULL) continue;
    levels++;
    memset(out, 0, n * sizeof *out);
    find(w, by, hits, rays, n, out);
    for (size_t i = 0; i < n; i++) {
      vertex one = vertex_at(&w->scene, &hits[i], rays[i].d);
      assert_same_vertex(&one, &out[i]);
    }
  }
  print_message("# %s: %zu hits, %d levels\n", name, n, levels);
  world_free(w);
}

static void balls(void **state) {
  (void)state;
  for (int smooth = 0; smooth < 2; smooth++) {
    world *w = world_new();
    world_ball(w, (vec3){0.1f, 0.2f, 0.3f}, 1, 4, smooth, 1);
    world_box(w, vec3_all(-2), vec3_all(2), smooth, 0);
    check(smooth ? "smooth ball in a box" : "faceted ball in a box", w);
  }
}

// What the lanes hand over: corners without normals beside corners with them,
// normals of no length, turned round, or far from the facet's, and such of a
// length that has no square.
static void odd_normals(void **state) {
  (void)state;
  world *w = world_new();
  world_ball(w, vec3_all(0), 1, 4, true, 1);
  mesh *m = &w->scene.mesh;
  for (size_t t = 0; t < m->triangle_count; t++)
    if (t % 7 == 1) m->normal_index[3 * t + t % 3] = MESH_NONE;
  for (size_t i = 0; i < m->position_count; i++) {
    vec3 *n = &m->normals[i];
    if (i % 11 == 0) *n = vec3_all(0);
    if (i % 11 == 1) *n = vec3_neg(*n);
    if (i % 11 == 2) *n = vec3_cross(*n, (vec3){0.6f, 0.8f, 0});
    if (i % 11 == 3) *n = vec3_scale(*n, 1e-25f);
    if (i % 11 == 4) *n = vec3_scale(*n, 1e25f);
    if (i % 11 == 5) *n = (vec3){NAN, 1, 0};
    if (i % 11 == 6) *n = (vec3){INFINITY, 1, 0};
  }
  check("odd normals", w);
}

// Needles, tiny and huge triangles, far from the origin.
static void odd_triangles(void **state) {
  (void)state;
  const float scale[] = {1e-15f, 1e-6f, 1, 1e6f, 1e15f};
  for (size_t k = 0; k < sizeof scale / sizeof *scale; k++) {
    world *w = world_new();
    for (int i = 0; i < 2000; i++) {
      rng r = rng_of(k, (uint64_t)i, 0);
      vec3 o = {rng_next(&r), rng_next(&r), rng_next(&r)}, e[2];
      for (int j = 0; j < 2; j++) {
        vec3 u = {rng_next(&r) - 0.5f, rng_next(&r) - 0.5f,
                  rng_next(&r) - 0.5f};
        e[j] = vec3_scale(u, j == 0 ? 0.5f : 0.5f / (float)(1 + i));
      }
      world_quad(w, vec3_scale(vec3_add(o, vec3_all(i % 2 ? 0 : 7)), scale[k]),
                 vec3_scale(e[0], scale[k]), vec3_scale(e[1], scale[k]), 0);
    }
    check("needles", w);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(balls),
      cmocka_unit_test(odd_normals),
      cmocka_unit_test(odd_triangles),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
