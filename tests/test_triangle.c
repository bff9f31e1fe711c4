// test_triangle.c — rays and triangles: no leaks, no ghosts, no crashes.

#include "triangle.h"

#include "shapes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

#include <cmocka.h>

// A loop of n turns, or a fiftieth of them under the sanitizers.
static uint32_t turns(uint32_t n) {
  return getenv("FACET_QUICK") == NULL ? n : n / 50 + 1;
}

// Whether r meets any triangle of s.
static bool meets(const shape *s, const ray *r) {
  ray_shear shear = ray_shear_of(r->d);
  hit h;
  for (uint32_t t = 0; t < s->triangles; t++) {
    const uint32_t *v = s->index + 3 * (size_t)t;
    if (triangle_hit(r, &shear, s->positions[v[0]], s->positions[v[1]],
                     s->positions[v[2]], &h))
      return true;
  }
  return false;
}

// The test that most renderers use, in float, for comparison.  Source: Moller
// and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997.
static bool moller_trumbore(const ray *r, vec3 p0, vec3 p1, vec3 p2) {
  vec3 e1 = vec3_sub(p1, p0), e2 = vec3_sub(p2, p0);
  vec3 p = vec3_cross(r->d, e2), s = vec3_sub(r->o, p0);
  float det = vec3_dot(e1, p);
  if (det == 0) return false;
  float b1 = vec3_dot(s, p) / det;
  vec3 q = vec3_cross(s, e1);
  float b2 = vec3_dot(r->d, q) / det;
  return b1 >= 0 && b2 >= 0 && b1 + b2 <= 1 && vec3_dot(e2, q) / det > 0;
}

static bool moller_trumbore_meets(const shape *s, const ray *r) {
  for (uint32_t t = 0; t < s->triangles; t++) {
    const uint32_t *v = s->index + 3 * (size_t)t;
    if (moller_trumbore(r, s->positions[v[0]], s->positions[v[1]],
                        s->positions[v[2]]))
      return true;
  }
  return false;
}

