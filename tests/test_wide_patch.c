// test_wide_patch.c — what rays that leave a facet pass over is below it, and
// they find the same without looking at it.

#include "bvh_split.h"
#include "departures.h"
#include "pool.h"
#include "wide.h"
#include "wide_patch.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// A mesh with its tree.
typedef struct patched {
  solid s;
  scene scene;
  wide_tree wide;
} patched;

static void solid_join(solid *to, const solid *s, float size, vec3 at,
                       bool turned) {
  for (uint32_t i = 0; i < 3 * s->triangles; i++) {
    uint32_t k = turned && i % 3 > 0 ? i / 3 * 3 + 3 - i % 3 : i;
    to->index[3 * to->triangles + i] = to->vertices + s->index[k];
  }
  for (uint32_t i = 0; i < s->vertices; i++)
    to->p[to->vertices + i] = vec3_mad(at, size, s->p[i]);
  to->vertices += s->vertices;
  to->triangles += s->triangles;
}

// Balls among each other, some inside out, and a floor of two triangles; at
// such a distance from the origin.  Their corners are out of place by a
// thousandth of an edge, so that about half of the edges are in valleys.
static solid balls_on_a_floor(bool turned, vec3 far, arena *mem) {
  enum { BALLS = 12 };
  solid ball = solid_icosphere(mem, 4);
  solid s = {.p = ARENA_NEW(mem, vec3, (size_t)BALLS * ball.vertices + 4),
             .index = ARENA_NEW(mem, uint32_t,
                                3 * ((size_t)BALLS * ball.triangles + 2))};
  rng r = rng_of(12, 1, 0);
  for (uint32_t i = 0; i < ball.vertices; i++)
    ball.p[i] = vec3_mad(ball.p[i], 1e-4f, random_vector(&r));
  for (int i = 0; i < BALLS; i++) {
    vec3 at = vec3_add(far, vec3_scale(random_vector(&r), 4));
    solid_join(&s, &ball, 0.3f + rng_next(&r), at, turned && i % 3 == 0);
  }
  vec3 corners[] = {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}};
  for (int i = 0; i < 4; i++)
    corners[i] = vec3_add(far, corners[i]);
  uint32_t index[] = {0, 1, 2, 0, 2, 3};
  solid floor = {.p = corners, .index = index, .vertices = 4, .triangles = 2};
  solid_join(&s, &floor, 1, (vec3){0, 0, 0}, false);
  return s;
}

static void patch(patched *p, solid s, bool cut, int workers, arena *mem) {
  pool *threads = pool_new(mem, workers);
  bvh of = {.positions = s.p, .index = s.index, .triangle_count = s.triangles};
  bvh b;
  p->s = s;
  p->scene = solid_scene(&p->s, false);
  if (cut)
    bvh_split_build(&b, &of, 1e12, mem, threads);
  else
    bvh_build(&b, s.p, s.index, s.triangles, BVH_SAH, mem, threads);
  wide_tree_build(&p->wide, &b, mem, threads);
  wide_patches_find(&p->wide, s.triangles, mem, threads);
  pool_free(threads);
}

// Whether triangle u is below a plane of triangle t, by long double: its own,
// or one through an edge.
static bool lies_below(const solid *s, uint32_t t, uint32_t u) {
  const uint32_t *a = s->index + 3 * (size_t)t, *b = s->index + 3 * (size_t)u;
  vec3 c[3] = {s->p[a[0]], s->p[a[1]], s->p[a[2]]};
  exact3 n = exact3_cross(exact3_sub(c[1], c[0]), exact3_sub(c[2], c[0]));
  long double length = sqrtl(exact3_dot(n, n));
  bool below[4] = {true, true, true, true};
  for (int e = 0; e < 3; e++) {
    exact3 edge = exact3_sub(c[(e + 1) % 3], c[e]);
    exact3 out = exact3_cross(edge, n);
    long double all = sqrtl(exact3_dot(out, out));
    for (int k = 0; k < 3; k++) {
      exact3 d = exact3_sub(s->p[b[k]], c[e]);
      long double high = exact3_dot(n, d) / length;
      long double far = sqrtl(exact3_dot(d, d)) * 1e-15L;
      below[0] &= high <= far;
      below[e + 1] &=
          high <= (long double)RAY_CLIMB * exact3_dot(out, d) / all + far;
    }
  }
  return below[0] || below[1] || below[2] || below[3];
}

