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
  rough_terms s = {.f0 = vec3_all(0.04f), .alpha = alpha};
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

// Directions of the facet normals that D is integrated over: the squared
// tangent a^2 x / (1 - x) for x in steps of 1 / n, whatever a is.
static double tangent2(double x, double alpha) {
  return alpha * alpha * x / (1 - x);
}

// The density of facet normals, D nh, integrates to 1 from the smallest
// roughness to the largest: in the variable x it is constant.
static void d_is_a_density(void **state) {
  (void)state;
  const int n = 20000;
  for (int i = 1; i <= 40; i++) {
    float roughness = fmaxf(1e-3f, (float)(i * i) / 1600);
    double alpha = (double)(roughness * roughness), sum = 0;
    for (int k = 0; k < n; k++) {
      double x = (k + 0.5) / n, t2 = tangent2(x, alpha);
      double c2 = 1 / (1 + t2), s2 = t2 * c2;
      double d = (double)ggx_d((float)s2, (float)sqrt(c2), (float)alpha);
      double dt2 = alpha * alpha / ((1 - x) * (1 - x)) / n;
      sum += d * c2 * c2 * dt2 * TURN / 2;
    }
    assert_true(fabs(sum - 1) < 1e-5);
  }
}

// What the viewer sees of all facets is what he would see of the flat surface:
// the integral of G1 D max(0, wo.h) is nv.  It ties G1 to D.
static void masking_matches_d(void **state) {
  (void)state;
  const int n = shortened(1000);
  for (float nv = 0.1f; nv <= 1; nv += 0.3f)
    for (float roughness = 0.2f; roughness <= 1; roughness += 0.2f) {
      double alpha = (double)(roughness * roughness), sum = 0;
      double sine = sqrt(1 - (double)nv * (double)nv);
      for (int i = 0; i < n * n; i++) {
        double y = (i / n + 0.5) / n, phi = TURN * (i % n + 0.5) / n;
        double tangent = sqrt(tangent2(1 - y * y, alpha));
        double seen = sine * tangent * cos(phi) + (double)nv;  // wo.h / nh
        sum += fmax(seen, 0) * 2 * y / n / n;  // D nh dh is dx dphi / 2 pi
      }
      double g1_over_nv = 4 * (double)ggx_g1_over_4nv(nv, (float)alpha);
      assert_true(fabs(sum * g1_over_nv - 1) < (n > 500 ? 1e-4 : 0.01));
    }
}

// Light and viewer may change places: the same bits.
static void reciprocity(void **state) {
  (void)state;
  rng r = rng_of(5, 0, 0);
  for (int i = 0; i < 20000; i++) {
    vec3 wo = at_angle(rng_next(&r), rng_next(&r));
    vec3 wi = at_angle(rng_next(&r), rng_next(&r));
    float roughness = rng_next(&r), e1 = rng_next(&r), e2 = rng_next(&r);
    rough_terms s = {.model = i % 2 ? PBR_GGX : PBR_REPORT, .e_mean = 0.5f};
    s.f0 = s.kd = (vec3){0.04f, 0.5f, 0.9f};
    s.alpha = roughness * roughness;
    s.k = schlick_k_point(roughness);
    half_angles a = half_angles_of((vec3){0, 0, 1}, wo, wi);
    half_angles b = half_angles_of((vec3){0, 0, 1}, wi, wo);
    vec3 f = rough_specular(&s, a), g = rough_specular(&s, b);
    assert_memory_equal(&f, &g, sizeof f);
    f = rough_diffuse(&s, a, e1, e2), g = rough_diffuse(&s, b, e2, e1);
    assert_true(vec3_length(vec3_sub(f, g)) <= 1e-6f * vec3_length(f));
  }
}