// The cube -1..1, two triangles a face.
static shape cube(arena *mem) {
  shape s = shape_new(mem, "cube", 8, 12);
  for (int i = 0; i < 8; i++)
    shape_vertex(&s, (vec3){i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1});
  static const uint32_t quad[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                      {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (int i = 0; i < 6; i++) {
    shape_triangle(&s, quad[i][0], quad[i][1], quad[i][2]);
    shape_triangle(&s, quad[i][0], quad[i][2], quad[i][3]);
  }
  return s;
}

// A tube along z of n sides, 2 long, with a radius and two pointed caps.
static shape tube(arena *mem, uint32_t n, float radius) {
  shape s = shape_new(mem, "tube", 2 * n + 2, 4 * n);
  for (uint32_t i = 0; i < 2 * n; i++) {
    double a = 6.283185307 * (i / 2) / n;
    float z = i % 2 ? 1 : -1;
    shape_vertex(&s, (vec3){radius * (float)cos(a), radius * (float)sin(a), z});
  }
  uint32_t low = shape_vertex(&s, (vec3){0, 0, -1.1f});
  uint32_t high = shape_vertex(&s, (vec3){0, 0, 1.1f});
  for (uint32_t i = 0; i < n; i++) {
    uint32_t a = 2 * i, b = 2 * ((i + 1) % n);
    shape_triangle(&s, a, b, b + 1);
    shape_triangle(&s, a, b + 1, a + 1);
    shape_triangle(&s, low, b, a);
    shape_triangle(&s, high, a + 1, b + 1);
  }
  return s;
}

// A point inside a convex shape: between its middle and a random vertex.
static vec3 inside(const shape *s, vec3 middle, uint64_t *random) {
  float share = 0.9f * shape_random(random);
  uint32_t v = (uint32_t)(shape_random(random) * (float)s->vertices);
  return vec3_lerp(middle, s->positions[v], share);
}

// A ray from inside through a random vertex, or a random point of an edge.
static ray ray_at(const shape *s, vec3 middle, bool vertex, uint64_t *random) {
  uint32_t t = (uint32_t)(shape_random(random) * (float)s->triangles);
  uint32_t k = (uint32_t)(shape_random(random) * 3);
  const uint32_t *v = s->index + 3 * (size_t)t;
  vec3 a = s->positions[v[k]], b = s->positions[v[(k + 1) % 3]];
  vec3 at = vertex ? a : vec3_lerp(a, b, shape_random(random));
  vec3 o = inside(s, middle, random);
  return ray_from(o, vec3_sub(at, o));
}

// How many of n rays, half of them through vertices, leave the closed s.
static uint32_t leaks(const shape *s, uint32_t n, bool by_moller_trumbore) {
  uint64_t random = 88172645463325252;
  vec3 lo = s->positions[0], hi = lo;
  for (uint32_t i = 0; i < s->vertices; i++) {
    lo = vec3_min(lo, s->positions[i]);
    hi = vec3_max(hi, s->positions[i]);
  }
  vec3 middle = vec3_lerp(lo, hi, 0.5f);
  uint32_t misses = 0;
  for (uint32_t i = 0; i < n; i++) {
    ray r = ray_at(s, middle, i % 2 == 0, &random);
    misses +=
        by_moller_trumbore ? !moller_trumbore_meets(s, &r) : !meets(s, &r);
  }
  return misses;
}

// A ray from inside a closed convex mesh hits it, also exactly through edges
// and vertices, whatever the proportions, the size and the place.
static void closed_meshes_do_not_leak(void **state) {
  (void)state;
  arena mem = {0};
  vec3 none = vec3_all(0);
  const shape shapes[] = {
      cube(&mem),
      shape_sphere(&mem, 2),
      tube(&mem, 7, 1e-7f),
      shape_moved(shape_sphere(&mem, 2), "disc", (vec3){1, 1, 1e-7f}, none),
      shape_moved(shape_sphere(&mem, 2), "needle", (vec3){1, 1, 1e7f}, none),
      shape_moved(cube(&mem), "far cube", vec3_all(100), (vec3){1e6f, 1e6f, 0}),
      shape_moved(shape_sphere(&mem, 3), "far", vec3_all(100),
                  (vec3){1e6f, -1e6f, 1e6f}),
      shape_moved(shape_sphere(&mem, 2), "tiny", vec3_all(1e-6f), none),
      shape_moved(shape_sphere(&mem, 2), "1e-18", vec3_all(1e-18f), none),
      shape_moved(shape_sphere(&mem, 2), "1e18", vec3_all(1e18f), none),
  };
  for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
    uint32_t n = leaks(&shapes[i], turns(300000), false);
    if (n > 0) print_message("# %s: %u rays leave\n", shapes[i].name, n);
    assert_int_equal(n, 0);
  }
  arena_free(&mem);
}

// The same rays do find the leaks of the usual test: the law above is not
// empty.
static void moller_trumbore_leaks(void **state) {
  (void)state;
  arena mem = {0};
  shape s = shape_sphere(&mem, 2);
  assert_true(leaks(&s, 20000, true) > 100);
  arena_free(&mem);
}

// Double precision, from exact differences: the distance and the three
// barycentric weights, not yet tested for sign.
static void reference(const ray *r, const vec3 p[3], double out[4]) {
  double e1[3] = {(double)p[1].x - (double)p[0].x,
                  (double)p[1].y - (double)p[0].y,
                  (double)p[1].z - (double)p[0].z};
  double e2[3] = {(double)p[2].x - (double)p[0].x,
                  (double)p[2].y - (double)p[0].y,
                  (double)p[2].z - (double)p[0].z};
  double s[3] = {(double)r->o.x - (double)p[0].x,
                 (double)r->o.y - (double)p[0].y,
                 (double)r->o.z - (double)p[0].z};
  double d[3] = {(double)r->d.x, (double)r->d.y, (double)r->d.z};
  double n[3], q[3], det = 0, t = 0, b1 = 0, b2 = 0;
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    n[i] = d[j] * e2[k] - d[k] * e2[j];
    q[i] = s[j] * e1[k] - s[k] * e1[j];
  }
  for (int i = 0; i < 3; i++) {
    det += e1[i] * n[i];
    b1 += s[i] * n[i];
    b2 += d[i] * q[i];
    t += e2[i] * q[i];
  }
  out[0] = t / det;
  out[1] = 1 - (b1 + b2) / det;
  out[2] = b1 / det;
  out[3] = b2 / det;
}

