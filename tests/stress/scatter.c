// scatter.c — what surfaces do at the ends of all ranges.

#include "../chi.h"

#include "bsdf.h"
#include "num.h"
#include "rng.h"
#include "stress.h"

// Exact unpolarised Fresnel, in long double.
static long double exact_fresnel(long double c, long double n) {
  long double s2 = n * n - 1 + c * c;
  if (s2 <= 0) return 1;
  long double s = sqrtl(s2);
  long double across = (c - s) / (c + s),
              along = (n * n * c - s) / (n * n * c + s);
  return (across * across + along * along) / 2;
}

// Reflectance at random angles, and at the critical one and its neighbours.
static void fresnel(stress *s) {
  size_t n = stress_count(s, 1e5, 1e7, 1e8);
  rng r = rng_of(71, s->slice, 0);
  double worst = 0, wrong = 0;
  for (size_t i = 0; i < n; i++) {
    float eta = num_exp2(2.6f * rng_next(&r) - 1.3f), cos_t;
    float critical = eta < 1 ? sqrtf((1 - eta) * (1 + eta)) : 0;
    float c = rng_next(&r);
    if (i % 2 == 0) c = critical;
    for (uint64_t k = i % 8; k > 0 && i % 2 == 0; k--)
      c = nextafterf(c, k % 4 == 0 ? 2.0f : 0.0f);
    float got = fresnel_dielectric(c, eta, &cos_t);
    bool total = (long double)eta * (long double)eta - 1 +
                     (long double)c * (long double)c <=
                 0;
    wrong += !(got >= 0 && got <= 1 && cos_t >= 0 && cos_t <= 1);
    wrong += total && (got != 1 || cos_t != 0);
    // At the critical angle R is infinitely steep: what is asked is the
    // reflectance of these very floats.
    long double want = exact_fresnel((long double)c, (long double)eta);
    worst = fmax(worst, (double)fabsl((long double)got - want));
  }
  stress_print(
      s, (stress_row){"Fresnel, also at the critical angle +- 4 ulp: error",
                      (double)n, wrong, worst, 2e-6,
                      "0.96 (Schlick by the inside cosine)"});
}

// Glass at total reflection: nothing passes, nothing is lost, no number is odd.
static void total_reflection(stress *s) {
  size_t n = stress_count(s, 1e5, 1e7, 1e8);
  rng r = rng_of(72, s->slice, 0);
  double wrong = 0, worst = 0;
  for (size_t i = 0; i < n; i++) {
    bsdf b = {.kind = BSDF_GLASS, .kd = {1, 1, 1}};
    b.eta = 1 + 1.5f * rng_next(&r);
    float z = -rng_next(&r), side = sqrtf(1 - z * z);
    vec2 turn = num_circle(rng_next(&r));
    vec3 wo = {side * turn.x, side * turn.y, z};
    bsdf_sample d;
    float u = rng_next(&r);
    if (!bsdf_sample_wi(&b, wo, u, rng_next(&r), rng_next(&r), &d)) {
      wrong++;
      continue;
    }
    bool total = (double)side * (double)b.eta > 1 + 1e-6;
    wrong += total && d.transmitted;
    wrong += !vec3_finite(d.wi) || d.weight.x != 1;
    worst = fmax(worst, fabs((double)vec3_length(d.wi) - 1));
    if (!d.transmitted) continue;
    // Snell, from inside: sin outside = eta sin inside.
    double out = sqrt((double)(d.wi.x * d.wi.x + d.wi.y * d.wi.y));
    double off = fabs(out - (double)b.eta * (double)side);
    worst = fmax(worst, (double)d.wi.z * off);
  }
  stress_print(s, (stress_row){"glass from inside: total reflection, Snell",
                               (double)n, wrong, worst, 1e-6, "none"});
}

static vec3 at_angle(float c, float turns) {
  vec2 t = num_circle(turns);
  float side = sqrtf((1 - c) * (1 + c));
  return (vec3){side * t.x, side * t.y, c};
}

static const float ROUGH[] = {0,     1e-4f, 1e-3f, 1.001e-3f, 0.003f, 0.01f,
                              0.03f, 0.1f,  0.3f,  0.7f,      1};
enum { ROUGHS = sizeof ROUGH / sizeof *ROUGH };

// Cosines down to grazing, where 1e-38 is the last but denormals.
static float grazing(rng *r) {
  float u = rng_next(r);
  return rng_next(r) < 0.5f ? 1 - u * u : num_exp2(-126 * u);
}

// Nothing negative, infinite or NaN; the weights of white metal at most 1.
static void ggx_ends(stress *s, const dfg *table) {
  size_t n = stress_count(s, 2e5, 1e7, 1e8);
  rng r = rng_of(73, s->slice, 0);
  double wrong = 0, worst = 0;
  for (size_t i = 0; i < n; i++) {
    float metal = i % 3 == 0 ? 1 : i % 3 == 1 ? 0 : rng_next(&r);
    bsdf_rough b = bsdf_rough_of(table, vec3_all(1), metal, ROUGH[i % ROUGHS]);
    vec3 wo = at_angle(grazing(&r), rng_next(&r)), wi, weight;
    vec3 other = at_angle(grazing(&r), rng_next(&r));
    if (i % 5 == 0) other = (vec3){-wo.x, -wo.y, wo.z};
    vec3 f = bsdf_rough_eval(&b, wo, other);
    float pdf = bsdf_rough_pdf(&b, wo, other);
    wrong += !vec3_finite(f) || !(f.x >= 0) || !isfinite(pdf) || !(pdf >= 0);
    float u[3] = {rng_next(&r), rng_next(&r), rng_next(&r)};
    if (!bsdf_rough_sample(&b, wo, u, &wi, &weight)) continue;
    wrong += !vec3_finite(wi) || !vec3_finite(weight) || !(weight.x >= 0);
    if (metal == 1) worst = fmax(worst, (double)weight.x);
  }
  stress_print(
      s, (stress_row){"GGX, roughness 0, 1e-4 ... 1, grazing: largest weight",
                      (double)n, wrong, worst, 1 + 1e-6, "none"});
}