// The report's formulas as it prints them, less its errata, in double.
static void report_as_corrected(void **state) {
  (void)state;
  rng r = rng_of(6, 0, 0);
  for (int i = 0; i < 20000; i++) {
    vec3 wo = at_angle(0.01f + 0.99f * rng_next(&r), rng_next(&r));
    vec3 wi = at_angle(0.01f + 0.99f * rng_next(&r), rng_next(&r));
    float roughness = 0.05f + 0.95f * rng_next(&r), m = rng_next(&r);
    const float c = 0.7f;
    rough_terms s = {.model = PBR_REPORT, .f0 = metal_rough_f0(vec3_all(c), m)};
    s.kd = vec3_all((1 - m) * c);
    s.alpha = roughness * roughness;
    s.k = schlick_k_point(roughness);
    half_angles a = half_angles_of((vec3){0, 0, 1}, wo, wi);
    double nl = (double)wi.z, nv = (double)wo.z, rr = (double)roughness;
    double k = (rr + 1) * (rr + 1) / 8;
    double g = nl / (nl * (1 - k) + k) * nv / (nv * (1 - k) + k);
    exact e = exact_terms(wo, wi, roughness, s.f0.x);
    double specular = (double)(e.d * e.f) * g / (4 * nl * nv);
    double diffuse = (1 - (double)e.f) * (1 - (double)m) * (double)c * 2 / TURN;
    double got_s = (double)rough_specular(&s, a).x;
    double got_d = (double)rough_diffuse(&s, a, 0, 0).x;
    assert_true(fabs(got_s - specular) <= 2e-5 * specular);
    assert_true(fabs(got_d - diffuse) <= 2e-6);
    assert_true((double)schlick_k_env(roughness) - rr * rr / 2 < 1e-7);
  }
}

// Nothing is negative, infinite or no number, at the ends of all ranges and in
// combinations of them, opposite directions and roughness 0 among them.
static void finite_everywhere(void **state) {
  (void)state;
  const float ends[9] = {0,     1e-45f, 1e-30f,     1e-12f, 1e-6f,
                         1e-3f, 0.5f,   0.9999999f, 1};
  for (int i = 0; i < 9 * 9 * 9 * 4; i++) {
    float roughness = ends[i % 9];
    vec3 wo = at_angle(ends[i / 9 % 9], 0);
    vec3 wi = at_angle(ends[i / 81 % 9], (float)(i / 729) / 6);
    half_angles a = half_angles_of((vec3){0, 0, 1}, wo, wi);
    for (int model = PBR_GGX; model <= PBR_REPORT; model++) {
      rough_terms s = {.model = (pbr_model)model, .e_mean = 0.1f};
      s.f0 = (vec3){0, 0.04f, 1};
      s.kd = vec3_all(1);
      s.alpha = roughness * roughness;
      s.k = schlick_k_env(roughness);
      vec3 f = rough_specular(&s, a), d = rough_diffuse(&s, a, 0.3f, 0.4f);
      assert_true(vec3_finite(f) && vec3_finite(vec3_scale(f, a.nl)));
      assert_true(f.x >= 0 && f.y >= 0 && f.z >= 0 && vec3_finite(d));
      assert_true(d.x >= 0 && d.y >= 0 && d.z >= -1e-6f);
      assert_true(s.alpha >= ALPHA_MIN || vec3_peak(f) == 0);
    }
  }
}

// F is F0 facing the mirror and 1 along it; F0 goes from 0.04 to the colour.
static void ends_of_fresnel(void **state) {
  (void)state;
  vec3 c = {0.9f, 0.5f, 0.04f};
  assert_float_equal(fresnel_schlick(c, 1).x, 0.9f, 0);
  assert_float_equal(fresnel_schlick(c, 0).z, 1, 0);
  assert_float_equal(fresnel_schlick(c, 0.5f).y, 0.5f + 0.5f / 32, 1e-7);
  assert_float_equal(metal_rough_f0(c, 0).x, 0.04f, 0);
  assert_float_equal(metal_rough_f0(c, 1).y, 0.5f, 0);
  assert_float_equal(metal_rough_f0(c, 0.5f).x, 0.47f, 1e-7);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(terms_are_accurate),
      cmocka_unit_test(d_is_a_density),
      cmocka_unit_test(masking_matches_d),
      cmocka_unit_test(reciprocity),
      cmocka_unit_test(report_as_corrected),
      cmocka_unit_test(finite_everywhere),
      cmocka_unit_test(ends_of_fresnel),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