// Away from edges and from t = 0 the answer is that of double precision, for
// both sides of the triangle.
static void agrees_with_doubles(void **state) {
  (void)state;
  uint64_t random = 12345;
  uint32_t hits = 0, compared = 0;
  for (uint32_t i = 0; i < turns(1000000); i++) {
    vec3 p[3];
    for (int k = 0; k < 3; k++)
      p[k] = vec3_scale(shape_point(&random), 2);
    ray r = ray_from(shape_point(&random), shape_point(&random));
    double ref[4];
    reference(&r, p, ref);
    double least = fmin(ref[1], fmin(ref[2], ref[3]));
    if (fabs(least) < 1e-3 || fabs(ref[0]) < 1e-3 || fabs(ref[0]) > 1e3)
      continue;
    ray_shear shear = ray_shear_of(r.d);
    hit h = {.triangle = 77};
    bool got = triangle_hit(&r, &shear, p[0], p[1], p[2], &h);
    assert_int_equal(got, least > 0 && ref[0] > 0);
    compared++;
    if (!got) continue;
    hits++;
    // The condition of grazing triangles is bounded by the filter above only
    // roughly; 1e-3 of a distance is far beyond any rounding seen.
    assert_true(fabs((double)h.t - ref[0]) <= 1e-3 * fmax(ref[0], 1));
    assert_true(fabs((double)h.b1 - ref[2]) <= 2e-3);
    assert_true(fabs((double)h.b2 - ref[3]) <= 2e-3);
    assert_int_equal(h.triangle, 77);
  }
  assert_true(hits > compared / 50);
}

// Both ends of tmin <= t <= tmax count, but t = 0 never does.
static void ends_of_the_ray_count(void **state) {
  (void)state;
  const vec3 a = {0, 0, 0}, b = {1, 0, 0}, c = {0, 1, 0};
  ray r = {{0.25f, 0.25f, 4}, {0, 0, -2}, 0, 2};
  ray_shear s = ray_shear_of(r.d);
  hit h;
  assert_true(triangle_hit(&r, &s, a, b, c, &h));
  assert_true(h.t == 2 && h.b1 == 0.25f && h.b2 == 0.25f);
  assert_true(triangle_hit(&r, &s, c, b, a, &h));
  r.tmax = nextafterf(2, 0);
  assert_false(triangle_hit(&r, &s, a, b, c, &h));
  r.tmin = 2, r.tmax = INFINITY;
  assert_true(triangle_hit(&r, &s, a, b, c, &h));
  r.tmin = nextafterf(2, 3);
  assert_false(triangle_hit(&r, &s, a, b, c, &h));
  r.tmin = 0, r.o.z = 0;
  assert_false(triangle_hit(&r, &s, a, b, c, &h));
}

// A ray that starts in a corner of a triangle does not meet that triangle,
// in whatever direction it goes.
static void no_hit_where_the_ray_starts(void **state) {
  (void)state;
  uint64_t random = 4242;
  for (uint32_t i = 0; i < turns(500000); i++) {
    vec3 p[3], move = vec3_scale(shape_point(&random), 1000);
    for (int k = 0; k < 3; k++)
      p[k] = vec3_add(move, shape_point(&random));
    ray r = ray_from(p[i % 3], shape_point(&random));
    ray_shear s = ray_shear_of(r.d);
    hit h;
    assert_false(triangle_hit(&r, &s, p[0], p[1], p[2], &h));
  }
}

