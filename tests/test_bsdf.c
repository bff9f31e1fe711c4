// test_bsdf.c — laws of scattering functions.

#include "bsdf.h"
#include "chi.h"
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
static long shortened(long n) {
  return getenv("FACET_QUICK") != NULL ? n / 50 : n;
}

static vec3 at_angle(float cos_theta, float turns) {
  vec2 c = num_circle(turns);
  float s = sqrtf(1 - cos_theta * cos_theta);
  return (vec3){s * c.x, s * c.y, cos_theta};
}

static bsdf rough(vec3 kd, vec3 ks, float ns) {
  bsdf_kind kind = vec3_peak(ks) > 0 ? BSDF_BLINN_PHONG : BSDF_LAMBERT;
  return (bsdf){.kind = kind, .kd = kd, .ks = ks, .ns = ns};
}

enum { ROWS = 12, COLUMNS = 24, CELLS = ROWS * COLUMNS };

// The integral of the pdf over a cell of equal steps in cos and phi, and over
// all of the hemisphere f cos of the first channel.
static double cell_integral(const bsdf *b, vec3 wo, int row, int column,
                            double *f_cos) {
  const int n = b->ns > 100 ? 96 : 32;  // fine enough for a narrow lobe
  double sum = 0, step = 2 * (double)PI / (double)CELLS / (n * n);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      float z = ((float)row + ((float)i + 0.5f) / (float)n) / ROWS;
      float turns = ((float)column + ((float)j + 0.5f) / (float)n) / COLUMNS;
      vec3 wi = at_angle(z, turns);
      sum += (double)bsdf_pdf(b, wo, wi) * step;
      *f_cos += (double)(bsdf_eval(b, wo, wi).x * wi.z) * step;
    }
  return sum;
}

// What the samples of one bsdf do.
typedef struct counted {
  double cells[CELLS + 1];  // the last: nothing scattered
  double weight, weight2;
} counted;

static counted count_samples(const bsdf *b, vec3 wo, long n, uint64_t seed) {
  counted c = {0};
  for (long k = 0; k < n; k++) {
    rng r = rng_of(seed, 0, (uint64_t)k);
    float u = rng_next(&r), u1 = rng_next(&r), u2 = rng_next(&r);
    bsdf_sample s;
    if (!bsdf_sample_wi(b, wo, u, u1, u2, &s)) {
      c.cells[CELLS]++;
      continue;
    }
    double turns =
        atan2((double)s.wi.y, (double)s.wi.x) / (2 * 3.141592653589793);
    int row = (int)(s.wi.z * ROWS);
    int column = (int)((turns - floor(turns)) * COLUMNS);
    if (row >= ROWS) row = ROWS - 1;
    if (column >= COLUMNS) column = COLUMNS - 1;
    c.cells[row * COLUMNS + column]++;
    c.weight += (double)s.weight.x;
    c.weight2 += (double)s.weight.x * (double)s.weight.x;
  }
  return c;
}

// The probability of counts as far from what is expected as these.
static double fit(const counted *c, const double *expected, long n) {
  double want[CELLS + 1];
  for (int i = 0; i <= CELLS; i++)
    want[i] = expected[i] * (double)n;
  return chi_probability(c->cells, want, CELLS + 1);
}

static void check_sampler(bsdf b, float cos_o, uint64_t seed) {
  vec3 wo = at_angle(cos_o, 0.13f);
  long n = shortened(1000000);
  counted c = count_samples(&b, wo, n, seed);
  double expected[CELLS + 1], all = 0, f_cos = 0;
  for (int i = 0; i < CELLS; i++) {
    expected[i] = cell_integral(&b, wo, i / COLUMNS, i % COLUMNS, &f_cos);
    all += expected[i];
  }
  expected[CELLS] = fmax(1 - all, 0);
  assert_true(all < 1 + 2e-3);
  double p = fit(&c, expected, n);
  double mean = c.weight / (double)n;
  double variance = fmax(c.weight2 / (double)n - mean * mean, 0);
  double z = (mean - f_cos) / sqrt(variance / (double)n + 1e-12);
  print_message("# cos_o %.2f ns %6.0f: p = %.3f, weight %.5f against %.5f, "
                "z = %.1f\n",
                (double)cos_o, (double)b.ns, p, mean, f_cos, z);
  assert_true(p > 1e-3);
  assert_true(fabs(mean - f_cos) < 4 * sqrt(variance / (double)n) + 3e-4);
}

