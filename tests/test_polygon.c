// test_polygon.c — polygons are cut into n - 2 triangles that cover them.

#include "polygon.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static size_t turns(size_t n) {
  return getenv("FACET_QUICK") == NULL ? n : n / 50 + 1;
}

// A number in [0, 1).
static double random_unit(uint64_t *s) {
  *s ^= *s << 13;
  *s ^= *s >> 7;
  *s ^= *s << 17;
  return (double)(*s >> 11) * 0x1p-53;
}

static double triangle_area(vec3 a, vec3 b, vec3 c) {
  double u[3] = {(double)b.x - (double)a.x, (double)b.y - (double)a.y,
                 (double)b.z - (double)a.z};
  double v[3] = {(double)c.x - (double)a.x, (double)c.y - (double)a.y,
                 (double)c.z - (double)a.z};
  double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2];
  double z = u[0] * v[1] - u[1] * v[0];
  return 0.5 * sqrt(x * x + y * y + z * z);
}

// Cut the polygon; check that all corners exist; return the triangles' area.
static double cut_area(const vec3 *p, size_t n, bool *clean) {
  arena mem = {0};
  uint32_t *out = malloc(3 * n * sizeof *out);
  assert_non_null(out);
  *clean = polygon_triangulate(p, n, out, &mem);
  double area = 0;
  for (size_t i = 0; i < n - 2; i++) {
    const uint32_t *t = out + 3 * i;
    assert_true(t[0] < n && t[1] < n && t[2] < n);
    area += triangle_area(p[t[0]], p[t[1]], p[t[2]]);
  }
  free(out);
  arena_free(&mem);
  return area;
}

