// test_lean.c — where lobes look, against sums in other coordinates and
// against light along random paths.

#include "bsdf_rough.h"
#include "lean.h"
#include "num.h"
#include "rng.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

static int shortened(int n) {
  return getenv("FACET_QUICK") != NULL ? n / 5 : n;
}

static vec3 at_angle(float cos_theta, float turns) {
  vec2 c = num_circle(turns);
  float s = sqrtf(fmaxf(1 - cos_theta * cos_theta, 0));
  return (vec3){s * c.x, s * c.y, cos_theta};
}

// The integrals over light directions, cell by cell: up and along the surface,
// away from the viewer, of both parts.
static void by_lights(float nv, float roughness, double up[2],
                      double along[2]) {
  const int n = 500;
  const double cell = 2 * (double)PI / n / n;  // of both halves of the turn
  vec3 wo = at_angle(nv, 0);
  up[0] = up[1] = along[0] = along[1] = 0;
  for (int i = 0; i < n; i++)
    for (int k = 0; k < n; k++) {
      vec3 wi = at_angle(((float)i + 0.5f) / (float)n,
                         ((float)k + 0.5f) / (float)(2 * n));
      half_angles a = half_angles_of((vec3){0, 0, 1}, wo, wi);
      float alpha = roughness * roughness;
      double d = (double)(ggx_d(a.t, a.nh, alpha) * ggx_v(a.nl, nv, alpha));
      double f = (double)fresnel_schlick(vec3_all(0), a.oh).x;
      double w = cell * d * (double)a.nl;
      for (int j = 0; j < 2; j++) {
        up[j] += w * (j == 0 ? 1 - f : f) * (double)wi.z;
        along[j] -= w * (j == 0 ? 1 - f : f) * (double)wi.x;
      }
    }
}

// The integrals are those over light directions.
static void integral_is_that_of_lights(void **state) {
  (void)state;
  const float nv[] = {0.05f, 0.2f, 0.5f, 0.9f}, r[] = {0.3f, 0.5f, 0.75f, 1};
  for (int i = 0; i < 16; i++) {
    double up[2], along[2];
    float c = nv[i % 4], s = sqrtf(1 - c * c);
    by_lights(c, r[i / 4], up, along);
    lean_pair p = lean_integral(c, r[i / 4]);
    double far = fabs((double)(p.r1 * c + p.n1) - up[0]);
    far = fmax(far, fabs((double)(p.r2 * c + p.n2) - up[1]));
    far = fmax(far, fabs((double)(p.r1 * s) - along[0]));
    far = fmax(far, fabs((double)(p.r2 * s) - along[1]));
    if (!(far < 2e-3))
      fail_msg("nv %g, roughness %g: %g", (double)c, (double)r[i / 4], far);
  }
}

// A mirror's lobe looks along the mirror direction, seen head-on every lobe
// looks along the normal, and in between it lies in their plane; that of a
// metal between the two (unless it is nearly as rough as can be, where light
// comes back).
static void ends(void **state) {
  (void)state;
  arena mem = {0};
  lean table;
  lean_build(&table, &mem, NULL);
  vec3 n = {0, 0, 1};
  rng r = rng_of(7, 0, 0);
  for (int i = 0; i < 20000; i++) {
    vec3 wo = at_angle(fmaxf(rng_next(&r), 1e-3f), rng_next(&r));
    vec3 mirrored = {-wo.x, -wo.y, wo.z};
    float f0 = rng_next(&r), rough = rng_next(&r);
    vec3 d = lean_towards(&table, n, wo, f0, 0);
    assert_true(vec3_length(vec3_sub(d, mirrored)) < 1e-5f);
    d = lean_towards(&table, n, n, f0, rough);
    assert_true(vec3_length(vec3_sub(d, n)) < 1e-5f);
    d = lean_towards(&table, n, wo, f0, rough);
    assert_true(fabsf(vec3_length(d) - 1) < 1e-6f);
    assert_true(fabsf(vec3_dot(d, vec3_cross(n, wo))) < 1e-6f);
    if (rough < 0.9f && f0 > 0.4f)
      assert_true(d.z > wo.z - 2e-3f && vec3_dot(d, mirrored) >= wo.z - 1e-3f);
  }
  arena_free(&mem);
}

// A table made for some roughness values has the same entries there.
static void rows_as_needed(void **state) {
  (void)state;
  arena mem = {0};
  lean all, some;
  const float roughness[] = {0, 0.1f, 0.25f, 0.333f, 1};
  lean_build(&all, &mem, NULL);
  lean_build_for(&some, roughness, 5, &mem, NULL);
  for (int i = 0; i < 5 * 11; i++) {
    float nv = 0.1f * (float)(i % 11), r = roughness[i / 11];
    lean_pair a = lean_lookup(&all, nv, r), b = lean_lookup(&some, nv, r);
    assert_memory_equal(&a, &b, sizeof a);
  }
  int empty = 0;
  for (int y = 0; y < LEAN_ROWS; y++)
    empty += some.table[y * LEAN_COLUMNS].r2 == 0;
  assert_true(empty > LEAN_ROWS / 2);
  arena_free(&mem);
}

