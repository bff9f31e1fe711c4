// test_dfg.c — the table of what rough surfaces reflect.

#include "dfg.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

// The same integral by half vectors weighed by D nh, a million of
// them: c = E[4 oh V nl / nh ...].  No coordinate of it is that of dfg.c.
// Near the horizon 1 / nh grows: u = 1 - s^3 puts more points there.
static void by_half_vectors(pbr_model model, double nv, double r, double c[2]) {
  int n = getenv("FACET_QUICK") != NULL ? 200 : 1500, m = n / 2;
  double alpha = r * r, so = sqrt(1 - nv * nv);
  c[0] = c[1] = 0;
  for (int i = 0; i < n; i++) {
    double s = 1 - (i + 0.5) / n, u = 1 - s * s * s,
           nh2 = (1 - u) / (1 + (alpha * alpha - 1) * u);
    double nh = sqrt(nh2), sh = sqrt(1 - nh2);
    for (int j = 0; j < m; j++) {
      double phi = 3.14159265358979324 * (j + 0.5) / m;
      double oh = so * sh * cos(phi) + nv * nh, nl = 2 * oh * nh - nv;
      if (!(oh > 0) || !(nl > 0)) continue;
      float v = model == PBR_REPORT
                    ? schlick_v((float)nl, (float)nv, schlick_k_env((float)r))
                    : ggx_v((float)nl, (float)nv, (float)alpha);
      double w = 3 * s * s * 4 * oh * (double)v * nl / nh / n / m,
             f = pow(1 - oh, 5);
      c[0] += w * (1 - f);
      c[1] += w * f;
    }
  }
}

// The integral is right: against a quadrature in other coordinates, where
// that one converges.
static void integral_is_that_of_half_vectors(void **state) {
  (void)state;
  static const float nv[] = {0.4f, 0.6f, 0.8f, 1}, r[] = {0.3f, 0.5f, 0.7f, 1};
  for (int model = 0; model < 2; model++)
    for (int i = 0; i < 16; i++) {
      double c[2];
      by_half_vectors((pbr_model)model, (double)nv[i % 4], (double)r[i / 4], c);
      dfg_pair p = dfg_integral((pbr_model)model, nv[i % 4], r[i / 4]);
      double far = fmax(fabs(c[0] - (double)p.c1), fabs(c[1] - (double)p.c2));
      double goal = getenv("FACET_QUICK") != NULL ? 2e-3 : 3e-4;
      if (!(far < goal))
        fail_msg("model %d, nv %g, roughness %g: %g", model, (double)nv[i % 4],
                 (double)r[i / 4], far);
    }
}

// Looked up, the table is within 1e-3 of the integral for nv >= 1e-3 and
// roughness >= 0.05, 5e-5 in the mean square; it never reflects more than
// there is.
static void lookups_are_the_integral(void **state) {
  (void)state;
  int n = getenv("FACET_QUICK") != NULL ? 400 : 20000;
  for (int model = 0; model < 2; model++) {
    arena mem = {0};
    dfg d;
    dfg_build(&d, (pbr_model)model, &mem, NULL);
    uint32_t dice = 1;
    double squares = 0;
    for (int i = 0; i < n; i++) {
      dice = dice * 1664525u + 1013904223u;
      float nv = 1e-3f + 0.999f * (float)(dice >> 8) * 0x1p-24f;
      dice = dice * 1664525u + 1013904223u;
      float r = 0.05f + 0.95f * (float)(dice >> 8) * 0x1p-24f;
      dfg_pair a = dfg_integral((pbr_model)model, nv, r);
      dfg_pair b = dfg_lookup(&d, nv, r);
      float far = fmaxf(fabsf(a.c1 - b.c1), fabsf(a.c2 - b.c2));
      assert_true(far < 1e-3f);
      assert_true(b.c1 >= 0 && b.c2 >= 0 && b.c1 + b.c2 <= 1.0001f);
      squares += (double)far * (double)far;
    }
    assert_true(sqrt(squares / n) < 5e-5);
    arena_free(&mem);
  }
}

// Roughness 0 is the mirror: Schlick's formula; arguments outside of [0, 1]
// read the ends; the means are between the extremes of their rows.
static void ends_of_the_table(void **state) {
  (void)state;
  arena mem = {0};
  dfg d;
  dfg_build(&d, PBR_GGX, &mem, NULL);
  dfg_pair p = dfg_lookup(&d, 1, 0), q = dfg_lookup(&d, 5, -1);
  assert_true(p.c1 == 1 && p.c2 == 0 && q.c1 == 1 && q.c2 == 0);
  p = dfg_lookup(&d, 0, 0);
  assert_true(p.c1 == 0 && p.c2 == 1);
  for (int i = 0; i <= 20; i++) {
    dfg_pair mean = dfg_lookup_mean(&d, (float)i / 20);
    assert_true(mean.c1 > 0.3f && mean.c1 < 1 && mean.c2 > 0);
    assert_true(mean.c2 < 0.06f);
  }
  // Of a mirror, 2 nv (1 - (1 - nv)^5) integrates to 1 - 1 / 21.
  assert_true(fabsf(dfg_lookup_mean(&d, 0).c1 - 20.0f / 21) < 1e-5f);
  arena_free(&mem);
}

// A table made for some roughness values has the same entries there.
static void rows_as_needed(void **state) {
  (void)state;
  arena mem = {0};
  dfg all, some;
  const float roughness[] = {0, 0.1f, 0.25f, 0.5f, 1, 0.333f};
  dfg_build(&all, PBR_GGX, &mem, NULL);
  dfg_build_for(&some, (dfg_need){PBR_GGX, roughness, 6}, &mem, NULL);
  for (int i = 0; i < 6; i++)
    for (int k = 0; k <= 10; k++) {
      dfg_pair a = dfg_lookup(&all, 0.1f * (float)k, roughness[i]);
      dfg_pair b = dfg_lookup(&some, 0.1f * (float)k, roughness[i]);
      dfg_pair c = dfg_lookup_mean(&all, roughness[i]);
      dfg_pair d = dfg_lookup_mean(&some, roughness[i]);
      assert_true(a.c1 == b.c1 && a.c2 == b.c2);
      assert_true(c.c1 == d.c1 && c.c2 == d.c2);
    }
  int empty = 0;
  for (int y = 0; y < DFG_ROWS; y++)
    empty += some.mean[y].c1 == 0;
  assert_true(empty > DFG_ROWS / 2);
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(integral_is_that_of_half_vectors),
      cmocka_unit_test(lookups_are_the_integral),
      cmocka_unit_test(ends_of_the_table),
      cmocka_unit_test(rows_as_needed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
