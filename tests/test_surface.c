// test_surface.c — points of hits and the rays that leave them.

#include "departures.h"
#include "num.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

static long shorter(long n) {
  return getenv("FACET_QUICK") != NULL ? n / 50 : n;
}

// A coordinate of the point with the weights of h.
static long double blend(const float p[3], const hit *h) {
  long double b1 = (long double)h->b1, b2 = (long double)h->b2;
  return (1 - b1 - b2) * (long double)p[0] + b1 * (long double)p[1] +
         b2 * (long double)p[2];
}

static void check_bound(float p, float bound, const float c[3], const hit *h) {
  long double off = fabsl((long double)p - blend(c, h));
  if (off > (long double)bound)
    fail_msg("p %.9g is off by %Lg, said to be by %g at most", (double)p, off,
             (double)bound);
  // And it is no more than rounding to float needs, unless corners are huge.
  float peak = fmaxf(fabsf(c[0]), fmaxf(fabsf(c[1]), fabsf(c[2])));
  assert_true(bound <= 0x1.001p-24f * fabsf(p) + 0x1p-48f * peak + 0x1p-148f);
}

// p_error bounds the distance from p to the exact barycentric point, computed
// in long double, for corners of any size beside each other, also far from
// the origin and where b0 is small.
static void point_error_is_a_bound(void **state) {
  (void)state;
  rng r = rng_of(8, 1, 0);
  for (long i = 0; i < shorter(400000); i++) {
    vec3 p[3], offset = vec3_scale(random_vector(&r), i % 3 == 0 ? 1e6f : 0);
    for (int k = 0; k < 3; k++) {
      float scale = num_exp2(40 * random_signed(&r));
      p[k] = vec3_mad(offset, scale, random_vector(&r));
    }
    uint32_t index[3] = {0, 1, 2};
    solid s = {.p = p, .index = index, .vertices = 3, .triangles = 1};
    scene w = solid_scene(&s, false);
    hit h = random_hit(&r, 1);
    if (i % 4 == 0) h.b1 = 1 - h.b2;  // on the edge where b0 is 0 or so
    surface at = surface_at(&w, &h, (vec3){0, 0, -1});
    check_bound(at.p.x, at.p_error.x, (float[]){p[0].x, p[1].x, p[2].x}, &h);
    check_bound(at.p.y, at.p_error.y, (float[]){p[0].y, p[1].y, p[2].y}, &h);
    check_bound(at.p.z, at.p_error.z, (float[]){p[0].z, p[1].z, p[2].z}, &h);
  }
}

// ng is the normal by the winding, unit to float precision, for needles 1e7
// times as long as wide and for triangles of 1e-30 and 1e30.
static void facet_normals_are_exact(void **state) {
  (void)state;
  rng r = rng_of(8, 2, 0);
  for (long i = 0; i < shorter(200000); i++) {
    const float scales[4] = {1e-30f, 1e-6f, 1, 1e30f};
    float scale = scales[i % 4];
    vec3 p[3] = {vec3_scale(random_vector(&r), scale),
                 vec3_scale(random_vector(&r), scale),
                 vec3_scale(random_vector(&r), scale)};
    if (i % 2 == 0) {
      vec3 middle = vec3_lerp(p[0], p[1], rng_next(&r));
      p[2] = vec3_mad(middle, 1e-6f * scale, random_direction(&r));
    }
    uint32_t index[3] = {0, 1, 2};
    solid s = {.p = p, .index = index, .vertices = 3, .triangles = 1};
    scene w = solid_scene(&s, false);
    hit h = random_hit(&r, 1);
    surface at = surface_at(&w, &h, (vec3){0, 0, -1});
    assert_true(normal_error(p, at.ng) < 2e-7);
    assert_true(fabsf(vec3_length(at.ng) - 1) < 2e-7f);
  }
}

// Of 10^6 rays that leave a closed convex mesh outwards none hits it, and of
// 10^6 inwards none misses, for sizes of 1e-6 to 1e6 and at 1e6 from the
// origin, where a float has steps of 1/16.
static void rays_neither_stick_nor_leak(void **state) {
  (void)state;
  const float scale[8] = {1e-6f, 1e-3f, 1, 1e3f, 1e6f, 10, 100, 1e4f};
  const float far[8] = {0, 0, 0, 0, 0, 1e6f, 1e6f, 1e6f};
  rng r = rng_of(8, 3, 0);
  for (int k = 0; k < 8; k++)
    for (int i = 0; i < DEPARTURE_SOLIDS; i++) {
      arena mem = {0};
      solid s = solid_number(i, scale[k], far[k], &mem);
      departures d = depart(&s, shorter(42000), &r);
      if (d.self_hits + d.leaks > 0)
        fail_msg("solid %d, size %g, at %g: %ld self-hits, %ld leaks", i,
                 (double)scale[k], (double)far[k], d.self_hits, d.leaks);
      arena_free(&mem);
    }
}