// What the approximations below read: a sky that grows from black below to
// white above, and its sums, which are known.
static double sky(vec3 d) {
  return 0.5 + 0.5 * (double)d.y;
}

static double irradiance(vec3 n) {
  return (double)PI * (0.5 + (double)n.y / 3);
}

// The mean about d of a lobe seen head-on, whose mean cosine is c.
static double blurred(vec3 d, double c) {
  return 0.5 + 0.5 * c * (double)d.y;
}

// A grey surface under that sky, seen along the z axis.
typedef struct subject {
  bsdf_rough b;
  const lean *lean;
  double head_on;  // mean cosine of its lobe
} subject;

// The split sum, with lobes that lean or look along the mirror direction.
static double split_sum(const subject *s, vec3 n, bool leaning) {
  const vec3 wo = {0, 0, 1};
  dfg_pair e = dfg_lookup(s->b.table, n.z, s->b.roughness);
  float f0 = s->b.terms.f0.x;
  vec3 d = vec3_sub(vec3_scale(n, 2 * n.z), wo);
  if (leaning) d = lean_towards(s->lean, n, wo, f0, s->b.roughness);
  double kd = (double)(s->b.terms.kd.x * (1 - DIELECTRIC_F0 * e.c1 - e.c2));
  return kd / (double)PI * irradiance(n) +
         (double)(f0 * e.c1 + e.c2) * blurred(d, s->head_on);
}

// The mean over paths of one bounce: samples in the cells of a grid.
static double traced(const subject *s, vec3 n, rng *r) {
  const int side = shortened(60);
  vec3 t = vec3_unit((vec3){n.z, 0, -n.x}), b = vec3_cross(n, t);
  vec3 wo = {t.z, b.z, n.z};
  double sum = 0;
  for (int i = 0; i < side * side; i++) {
    float u[3] = {rng_next(r), ((float)(i % side) + rng_next(r)) / (float)side,
                  ((float)(i / side) + rng_next(r)) / (float)side};
    vec3 wi, weight;
    if (!bsdf_rough_sample(&s->b, wo, u, &wi, &weight)) continue;
    vec3 d = vec3_mad(vec3_scale(t, wi.x), wi.y, b);
    sum += (double)weight.x * sky(vec3_mad(d, wi.z, n));
  }
  return sum / side / side;
}

// Root mean square over normals that are seen, over that of the truth: of the
// split sum and of lobes that lean.
static void rms_errors(const subject *s, double *split, double *leaning) {
  const int normals = 150;
  double sum[2] = {0, 0}, all = 0;
  rng r = rng_of(11, 0, 0);
  for (int i = 0; i < normals; i++) {
    float z = ((float)i + 0.5f) / (float)normals;
    vec3 n = at_angle(z, fmodf((float)i * 0.618034f, 1));
    double truth = traced(s, n, &r);
    for (int k = 0; k < 2; k++) {
      double off = split_sum(s, n, k == 1) - truth;
      sum[k] += off * off;
    }
    all += truth * truth;
  }
  *split = sqrt(sum[0] / all);
  *leaning = sqrt(sum[1] / all);
}

// Under a gradient, against paths: a rough metal whose lobe leans is at least
// five times as near as the split sum, and nothing is off by more than a few
// hundredths.
static void leaning_beats_the_split_sum(void **state) {
  (void)state;
  const float rough[] = {0.1f, 0.2f, 0.35f, 0.5f, 0.75f, 1};
  arena mem = {0};
  dfg table;
  lean lobes;
  dfg_build(&table, PBR_GGX, &mem, NULL);
  lean_build(&lobes, &mem, NULL);
  for (int i = 0; i < 12; i++) {
    float r = rough[i / 2], metallic = (float)(i % 2);
    subject s = {bsdf_rough_of(&table, vec3_all(0.8f), metallic, r), &lobes, 0};
    lean_pair p = lean_integral(1, r);
    dfg_pair e = dfg_integral(PBR_GGX, 1, r);
    s.head_on = (double)((p.r1 + p.r2 + p.n1 + p.n2) / (e.c1 + e.c2));
    double split, leaning;
    rms_errors(&s, &split, &leaning);
    print_message("# metallic %g, roughness %.2f: %.4f, leaning %.4f\n",
                  (double)metallic, (double)r, split, leaning);
    assert_true(leaning < (r < 1 ? 0.025 : 0.05));
    assert_true(metallic < 1 || r < 0.2f || leaning < split / 5);
  }
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(integral_is_that_of_lights),
      cmocka_unit_test(ends),
      cmocka_unit_test(rows_as_needed),
      cmocka_unit_test(leaning_beats_the_split_sum),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