// The directions of every sampler are distributed as its pdf says, and the
// mean of f cos / pdf is the integral of f cos.
static void samples_follow_pdf(void **state) {
  (void)state;
  vec3 kd = {0.4f, 0.3f, 0.2f}, ks = {0.5f, 0.4f, 0.6f}, no = vec3_all(0);
  const float cosines[3] = {0.95f, 0.5f, 0.12f};
  const float exponents[4] = {0, 3, 40, 300};
  uint64_t seed = 1;
  for (int i = 0; i < 3; i++) {
    check_sampler(rough(kd, no, 0), cosines[i], seed++);
    for (int j = 0; j < 4; j++) {
      check_sampler(rough(no, ks, exponents[j]), cosines[i], seed++);
      check_sampler(rough(kd, ks, exponents[j]), cosines[i], seed++);
    }
  }
}

// The pdf integrates to 1, counting what a half vector throws below the
// horizon: that share comes from an integral over half vectors, in double.
static void pdf_integrates_to_one(void **state) {
  (void)state;
  const float exponents[3] = {2, 30, 200};
  const double turn = 6.283185307179586;
  for (int j = 0; j < 3; j++)
    for (float cos_o = 0.1f; cos_o < 1; cos_o += 0.2f) {
      bsdf b = rough(vec3_all(0), vec3_all(1), exponents[j]);
      vec3 wo = at_angle(cos_o, 0);
      double above = 0, ignored = 0;
      for (int i = 0; i < CELLS; i++)
        above += cell_integral(&b, wo, i / COLUMNS, i % COLUMNS, &ignored);
      double below = 0, n = (double)exponents[j];
      const int steps = 500;
      for (int i = 0; i < steps; i++)
        for (int k = 0; k < steps; k++) {
          // Equal shares of (n + 1) / 2 pi cos^n.
          double z = pow((i + 0.5) / steps, 1 / (n + 1));
          double x = sqrt(1 - z * z) * cos(turn * (k + 0.5) / steps);
          double oh = (double)wo.x * x + (double)wo.z * z;
          if (2 * oh * z - (double)wo.z <= 0) below += 1.0 / (steps * steps);
        }
      assert_float_equal((float)(above + below), 1, 1e-3);
    }
}

// f(wo, wi) = f(wi, wo).
static void reciprocity(void **state) {
  (void)state;
  bsdf b = rough((vec3){0.1f, 0.5f, 0.9f}, (vec3){0.9f, 0.4f, 0.1f}, 77);
  rng r = rng_of(7, 0, 0);
  for (int i = 0; i < 10000; i++) {
    vec3 a = at_angle(rng_next(&r), rng_next(&r));
    vec3 c = at_angle(rng_next(&r), rng_next(&r));
    vec3 f = bsdf_eval(&b, a, c), g = bsdf_eval(&b, c, a);
    assert_true(vec3_length(vec3_sub(f, g)) <= 2e-6f * vec3_length(f));
  }
}

// The directional albedo is ks at normal incidence for every exponent (that
// is what the normalisation means), and nowhere more.
static void normalisation(void **state) {
  (void)state;
  for (float ns = 0; ns < 2e6f; ns = 4 * ns + 1) {
    bsdf b = rough(vec3_all(0), vec3_all(1), ns);
    double albedo = 0;
    const int steps = 100000;
    for (int i = 0; i < steps; i++) {
      double x = (i + 0.5) / steps;  // cos = 1 - x^4, finest at the pole
      vec3 wi = at_angle((float)(1 - x * x * x * x), 0.2f);
      double f = (double)bsdf_eval(&b, (vec3){0, 0, 1}, wi).x;
      albedo += f * (double)wi.z * 6.283185307179586 * 4 * x * x * x / steps;
    }
    assert_float_equal((float)albedo, 1, 2e-3);
    for (float z = 0.1f; z < 0.95f && ns < 100; z += 0.2f) {
      albedo = 0;
      for (int i = 0; i < CELLS; i++)
        cell_integral(&b, at_angle(z, 0), i / COLUMNS, i % COLUMNS, &albedo);
      assert_true(albedo < 1.001);
    }
  }
}