// A ray that starts very close to the inside of a triangle hits it when it
// runs towards it and does not when it runs away: the side is the true one.
static void near_starts_know_their_side(void **state) {
  (void)state;
  uint64_t random = 99;
  uint32_t hits = 0, near = 0;
  for (uint32_t i = 0; i < turns(500000); i++) {
    vec3 p[3];
    for (int k = 0; k < 3; k++)
      p[k] = shape_point(&random);
    float b1 = 0.1f + 0.4f * shape_random(&random), b2 = 0.2f;
    vec3 o = vec3_mad(vec3_mad(p[0], b1, vec3_sub(p[1], p[0])), b2,
                      vec3_sub(p[2], p[0]));
    o = vec3_mad(o, 1e-6f * shape_random(&random), shape_point(&random));
    ray r = ray_from(o, shape_point(&random));
    double ref[4];
    reference(&r, p, ref);
    if (fmin(ref[1], fmin(ref[2], ref[3])) < 0.01) continue;
    ray_shear s = ray_shear_of(r.d);
    hit h;
    bool got = triangle_hit(&r, &s, p[0], p[1], p[2], &h);
    if (fabs(ref[0]) > 1e-12) assert_int_equal(got, ref[0] > 0);
    near++;
    if (got) hits++;
    if (got) assert_true(h.t > 0);
  }
  assert_true(hits > near / 4 && hits < near - near / 4);
}

// Whatever numbers a ray and a triangle are made of, a hit has finite t, b1
// and b2 in range; not-a-number in the ray hits nothing.
static void strange_numbers_are_harmless(void **state) {
  (void)state;
  const float odd[] = {0,    -0.0f,    1,         -1,      FLT_MAX, -FLT_MAX,
                       NAN,  INFINITY, -INFINITY, FLT_MIN, 1e-45f,  -1e-45f,
                       0.5f, 1e30f,    1e-30f,    3};
  uint64_t random = 7;
  uint32_t hits = 0;
  for (uint32_t i = 0; i < turns(2000000); i++) {
    float v[15];
    for (int k = 0; k < 15; k++)
      v[k] = odd[(int)(shape_random(&random) * 16)];
    ray r = ray_from((vec3){v[0], v[1], v[2]}, (vec3){v[3], v[4], v[5]});
    ray_shear s = ray_shear_of(r.d);
    hit h;
    if (!triangle_hit(&r, &s, (vec3){v[6], v[7], v[8]},
                      (vec3){v[9], v[10], v[11]}, (vec3){v[12], v[13], v[14]},
                      &h))
      continue;
    hits++;
    assert_true(isfinite(h.t) && h.t > 0);
    assert_true(h.b1 >= 0 && h.b1 <= 1 && h.b2 >= 0 && h.b2 <= 1);
    assert_true(vec3_finite(r.o) && vec3_finite(r.d));
  }
  assert_true(hits > 0);
}

// The sign of a zero, and a denormal component, change nothing.
static void zeros_are_zeros(void **state) {
  (void)state;
  const vec3 a = {-1, -1, -3}, b = {1, -1, -3}, c = {0, 1, -3};
  const float zeros[] = {0, -0.0f, 1e-45f, -1e-45f, 1e-39f};
  for (int i = 0; i < 25; i++) {
    ray r = ray_from(vec3_all(0), (vec3){zeros[i % 5], zeros[i / 5], -1});
    ray_shear s = ray_shear_of(r.d);
    hit h;
    assert_true(triangle_hit(&r, &s, a, b, c, &h));
    assert_true(h.t == 3 && h.b1 == 0.25f && h.b2 == 0.5f);
    assert_true(s.sx == 0 && s.sy == 0);
  }
}

// Along z nothing is sheared, so that the exact answer is known: a ray meets
// the triangle if the origin of the xy plane is inside or on its outline, by
// signs of differences of exact products.  Edges pass as near as floats can.
static void edges_are_decided_exactly(void **state) {
  (void)state;
  uint64_t random = 77;
  uint32_t hits = 0, zero_in_float = 0;
  for (uint32_t i = 0; i < turns(1000000); i++) {
    vec3 p[3];
    for (int k = 0; k < 3; k++)
      p[k] = shape_point(&random);
    p[1] = vec3_scale(p[0], -0.1f - shape_random(&random));
    for (int k = 0; k < 3; k++)
      p[k].z = 1;
    double e[3];
    for (int k = 0; k < 3; k++) {
      vec3 a = p[(k + 1) % 3], b = p[(k + 2) % 3];
      e[k] = (double)b.x * (double)a.y - (double)b.y * (double)a.x;
      zero_in_float += e[k] != 0 && b.x * a.y - b.y * a.x == 0;
    }
    bool up = e[0] >= 0 && e[1] >= 0 && e[2] >= 0;
    bool down = e[0] <= 0 && e[1] <= 0 && e[2] <= 0;
    ray r = ray_from(vec3_all(0), (vec3){0, 0, 1});
    ray_shear s = ray_shear_of(r.d);
    hit h;
    assert_int_equal(triangle_hit(&r, &s, p[0], p[1], p[2], &h), up || down);
    hits += up || down;
  }
  assert_true(hits > turns(1000000) / 10 && zero_in_float > hits / 100);
}