// A path of 10^6 bounces between the walls of a closed room never leaves it,
// whatever the size of the room and wherever it is.
static void paths_stay_inside(void **state) {
  (void)state;
  rng r = rng_of(8, 4, 0);
  for (int k = 0; k < 6; k++) {
    arena mem = {0};
    solid s = solid_cube(&mem);
    if (k % 2 == 1) solid_turn(&s);
    float far = k < 4 ? 0 : 1e6f;
    solid_place(&s, k < 2 ? 1e-6f : 100, (vec3){far, far, far});
    scene w = solid_scene(&s, k == 2);
    bvh tree = solid_tree(&s, &mem);
    hit h = random_hit(&r, 12);
    vec3 d = {1, 0, 0};
    for (long i = 0; i < shorter(170000); i++) {
      surface at = surface_at(&w, &h, d);
      d = random_direction(&r);
      if (vec3_dot(d, at.ng) > 0) d = vec3_neg(d);
      ray q = surface_ray(&at, d);
      if (!bvh_closest(&tree, &q, &h)) fail_msg("room %d lost a path", k);
    }
    arena_free(&mem);
  }
}

// A shadow ray reaches its light and no farther: with a wall right behind the
// light it is free, with the light behind the wall it is not, at any scale.
static void shadow_rays_end_at_the_light(void **state) {
  (void)state;
  rng r = rng_of(8, 5, 0);
  for (int k = -20; k <= 20; k++) {
    float scale = num_exp2((float)k);
    arena mem = {0};
    solid s = solid_cube(&mem);
    solid_place(&s, scale, (vec3){0, 0, 0});
    scene w = solid_scene(&s, false);
    bvh tree = solid_tree(&s, &mem);
    for (long i = 0; i < shorter(5000); i++) {
      hit h = random_hit(&r, 12);
      surface at = surface_at(&w, &h, (vec3){0, 0, -1});
      vec3 inside = vec3_scale(random_vector(&r), scale * (1 - 0x1p-16f));
      ray q = surface_ray_to(&at, inside, false);
      assert_true(q.tmax < 1);
      vec3 off = vec3_sub(vec3_add(q.o, q.d), inside);
      assert_true(vec3_peak(vec3_abs(off)) <= 0x1p-22f * scale);
      assert_false(bvh_any(&tree, &q));
      vec3 outside = vec3_scale(random_direction(&r), 2 * scale);
      q = surface_ray_to(&at, outside, false);
      bool behind = vec3_dot(vec3_sub(outside, at.p), at.ng) <= 0;
      assert_int_equal(bvh_any(&tree, &q), behind);
    }
    arena_free(&mem);
  }
}

// surface_keep_side leaves good directions alone and moves the others by no
// more than it takes, on both sides and from both sides.
static void directions_keep_their_side(void **state) {
  (void)state;
  arena mem = {0};
  solid s = solid_tetrahedron(&mem);
  scene w = solid_scene(&s, false);
  rng r = rng_of(8, 6, 0);
  for (long i = 0; i < shorter(100000); i++) {
    hit h = random_hit(&r, 4);
    vec3 d = random_direction(&r), wi = random_direction(&r);
    surface at = surface_at(&w, &h, d);
    assert_int_equal(at.front, vec3_dot(d, at.ng) <= 0);
    for (int transmitted = 0; transmitted < 2; transmitted++) {
      float side = (at.front ? 1.0f : -1.0f) * (transmitted ? -1.0f : 1.0f);
      vec3 kept = surface_keep_side(&at, wi, transmitted);
      float cos_i = side * vec3_dot(wi, at.ng);
      assert_true(side * vec3_dot(kept, at.ng) > 0);
      vec3 moved = vec3_sub(kept, wi);
      if (cos_i > 0) assert_true(vec3_dot(moved, moved) == 0);
      // A direction below the plane by a little is moved by that little.
      if (cos_i > -0.01f && cos_i <= 0)
        assert_true(vec3_length(moved) < 0x1p-18f - 1.01f * cos_i);
    }
  }
  arena_free(&mem);
}

// Colours and the triangle's number come through; without materials and
// texture coordinates there are none.
static void attributes_come_through(void **state) {
  (void)state;
  arena mem = {0};
  solid s = solid_tetrahedron(&mem);
  scene w = solid_scene(&s, false);
  vec3 colors[4] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  hit h = {.t = 1, .b1 = 0.25f, .b2 = 0.5f, .triangle = 2};
  surface at = surface_at(&w, &h, (vec3){0, 0, -1});
  assert_true(at.color.x == 1 && at.color.y == 1 && at.color.z == 1);
  assert_null(at.material);
  assert_int_equal(at.triangle, 2);
  assert_false(at.smooth);
  w.mesh.colors = colors;
  at = surface_at(&w, &h, (vec3){0, 0, -1});
  vec3 sum = {0, 0, 0};
  for (size_t k = 0; k < 3; k++) {
    float b = k == 0 ? 0.25f : k == 1 ? 0.25f : 0.5f;
    sum = vec3_mad(sum, b, colors[s.index[6 + k]]);
  }
  assert_true(vec3_length(vec3_sub(sum, at.color)) < 1e-6f);
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(point_error_is_a_bound),
      cmocka_unit_test(facet_normals_are_exact),
      cmocka_unit_test(rays_neither_stick_nor_leak),
      cmocka_unit_test(paths_stay_inside),
      cmocka_unit_test(shadow_rays_end_at_the_light),
      cmocka_unit_test(directions_keep_their_side),
      cmocka_unit_test(attributes_come_through),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