// (n.h)^n keeps its relative precision for exponents up to 1e6, where the
// float n.h has lost it: against double precision.
static void sharp_lobe(void **state) {
  (void)state;
  double worst = 0;
  for (float ns = 10; ns < 2e6f; ns *= 10)
    for (float turn = 0; turn < 4; turn += 0.25f) {
      bsdf b = rough(vec3_all(0), vec3_all(1), ns);
      float tilt = turn / sqrtf(ns);
      vec3 wo = {0, 0, 1};
      vec3 wi = {2 * tilt / (1 + tilt * tilt), 0,
                 (1 - tilt * tilt) / (1 + tilt * tilt)};
      if (wi.z <= 0.2f) continue;
      double hx = (double)wi.x, hz = (double)wi.z + 1, n = (double)ns;
      double want = pow(1 / sqrt(1 + hx * hx / (hz * hz)), n) * (n + 2) *
                    (n + 4) / (8 * 3.141592653589793 * (exp2(-n / 2) + n));
      double got = (double)bsdf_eval(&b, wo, wi).x;
      worst = fmax(worst, fabs(got / want - 1));
    }
  print_message("# worst relative error %.1e\n", worst);
  assert_true(worst < 3e-5);
}

// Exact unpolarised Fresnel from the angles, in double.
static double exact_reflectance(double cos_i, double eta, double *transmitted) {
  double sin_t = sqrt(1 - cos_i * cos_i) / eta;
  *transmitted = 0;
  if (sin_t >= 1) return 1;
  double cos_t = sqrt(1 - sin_t * sin_t);
  double rs = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
  double rp = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
  double ts = 2 * cos_i / (cos_i + eta * cos_t);
  double tp = 2 * cos_i / (eta * cos_i + cos_t);
  *transmitted = eta * cos_t / cos_i * (ts * ts + tp * tp) / 2;
  return (rs * rs + rp * rp) / 2;
}

// R is within 2e-6 of exact for 1/2.5 <= eta <= 2.5 and all angles; with the
// transmittance of Fresnel's own t coefficients it makes 1.
static void fresnel_is_exact(void **state) {
  (void)state;
  for (float eta = 0.4f; eta < 2.5f; eta += 0.07f)
    for (float c = 0.0005f; c <= 1; c += 0.0005f) {
      float cos_t;
      double t, r = exact_reflectance((double)c, (double)eta, &t);
      double got = (double)fresnel_dielectric(c, eta, &cos_t);
      assert_true(fabs(got - r) <= 2e-6);
      assert_true(t == 0 || fabs(got + t - 1) <= 1e-6);
    }
}

// At the critical cosine and one float to either side R is finite and at most
// 1; below it R is 1 and nothing is refracted.
static void fresnel_at_critical(void **state) {
  (void)state;
  for (float eta = 0.3f; eta < 1; eta += 0.003f) {
    float critical = sqrtf(1 - eta * eta), cos_t;
    float at[3] = {nextafterf(critical, 0), critical, nextafterf(critical, 1)};
    for (int i = 0; i < 3; i++) {
      double t, r = exact_reflectance((double)at[i], (double)eta, &t);
      float got = fresnel_dielectric(at[i], eta, &cos_t);
      assert_true(fabs((double)got - r) <= 2e-6 && got <= 1 && cos_t >= 0);
    }
    assert_true(fresnel_dielectric(critical * 0.9999f, eta, &cos_t) == 1);
    assert_true(cos_t == 0);
  }
  float cos_t;
  assert_true(fresnel_dielectric(0, 1.5f, &cos_t) == 1);
  assert_true(isfinite(fresnel_dielectric(0, 1, &cos_t)));
  assert_true(fresnel_dielectric(0.5f, 1, &cos_t) == 0);
}