// Of what is below a child: how much, whether a triangle is among it, and
// whether all of it lies below that.
typedef struct contents {
  uint32_t triangles;
  bool own, below;
} contents;

static void look(const patched *p, uint32_t triangle, uint32_t child,
                 contents *out) {
  if ((child & WIDE_LEAF_BIT) == 0) {
    const wide_node *n = &p->wide.nodes[child];
    for (int k = 0; k < WIDE; k++)
      if (n->valid >> k & 1) look(p, triangle, n->child[k], out);
    return;
  }
  uint32_t first = wide_leaf_first(child), count = wide_leaf_count(child);
  const uint32_t *number = p->wide.triangles + 10 * (size_t)first + 9 * count;
  for (uint32_t i = 0; i < count; i++) {
    out->own |= number[i] == triangle;
    out->below = out->below && lies_below(&p->s, triangle, number[i]);
  }
  out->triangles += count;
}

// A patch may be most of the mesh, so one triangle of so many is looked at.
enum { LOOKED_AT = 101 };

// Everything in a patch is below its triangle; and balls are made of large
// ones, but not where they are inside out.
static void patches_lie_below(void **state) {
  (void)state;
  for (int cut = 0; cut < 2; cut++) {
    arena mem = {0};
    patched p;
    patch(&p, balls_on_a_floor(true, (vec3){0, 0, 0}, &mem), cut, 1, &mem);
    assert_non_null(p.wide.patch);
    uint32_t ball = (p.s.triangles - 2) / 12, large = 0;
    for (uint32_t t = 0; t < p.s.triangles; t += LOOKED_AT) {
      if (p.wide.patch[t] == 0) continue;
      contents c = {.below = true};
      look(&p, t, p.wide.patch[t], &c);
      assert_true(c.own && c.below);
      if (t < 12 * ball && t / ball % 3 == 0)
        assert_true(c.triangles < ball / 16);
      else
        large += c.triangles > ball / 16 ? LOOKED_AT : 0;
    }
    assert_true(large > 6 * ball);
    arena_free(&mem);
  }
}

// A bumpy ball has next to none, so that nothing is kept of them.
static void bumps_have_no_patches(void **state) {
  (void)state;
  arena mem = {0};
  solid s = solid_icosphere(&mem, 5);
  rng r = rng_of(12, 2, 0);
  for (uint32_t i = 0; i < s.vertices; i++)
    s.p[i] = vec3_scale(s.p[i], 1 + 0.02f * rng_next(&r));
  patched p;
  patch(&p, s, false, 1, &mem);
  assert_true(p.wide.patches_looked_for);
  assert_null(p.wide.patch);
  assert_int_equal(p.wide.patch_count, 0);
  arena_free(&mem);
}

static void threads_do_not_matter(void **state) {
  (void)state;
  arena mem = {0};
  patched one, other;
  patch(&one, balls_on_a_floor(false, (vec3){0, 0, 0}, &mem), true, 1, &mem);
  patch(&other, balls_on_a_floor(false, (vec3){0, 0, 0}, &mem), true, 3, &mem);
  assert_int_equal(one.wide.patch_count, other.wide.patch_count);
  assert_memory_equal(one.wide.patch, other.wide.patch,
                      one.wide.patch_count * sizeof *one.wide.patch);
  arena_free(&mem);
}

enum { BATCH = 1000 };

// Rays that leave random points in random directions, grazing ones among them,
// as paths leave them; how many climb.
static uint32_t leave(const patched *p, rng *r, ray *rays, uint32_t *left) {
  uint32_t climb = 0;
  for (int i = 0; i < BATCH; i++) {
    hit h = random_hit(r, p->s.triangles);
    vec3 d = random_direction(r);
    surface at = surface_at(&p->scene, &h, vec3_neg(d));
    if (i % 4 == 0)
      d = vec3_unit(vec3_mad(d, 1.01f * RAY_CLIMB - vec3_dot(d, at.ng), at.ng));
    rays[i] = surface_ray(&at, d);
    left[i] = ray_climbs(d, at.ng) ? h.triangle : HIT_NONE;
    climb += left[i] != HIT_NONE;
  }
  return climb;
}