enum { ROWS = 12, COLUMNS = 24, CELLS = ROWS * COLUMNS };

// The density over a rectangle of cosines and turns, halved until it changes
// little.
static double cell_share(const bsdf_rough *b, vec3 wo, const double c[4],
                         int depth) {
  double sum[2] = {0, 0};
  for (int fine = 0; fine < 2; fine++) {
    int n = fine ? 8 : 4;
    double dz = (c[1] - c[0]) / n, dt = (c[3] - c[2]) / n;
    for (int i = 0; i < n * n; i++) {
      double z = c[0] + (i / n + 0.5) * dz, t = c[2] + (i % n + 0.5) * dt;
      vec3 wi = at_angle((float)z, (float)t);
      sum[fine] += (double)bsdf_rough_pdf(b, wo, wi) * dz * dt;
    }
  }
  if (depth > 8 || (depth > 1 && fabs(sum[0] - sum[1]) < 1e-8)) return sum[1];
  double z = (c[0] + c[1]) / 2, t = (c[2] + c[3]) / 2, all = 0;
  const double part[4][4] = {{c[0], z, c[2], t},
                             {z, c[1], c[2], t},
                             {c[0], z, t, c[3]},
                             {z, c[1], t, c[3]}};
  for (int i = 0; i < 4; i++)
    all += cell_share(b, wo, part[i], depth + 1);
  return all;
}

// How likely counts as far from the density as these are.
static double fit(const bsdf_rough *b, vec3 wo, size_t n, uint64_t seed) {
  double got[CELLS + 1] = {0}, want[CELLS + 1] = {0}, all = 0;
  for (size_t k = 0; k < n; k++) {
    rng r = rng_of(seed, 0, k);
    float u[3] = {rng_next(&r), rng_next(&r), rng_next(&r)};
    vec3 wi, weight;
    int cell = CELLS;
    if (bsdf_rough_sample(b, wo, u, &wi, &weight)) {
      double turns = atan2((double)wi.y, (double)wi.x) / (2 * (double)PI);
      int row = (int)(wi.z * ROWS), column;
      column = (int)((turns - floor(turns)) * COLUMNS);
      cell = (row < ROWS ? row : ROWS - 1) * COLUMNS +
             (column < COLUMNS ? column : COLUMNS - 1);
    }
    got[cell]++;
  }
  for (int i = 0; i < CELLS; i++) {
    double row = i / COLUMNS, column = i % COLUMNS;
    const double c[4] = {row / ROWS, (row + 1) / ROWS, column / COLUMNS,
                         (column + 1) / COLUMNS};
    double share = cell_share(b, wo, c, 0) * 2 * (double)PI;
    all += share;
    want[i] = share * (double)n;
  }
  want[CELLS] = fmax(1 - all, 0) * (double)n;
  return chi_probability(got, want, CELLS + 1);
}

// Nine pairs of cosine and roughness, metal and porcelain: of 18 correct
// samplers the smallest probability is below 0.01 / 18 once in a hundred.
static void chi_square(stress *s, const dfg *table) {
  static const float at[9][2] = {{0.95f, 0.05f}, {0.5f, 0.05f}, {0.1f, 0.05f},
                                 {0.95f, 0.3f},  {0.5f, 0.3f},  {0.1f, 0.3f},
                                 {0.8f, 1},      {0.3f, 0.7f},  {0.02f, 0.5f}};
  size_t n = stress_count(s, 2e4, 1e6, 1e7);
  double least = 1;
  int cases = s->size == STRESS_SHORT ? 6 : 18;
  for (int i = 0; i < cases; i++) {
    const float *a = at[(s->size == STRESS_SHORT ? 3 : 0) + i / 2];
    bsdf_rough b = bsdf_rough_of(table, vec3_all(0.8f), (float)(i % 2), a[1]);
    vec3 wo = at_angle(a[0], 0.13f);
    least = fmin(least, fit(&b, wo, n, 900 + 100 * s->slice + (uint64_t)i));
  }
  stress_print(
      s, (stress_row){"chi-square of directions: 1 - least probability",
                      (double)cases * (double)n, 0, 1 - least, 1 - 0.01 / cases,
                      "Mitsuba's tests: 0.01 / cases, too"});
}

void stress_scatter(stress *s) {
  arena mem = {0};
  dfg table;
  dfg_build(&table, PBR_GGX, &mem, s->threads);
  fresnel(s);
  total_reflection(s);
  ggx_ends(s, &table);
  chi_square(s, &table);
  arena_free(&mem);
}