// Triangles so small that products of their coordinates are denormal are hit
// at the right place.
static void small_triangles_keep_their_digits(void **state) {
  (void)state;
  const float size[] = {1e-15f, 1e-19f, 1e-21f, 1e-23f};
  for (int i = 0; i < 4; i++) {
    const vec3 a = {-size[i], -size[i], -1}, b = {3 * size[i], 0, -1};
    const vec3 c = {0, 2 * size[i], -1};
    ray r = ray_from(vec3_all(0), (vec3){0, 0, -1});
    ray_shear s = ray_shear_of(r.d);
    hit h;
    assert_true(triangle_hit(&r, &s, a, b, c, &h));
    assert_true(fabsf(h.t - 1) < 1e-6f);
    assert_true(fabsf(h.b1 - 2.0f / 11) < 1e-6f);
    assert_true(fabsf(h.b2 - 3.0f / 11) < 1e-6f);
  }
}

// A triangle without area is never hit, not even along it.
static void degenerate_triangles_are_not_hit(void **state) {
  (void)state;
  uint64_t random = 31;
  for (uint32_t i = 0; i < turns(200000); i++) {
    vec3 a = shape_point(&random);
    // Multiples of 1/8, so that the three points are exactly on a line.
    vec3 e = {floorf(8 * a.x) / 8, floorf(8 * a.y) / 8, floorf(8 * a.z) / 8};
    vec3 p = {1, 2, 4}, q = vec3_add(p, e), m = vec3_mad(p, 0.5f, e);
    vec3 o = shape_point(&random);
    vec3 to = i % 2 ? m : vec3_lerp(p, q, shape_random(&random));
    ray r = ray_from(i % 3 ? o : vec3_sub(p, e), vec3_sub(to, o));
    ray_shear s = ray_shear_of(r.d);
    hit h;
    assert_false(triangle_hit(&r, &s, p, m, q, &h));
    assert_false(triangle_hit(&r, &s, p, q, p, &h));
    assert_false(triangle_hit(&r, &s, p, p, p, &h));
  }
}

// The order of the corners does not decide whether there is a hit.
static void corner_order_does_not_matter(void **state) {
  (void)state;
  uint64_t random = 5;
  for (uint32_t i = 0; i < turns(200000); i++) {
    vec3 p[3];
    for (int k = 0; k < 3; k++)
      p[k] = shape_point(&random);
    vec3 o = shape_point(&random);
    vec3 to = i % 2 ? vec3_lerp(p[0], p[1], shape_random(&random)) : p[2];
    ray r = ray_from(o, vec3_sub(to, o));
    ray_shear s = ray_shear_of(r.d);
    hit h;
    bool first = triangle_hit(&r, &s, p[0], p[1], p[2], &h);
    assert_int_equal(first, triangle_hit(&r, &s, p[1], p[2], p[0], &h));
    assert_int_equal(first, triangle_hit(&r, &s, p[2], p[1], p[0], &h));
    assert_int_equal(first, triangle_hit(&r, &s, p[0], p[2], p[1], &h));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(closed_meshes_do_not_leak),
      cmocka_unit_test(moller_trumbore_leaks),
      cmocka_unit_test(agrees_with_doubles),
      cmocka_unit_test(ends_of_the_ray_count),
      cmocka_unit_test(no_hit_where_the_ray_starts),
      cmocka_unit_test(near_starts_know_their_side),
      cmocka_unit_test(strange_numbers_are_harmless),
      cmocka_unit_test(zeros_are_zeros),
      cmocka_unit_test(edges_are_decided_exactly),
      cmocka_unit_test(small_triangles_keep_their_digits),
      cmocka_unit_test(degenerate_triangles_are_not_hit),
      cmocka_unit_test(corner_order_does_not_matter),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