static double newell_area(const vec3 *p, size_t n) {
  double v[3];
  polygon_newell(p, n, v);
  return 0.5 * sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

// A point of the plane, turned and moved into space by a fixed motion.
static vec3 in_space(double x, double y, int way) {
  if (way == 0) return (vec3){(float)x, (float)y, 0};
  if (way == 1) return (vec3){5, (float)x, (float)y};
  if (way == 2) return (vec3){(float)y, -7, (float)x};
  double u = x, v = 0.6 * y, w = 0.8 * y;
  return (vec3){(float)(0.8 * u - 0.6 * w + 3), (float)(v - 2),
                (float)(0.6 * u + 0.8 * w)};
}

// A simple outline around the origin: radii at random, angles in order.
static void star(vec3 *p, size_t n, int way, uint64_t *s) {
  for (size_t i = 0; i < n; i++) {
    double a = 6.283185307179586 * (double)i / (double)n;
    double r = 0.2 + random_unit(s);
    p[i] = in_space(r * cos(a), r * sin(a), way);
  }
}

// Concave outlines in four planes keep their area: 20,000 of 4 to 60 corners,
// every one within 1e-5.
static void concave_outlines_keep_their_area(void **state) {
  (void)state;
  uint64_t s = 88172645463325252u;
  for (size_t i = turns(20000); i > 0; i--) {
    vec3 p[60];
    size_t n = 4 + (size_t)(random_unit(&s) * 57);
    star(p, n, (int)(i % 4), &s);
    bool clean;
    double area = cut_area(p, n, &clean), wanted = newell_area(p, n);
    assert_true(clean);
    assert_true(fabs(area - wanted) <= 1e-5 * wanted);
  }
}

// A convex polygon is the fan from its first corner: readers of the book's
// hit files count on that order.  Corners on straight edges do not matter.
static void convex_outlines_are_fans(void **state) {
  (void)state;
  arena mem = {0};
  for (int way = 0; way < 4; way++)
    for (size_t n = 3; n < 40; n++) {
      vec3 p[40];
      uint32_t out[3 * 40];
      for (size_t i = 0; i < n; i++) {
        double a = 6.283185307179586 * (double)i / (double)n + 0.1;
        p[i] = in_space(1000 + cos(a), sin(a), way);
      }
      // The last corner halfway between its neighbours: straight, up to
      // the rounding of a coordinate near 1000.
      if (n > 3) p[n - 1] = vec3_scale(vec3_add(p[n - 2], p[0]), 0.5f);
      assert_true(polygon_triangulate(p, n, out, &mem));
      for (uint32_t i = 0; i + 2 < n; i++) {
        assert_int_equal(out[3 * i], 0);
        assert_int_equal(out[3 * i + 1], i + 1);
        assert_int_equal(out[3 * i + 2], i + 2);
      }
    }
  arena_free(&mem);
}

// An outline that is sewn to a hole by an edge that runs twice, from every
// first corner, in every plane: the hole stays open.
static void holes_stay_open(void **state) {
  (void)state;
  static const double X[10] = {0, 3, 3, 0, 0, 1, 1, 2, 2, 1};
  static const double Y[10] = {0, 0, 3, 3, 0, 1, 2, 2, 1, 1};
  for (int way = 0; way < 4; way++)
    for (size_t first = 0; first < 10; first++) {
      vec3 p[10];
      bool clean;
      for (size_t i = 0; i < 10; i++)
        p[i] = in_space(X[(i + first) % 10], Y[(i + first) % 10], way);
      assert_true(fabs(cut_area(p, 10, &clean) - 8) < 1e-4);
      assert_true(clean);
    }
}

// Columns of random heights in whole numbers, with a corner at every unit: most
// corners are straight, and many lie in a line with far ones.
static size_t skyline(vec3 p[64], int way, uint64_t *s) {
  double x[64], y[64];
  size_t n = 0, columns = 2 + (size_t)(random_unit(s) * 8);
  for (size_t i = columns; i-- > 0;) {
    double height = 1 + floor(random_unit(s) * 4);
    x[n] = (double)i + 1, y[n++] = height;
    x[n] = (double)i, y[n++] = height;
  }
  for (size_t i = 0; i <= columns; i++)
    x[n] = (double)i, y[n++] = 0;
  size_t first = (size_t)(random_unit(s) * (double)n);
  for (size_t i = 0; i < n; i++)
    p[i] = in_space(x[(i + first) % n], y[(i + first) % n], way);
  return n;
}

// Skylines keep their area.
static void straight_corners_do_no_harm(void **state) {
  (void)state;
  uint64_t s = 88172645463325252u;
  for (size_t i = turns(20000); i > 0; i--) {
    vec3 p[64];
    size_t n = skyline(p, (int)(i % 4), &s);
    bool clean;
    double area = cut_area(p, n, &clean), wanted = newell_area(p, n);
    assert_true(clean);
    assert_true(fabs(area - wanted) <= 1e-5 * wanted);
  }
}

// Outlines with a hole, both at random, sewn up from the first corner of the
// one to the first of the other: 20,000 in four planes keep their area.
static void random_holes_stay_open(void **state) {
  (void)state;
  uint64_t s = 88172645463325252u;
  for (size_t k = turns(20000); k > 0; k--) {
    vec3 p[64];
    size_t n = 3 + (size_t)(random_unit(&s) * 28), m = 2 * n + 2;
    for (size_t i = 0; i < n; i++) {
      double a = 6.283185307179586 * (double)i / (double)n;
      double inner = 0.1 + 0.8 * random_unit(&s), outer = 1 + random_unit(&s);
      if (n < 6) outer += 3;  // a triangle's sides come near its centre
      p[i] = in_space(outer * cos(a), outer * sin(a), (int)(k % 4));
      p[2 * n + 1 - i] = in_space(inner * cos(a), inner * sin(a), (int)(k % 4));
    }
    // p: outline 0..n-1, its first again; hole backwards, its first again.
    double wanted = newell_area(p, n) - newell_area(p + n + 2, n);
    p[n] = p[0];
    p[n + 1] = p[2 * n + 1];
    bool clean;
    double area = cut_area(p, m, &clean);
    assert_true(clean);
    assert_true(fabs(area - wanted) <= 1e-5 * wanted);
  }
}

// A square with 3 x 3 square holes.  The three of a row are sewn together and
// to the left side; the edges of the seams lie in one line and run twice.
static void many_holes_stay_open(void **state) {
  (void)state;
  for (int way = 0; way < 4; way++)
    for (size_t first = 0; first < 64; first += 5) {
      double x[96] = {0, 7, 7, 0}, y[96] = {0, 0, 7, 7};
      size_t n = 4;
      for (double v = 5; v > 0; v -= 2) {
        x[n] = 0, y[n++] = v;
        for (double u = 1; u < 6; u += 2) {
          x[n] = u, y[n++] = v;
          x[n] = u, y[n++] = v + 1;
          x[n] = u + 1, y[n++] = v + 1;
          x[n] = u + 1, y[n++] = v;
        }
        for (double u = 5; u >= 0; u--)
          x[n] = u, y[n++] = v;
      }
      vec3 p[96];
      bool clean;
      for (size_t i = 0; i < n; i++)
        p[i] = in_space(x[(i + first) % n], y[(i + first) % n], way);
      assert_true(fabs(cut_area(p, n, &clean) - 40) < 1e-3);
      assert_true(clean);
    }
}

// Whatever comes: points at random, on a line, in one place, not finite.  There
// are n - 2 triangles, and what is not clean is said not to be.
static void nonsense_is_cut_all_the_same(void **state) {
  (void)state;
  uint64_t s = 88172645463325252u;
  for (size_t i = 0; i < turns(5000); i++) {
    vec3 p[30];
    size_t n = 5 + (size_t)(random_unit(&s) * 25);
    for (size_t k = 0; k < n; k++) {
      p[k] = (vec3){(float)random_unit(&s), (float)random_unit(&s),
                    (float)random_unit(&s)};
      if (i % 4 == 1) p[k].y = p[k].z = 0;
      if (i % 4 == 2) p[k] = vec3_all(1);
      if (i % 4 == 3 && k == 3) p[k].x = k % 2 ? NAN : INFINITY;
    }
    bool clean;
    cut_area(p, n, &clean);
    if (i % 4 != 0) assert_false(clean);
  }
}

// Outlines of 100,000 corners: a gear, a spiral, a comb, noise.  Each is cut
// within the time of the test, and the first three are covered.
static void large_outlines_are_cut_in_time(void **state) {
  (void)state;
  size_t n = turns(100000) / 2 * 2, h = n / 2;
  vec3 *p = malloc(n * sizeof *p);
  assert_non_null(p);
  uint64_t s = 88172645463325252u;
  for (int shape = 0; shape < 4; shape++) {
    for (size_t i = 0; i < n; i++) {
      size_t k = i < h ? i : n - 1 - i;
      double a = 6.283185307179586 * (double)i / (double)n;
      double turn = 60.0 * (double)k / (double)h, x, y;
      double r =
          shape == 0 ? 1 + 0.1 * (double)(i % 2) : 1 + turn + (i < h ? 1.5 : 0);
      x = r * cos(shape == 0 ? a : turn);
      y = r * sin(shape == 0 ? a : turn);
      if (shape == 2) x = (double)k;
      if (shape == 2) y = (k % 2 ? 500 : -500) + (i < h ? 0 : 1);
      if (shape == 3) x = random_unit(&s);
      if (shape == 3) y = random_unit(&s);
      p[i] = in_space(x, y, 0);
    }
    bool clean;
    double area = cut_area(p, n, &clean), wanted = newell_area(p, n);
    assert_true(clean == (shape < 3));
    if (shape < 3) assert_true(fabs(area - wanted) <= 1e-4 * wanted);
  }
  free(p);
}

// The vector of Newell: a square of side 2 far from the origin has 8 along its
// normal, and turns with the order of its corners.
static void newell_is_twice_the_area(void **state) {
  (void)state;
  const vec3 p[4] = {
      {1e6f, 4, 0}, {1e6f, 4, 2}, {1e6f + 2, 4, 2}, {1e6f + 2, 4, 0}};
  const vec3 q[4] = {p[3], p[2], p[1], p[0]};
  double v[3];
  polygon_newell(p, 4, v);
  assert_true(v[0] == 0 && v[1] == 8 && v[2] == 0);
  polygon_newell(q, 4, v);
  assert_true(v[0] == 0 && v[1] == -8 && v[2] == 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(concave_outlines_keep_their_area),
      cmocka_unit_test(convex_outlines_are_fans),
      cmocka_unit_test(holes_stay_open),
      cmocka_unit_test(straight_corners_do_no_harm),
      cmocka_unit_test(random_holes_stay_open),
      cmocka_unit_test(many_holes_stay_open),
      cmocka_unit_test(nonsense_is_cut_all_the_same),
      cmocka_unit_test(large_outlines_are_cut_in_time),
      cmocka_unit_test(newell_is_twice_the_area),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