// With and without patches, and one by one, where all is looked at: the same
// hits, to the bit, with all instructions.
static void patches_change_no_hit(void **state) {
  (void)state;
  const int batches = getenv("FACET_QUICK") != NULL ? 5 : 200;
  for (int k = 0; k < 3; k++) {
    arena mem = {0};
    patched p;
    vec3 far = k == 2 ? (vec3){3e4f, -2e4f, 1e4f} : (vec3){0, 0, 0};
    patch(&p, balls_on_a_floor(k == 1, far, &mem), k == 1, 1, &mem);
    assert_non_null(p.wide.patch);
    rng r = rng_of(12, 3, (uint32_t)k);
    uint32_t climb = 0, found = 0;
    for (int i = 0; i < batches; i++) {
      const wide_level *l = wide_level_at(i % WIDE_LEVELS);
      if (l == NULL) l = wide_level_at(0);
      ray rays[BATCH];
      uint32_t left[BATCH];
      hit with[BATCH], without[BATCH];
      climb += leave(&p, &r, rays, left);
      l->closest_many(&p.wide, rays, left, with, BATCH);
      l->closest_many(&p.wide, rays, NULL, without, BATCH);
      assert_memory_equal(with, without, sizeof with);
      for (int j = 0; j < BATCH; j++)
        found += with[j].triangle != HIT_NONE;
    }
    assert_true(climb > (uint32_t)batches * BATCH / 3);
    assert_true(found > (uint32_t)batches * BATCH / 10);
    arena_free(&mem);
  }
}

// The patch is what is not looked at: where rays say that they climb from a
// ball which they do not leave, they do not meet it.
static void patches_are_passed_over(void **state) {
  (void)state;
  arena mem = {0};
  patched p;
  patch(&p, balls_on_a_floor(false, (vec3){0, 0, 0}, &mem), false, 1, &mem);
  rng r = rng_of(12, 4, 0);
  ray rays[BATCH];
  uint32_t left[BATCH], lost = 0;
  hit hits[BATCH], lies[BATCH];
  leave(&p, &r, rays, left);
  wide_tracer(&p.wide).closest_many(&p.wide, rays, NULL, hits, BATCH);
  for (int i = 0; i < BATCH; i++)
    left[i] = hits[i].triangle;
  wide_tracer(&p.wide).closest_many(&p.wide, rays, left, lies, BATCH);
  for (int i = 0; i < BATCH; i++)
    lost += lies[i].triangle != hits[i].triangle;
  assert_true(lost > BATCH / 10);
  arena_free(&mem);
}

// Of few triangles, the large ones, the leaf is found at once; it lies below
// them, and no hit changes.
static void large_ones_have_theirs(void **state) {
  (void)state;
  for (int cut = 0; cut < 2; cut++) {
    arena mem = {0};
    patched p;
    patch(&p, balls_on_a_floor(true, (vec3){0, 0, 0}, &mem), cut, 1, &mem);
    wide_patches_large(&p.wide, p.s.triangles, &mem);
    uint32_t many = 0, floor = p.s.triangles - 2;
    for (uint32_t t = 0; t < p.s.triangles; t++) {
      if (p.wide.patch[t] == 0) continue;
      contents c = {.below = true};
      look(&p, t, p.wide.patch[t], &c);
      assert_true(c.own && c.below && c.triangles <= WIDE);
      many++;
    }
    assert_true(many >= 2 && many < p.s.triangles / 1000);
    assert_true(p.wide.patch[floor] != 0 && p.wide.patch[floor + 1] != 0);
    rng r = rng_of(12, 5, 0);
    ray rays[BATCH];
    uint32_t left[BATCH];
    hit with[BATCH], without[BATCH];
    for (int i = 0; i < 20; i++) {
      for (int j = 0; j < BATCH; j++) {
        vec3 at = {18 * rng_next(&r) - 9, 18 * rng_next(&r) - 9, 0};
        rays[j] = ray_from(at, (vec3){0.4f, at.x / 9, 0.1f + rng_next(&r)});
        left[j] = floor + (at.y > at.x);
      }
      wide_tracer(&p.wide).closest_many(&p.wide, rays, left, with, BATCH);
      wide_tracer(&p.wide).closest_many(&p.wide, rays, NULL, without, BATCH);
      assert_memory_equal(with, without, sizeof with);
    }
    arena_free(&mem);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(patches_lie_below),
      cmocka_unit_test(bumps_have_no_patches),
      cmocka_unit_test(threads_do_not_matter),
      cmocka_unit_test(patches_change_no_hit),
      cmocka_unit_test(patches_are_passed_over),
      cmocka_unit_test(large_ones_have_theirs),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