// Glass obeys Snell's law from both sides, reflects with probability R, keeps
// all light, and seen from inside is the glass of index 1 / eta.
static void glass_refracts(void **state) {
  (void)state;
  bsdf b = {.kind = BSDF_GLASS, .kd = {1, 1, 1}, .eta = 1.5f};
  for (float z = -0.995f; z < 1; z += 0.01f) {
    vec3 wo = at_angle(z, 0.3f);
    float eta = z > 0 ? 1.5f : 1 / 1.5f, cos_t;
    float r = fresnel_dielectric(fabsf(z), eta, &cos_t);
    int reflected = 0;
    for (int k = 0; k < 1000; k++) {
      bsdf_sample s;
      assert_true(bsdf_sample_wi(&b, wo, ((float)k + 0.5f) / 1000, 0, 0, &s));
      assert_true(s.delta && s.weight.x == 1);
      assert_true(fabsf(vec3_length(s.wi) - 1) < 1e-6f);
      assert_true(s.transmitted == (s.wi.z * z < 0));
      reflected += !s.transmitted;
      float want = s.transmitted ? -1 / eta : -1;
      assert_true(fabsf(s.wi.x - want * wo.x) < 1e-6f);
      assert_true(fabsf(s.wi.y - want * wo.y) < 1e-6f);
    }
    assert_true(fabsf((float)reflected - 1000 * r) <= 1);
  }
}

// A mirror turns wo about the normal; Schlick's rises from F0 to 1.
static void mirror_reflects(void **state) {
  (void)state;
  bsdf b = {.kind = BSDF_MIRROR, .ks = {0.9f, 0.5f, 0.04f}};
  vec3 wo = at_angle(0.25f, 0.6f);
  bsdf_sample s;
  assert_true(bsdf_sample_wi(&b, wo, 0, 0, 0, &s));
  assert_true(s.wi.x == -wo.x && s.wi.y == -wo.y && s.wi.z == wo.z);
  assert_true(s.weight.y == 0.5f && s.delta && !s.transmitted);
  b.schlick = true;
  assert_true(bsdf_sample_wi(&b, wo, 0, 0, 0, &s));
  float want = 0.04f + 0.96f * (float)pow(0.75, 5);
  assert_float_equal(s.weight.z, want, 1e-6);
  assert_float_equal(fresnel_schlick(b.ks, 1).x, 0.9f, 0);
  assert_float_equal(fresnel_schlick(b.ks, 0).x, 1, 0);
  assert_false(bsdf_sample_wi(&b, (vec3){0.6f, 0, -0.8f}, 0, 0, 0, &s));
}

// Nothing that is not glass scatters across the surface, and a black surface
// not at all.
static void one_sided(void **state) {
  (void)state;
  bsdf b = rough(vec3_all(0.5f), vec3_all(0.5f), 20);
  vec3 up = at_angle(0.4f, 0.1f), down = at_angle(-0.4f, 0.7f);
  bsdf_sample s;
  assert_true(vec3_peak(bsdf_eval(&b, up, down)) == 0);
  assert_true(vec3_peak(bsdf_eval(&b, down, up)) == 0);
  assert_true(bsdf_pdf(&b, up, down) == 0 && bsdf_pdf(&b, down, up) == 0);
  assert_false(bsdf_sample_wi(&b, down, 0.5f, 0.5f, 0.5f, &s));
  b.kind = BSDF_GLASS;
  assert_true(bsdf_pdf(&b, up, up) == 0 && bsdf_is_delta(&b));
}

// The basis is orthonormal and right-handed, also at both poles.
static void basis(void **state) {
  (void)state;
  rng r = rng_of(3, 1, 4);
  for (int i = 0; i < 20000; i++) {
    vec3 n = at_angle(2 * rng_next(&r) - 1, rng_next(&r)), t, b;
    if (i == 0) n = (vec3){0, 0, 1};
    if (i == 1) n = (vec3){0, 0, -1};
    bsdf_basis(n, &t, &b);
    vec3 c = vec3_sub(vec3_cross(t, b), n);
    assert_true(vec3_length(c) < 2e-6f && fabsf(vec3_dot(t, b)) < 1e-6f);
    assert_true(fabsf(vec3_dot(t, n)) < 1e-6f);
    assert_true(fabsf(vec3_dot(b, n)) < 1e-6f);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(samples_follow_pdf),
      cmocka_unit_test(pdf_integrates_to_one),
      cmocka_unit_test(reciprocity),
      cmocka_unit_test(normalisation),
      cmocka_unit_test(sharp_lobe),
      cmocka_unit_test(fresnel_is_exact),
      cmocka_unit_test(fresnel_at_critical),
      cmocka_unit_test(glass_refracts),
      cmocka_unit_test(mirror_reflects),
      cmocka_unit_test(one_sided),
      cmocka_unit_test(basis),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
