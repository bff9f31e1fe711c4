// test_microfacet.c — laws of the terms of rough surfaces.

#include "microfacet.h"
#include "num.h"
#include "rng.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// n, or a fiftieth of it under the sanitizers.
static int shortened(int n) {
  return getenv("FACET_QUICK") != NULL ? n / 50 + 1 : n;
}

static const double TURN = 6.283185307179586;

static vec3 at_angle(float cos_theta, float turns) {
  vec2 c = num_circle(turns);
  float s = sqrtf(1 - cos_theta * cos_theta);
  return (vec3){s * c.x, s * c.y, cos_theta};
}

// The terms in long double, from the same floats.
typedef struct exact {
  long double d, v, f;
} exact;

// h from the sum of the two vectors, D in its textbook form, V by Smith's
// lambda, F by the fifth power.
static exact exact_terms(vec3 wo, vec3 wi, float roughness, float f0) {
  long double a = (long double)roughness * (long double)roughness, a2 = a * a;
  long double x = (long double)wo.x + (long double)wi.x;
  long double y = (long double)wo.y + (long double)wi.y;
  long double z = (long double)wo.z + (long double)wi.z;
  long double length = sqrtl(x * x + y * y + z * z);
  long double tan2 = (x * x + y * y) / (z * z), c2 = z * z / (length * length);
  long double pi = (long double)TURN / 2, s = a2 + tan2;
  long double nl = (long double)wi.z, nv = (long double)wo.z;
  long double lv = sqrtl(1 + a2 * (1 / (nv * nv) - 1));
  long double ll = sqrtl(1 + a2 * (1 / (nl * nl) - 1));
  long double oh = length / 2;
  exact e = {.d = a2 / (pi * c2 * c2 * s * s)};
  e.v = 2 / (lv + ll) / (4 * nl * nv);
  e.f = (long double)f0 + (1 - (long double)f0) * powl(1 - oh, 5);
  return e;
}

// Errors, to be sorted.
typedef struct errors {
  double *all;
  size_t count, room;
} errors;

static void note(errors *e, double got, long double want) {
  assert_true(isfinite(got) && e->count < e->room);
  e->all[e->count++] = fabs((double)(((long double)got - want) / want));
}

static int by_size(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

// Pairs of directions that a grid of cosines and azimuths makes; both in the
// mirror direction and away from it.
enum { COSINES = 24, AZIMUTHS = 9 };

static float grid_cosine(int i) {
  float x = ((float)i + 1) / COSINES;
  return x * x;
}

static float grid_azimuth(int i) {
  static const float turns[AZIMUTHS] = {0,      0.1f,    0.25f,    0.4f, 0.49f,
                                        0.499f, 0.4999f, 0.49999f, 0.5f};
  return turns[i];
}

static void terms_at(errors e[4], float roughness, vec3 wo, vec3 wi) {
  half_angles a = half_angles_of((vec3){0, 0, 1}, wo, wi);
  exact want = exact_terms(wo, wi, roughness, 0.04f);
  float alpha = roughness * roughness;
  double d = (double)ggx_d(a.t, a.nh, alpha);
  double v = (double)ggx_v(a.nl, a.nv, alpha);
  rough s = {.f0 = vec3_all(0.04f), .alpha = alpha};
  note(&e[0], d, want.d);
  note(&e[1], v, want.v);
  note(&e[2], (double)fresnel_schlick(s.f0, a.oh).x, want.f);
  note(&e[3], (double)rough_specular(&s, a).x, want.d * want.v * want.f);
}

// The 90th percentile of the relative error of D, V, F and their product is at
// most 2e-6 and the largest 1e-3, for roughness 0.001 to 1 and all cosines.
static void terms_are_accurate(void **state) {
  (void)state;
  const char *name[4] = {"D", "V", "F", "D V F"};
  const int steps = shortened(100);
  errors e[4];
  for (int k = 0; k < 4; k++) {
    e[k].room = (size_t)(steps + 1) * COSINES * COSINES * AZIMUTHS;
    e[k].count = 0;
    e[k].all = malloc(e[k].room * sizeof *e[k].all);
  }
  for (int r = 0; r <= steps; r++) {
    float x = (float)r / (float)steps, roughness = fmaxf(x * x, 1e-3f);
    for (int i = 0; i < COSINES * COSINES; i++)
      for (int k = 0; k < AZIMUTHS; k++) {
        vec3 wo = at_angle(grid_cosine(i / COSINES), 0);
        vec3 wi = at_angle(grid_cosine(i % COSINES), grid_azimuth(k));
        terms_at(e, roughness, wo, wi);
      }
  }
  for (int k = 0; k < 4; k++) {
    qsort(e[k].all, e[k].count, sizeof *e[k].all, by_size);
    double p90 = e[k].all[e[k].count * 9 / 10],
           worst = e[k].all[e[k].count - 1];
    print_message("# %-5s p90 %.1e, max %.1e\n", name[k], p90, worst);
    assert_true(p90 <= 2e-6 && worst <= 1e-3);
    free(e[k].all);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(terms_are_accurate),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
