// test_bsdf_rough.c — laws of the triple of metallic-roughness.

#include "bsdf_rough.h"
#include "chi.h"
#include "num.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "rng.h"

// n, or a fiftieth of it under the sanitizers.
static long shortened(long n) {
  return getenv("FACET_QUICK") != NULL ? n / 50 : n;
}

static vec3 at_angle(float cos_theta, float turns) {
  vec2 c = num_circle(turns);
  float s = sqrtf(1 - cos_theta * cos_theta);
  return (vec3){s * c.x, s * c.y, cos_theta};
}

static const vec3 WHITE = {1, 1, 1}, COPPER = {0.9f, 0.6f, 0.4f};

// The tables of both sets of formulas, the same for all tests.
typedef struct tables {
  arena mem;
  dfg of[2];
} tables;

static int set_up(void **state) {
  tables *t = calloc(1, sizeof *t);
  dfg_build(&t->of[PBR_GGX], PBR_GGX, &t->mem, NULL);
  dfg_build(&t->of[PBR_REPORT], PBR_REPORT, &t->mem, NULL);
  *state = t;
  return 0;
}

static int tear_down(void **state) {
  tables *t = *state;
  arena_free(&t->mem);
  free(t);
  return 0;
}

// The cosines and roughnesses at which samplers are put to the test: small
// roughness, grazing light and both at once.
typedef struct sampler_case {
  float cos_o, roughness;
} sampler_case;

enum { CASES = 9 };
static const sampler_case CASE[CASES] = {
    {0.95f, 0.05f}, {0.5f, 0.05f}, {0.1f, 0.05f}, {0.95f, 0.3f}, {0.5f, 0.3f},
    {0.1f, 0.3f},   {0.8f, 1},     {0.3f, 0.7f},  {0.02f, 0.5f}};

// A rectangle of cosines and turns.
typedef struct patch {
  double z0, z1, t0, t1;
} patch;

// What is integrated: the density, or f cos of the first channel.
typedef struct integrand {
  const bsdf_rough *b;
  vec3 wo;
  bool light;
} integrand;

static double integrand_at(const integrand *g, double z, double turns) {
  vec3 wi = at_angle((float)z, (float)turns);
  if (!g->light) return (double)bsdf_rough_pdf(g->b, g->wo, wi);
  return (double)(bsdf_rough_eval(g->b, g->wo, wi).x * wi.z);
}

// By the midpoints of 6 x 6 fields.
static double patch_sum(const integrand *g, patch p) {
  const int n = 6;
  double sum = 0, dz = (p.z1 - p.z0) / n, dt = (p.t1 - p.t0) / n;
  for (int i = 0; i < n; i++)
    for (int k = 0; k < n; k++)
      sum += integrand_at(g, p.z0 + (i + 0.5) * dz, p.t0 + (k + 0.5) * dt);
  return sum * dz * dt * 2 * (double)PI;
}

// Halved both ways until it changes little; twice at least.
static double patch_integral(const integrand *g, patch p, double whole,
                             int depth) {
  double z = (p.z0 + p.z1) / 2, t = (p.t0 + p.t1) / 2, part[4], sum = 0;
  patch q[4] = {{p.z0, z, p.t0, t},
                {z, p.z1, p.t0, t},
                {p.z0, z, t, p.t1},
                {z, p.z1, t, p.t1}};
  for (int i = 0; i < 4; i++)
    sum += part[i] = patch_sum(g, q[i]);
  if (depth >= 9 || (depth >= 2 && fabs(sum - whole) < 2e-7)) return sum;
  sum = 0;
  for (int i = 0; i < 4; i++)
    sum += patch_integral(g, q[i], part[i], depth + 1);
  return sum;
}

enum { ROWS = 12, COLUMNS = 24, CELLS = ROWS * COLUMNS };

static double cell_integral(const integrand *g, int cell) {
  double row = cell / COLUMNS, column = cell % COLUMNS;
  patch p = {row / ROWS, (row + 1) / ROWS, column / COLUMNS,
             (column + 1) / COLUMNS};
  return patch_integral(g, p, patch_sum(g, p), 0);
}

static double hemisphere_integral(const integrand *g) {
  double sum = 0;
  for (int i = 0; i < CELLS; i++)
    sum += cell_integral(g, i);
  return sum;
}

// What the samples of one surface do.
typedef struct counted {
  double cells[CELLS + 1];  // the last: nothing scattered
  double weight, weight2, largest;
} counted;

static counted count_samples(const bsdf_rough *b, vec3 wo, long n,
                             uint64_t seed) {
  counted c = {0};
  for (long k = 0; k < n; k++) {
    rng r = rng_of(seed, 0, (uint64_t)k);
    float u[3] = {rng_next(&r), rng_next(&r), rng_next(&r)};
    vec3 wi, weight;
    if (!bsdf_rough_sample(b, wo, u, &wi, &weight)) {
      c.cells[CELLS]++;
      continue;
    }
    double turns = atan2((double)wi.y, (double)wi.x) / (2 * (double)PI);
    int row = (int)(wi.z * ROWS);
    int column = (int)((turns - floor(turns)) * COLUMNS);
    if (row >= ROWS) row = ROWS - 1;
    if (column >= COLUMNS) column = COLUMNS - 1;
    c.cells[row * COLUMNS + column]++;
    double w = (double)weight.x;
    c.weight += w;
    c.weight2 += w * w;
    c.largest = fmax(c.largest, w);
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

static void check_sampler(bsdf_rough b, sampler_case at, uint64_t seed) {
  vec3 wo = at_angle(at.cos_o, 0.13f);
  long n = shortened(1000000);
  counted c = count_samples(&b, wo, n, seed);
  integrand density = {&b, wo, false}, light = {&b, wo, true};
  double expected[CELLS + 1], all = 0;
  for (int i = 0; i < CELLS; i++)
    all += expected[i] = cell_integral(&density, i);
  expected[CELLS] = fmax(1 - all, 0);
  assert_true(all < 1 + 2e-4);
  double f_cos = hemisphere_integral(&light);
  double p = fit(&c, expected, n), mean = c.weight / (double)n;
  double variance = fmax(c.weight2 / (double)n - mean * mean, 0);
  double error = sqrt(variance / (double)n);
  print_message("# cos_o %.2f r %.2f %s: p = %.3f, weight %.5f against %.5f "
                "+- %.5f, largest %.3f\n",
                (double)at.cos_o, (double)at.roughness,
                b.terms.model == PBR_GGX ? "ggx" : "report", p, mean, f_cos,
                error, c.largest);
  assert_true(p > 1.1e-3);
  assert_true(fabs(mean - f_cos) < 4 * error + 1e-4);
}

// Directions are distributed as the pdf says, and the mean weight is the
// integral of f cos: metals and dielectrics, both sets of formulas.
static void samples_follow_pdf(void **state) {
  const tables *t = *state;
  const dfg *ggx = &t->of[PBR_GGX], *report = &t->of[PBR_REPORT];
  uint64_t seed = 1;
  for (int i = 0; i < CASES; i++) {
    float r = CASE[i].roughness;
    check_sampler(bsdf_rough_of(ggx, WHITE, 1, r), CASE[i], seed++);
    check_sampler(bsdf_rough_of(ggx, COPPER, 0, r), CASE[i], seed++);
    check_sampler(bsdf_rough_of(report, COPPER, 0.3f, r), CASE[i], seed++);
  }
}

// The same for lobes too narrow to be integrated over directions: down to the
// least roughness, and grazing.
enum { NARROW = 12 };
static const sampler_case NARROW_CASE[NARROW] = {
    {0.95f, 0.001f}, {0.5f, 0.001f}, {0.1f, 0.001f}, {0.02f, 0.001f},
    {0.95f, 0.01f},  {0.5f, 0.01f},  {0.1f, 0.01f},  {0.02f, 0.01f},
    {0.9f, 0.1f},    {0.3f, 0.1f},   {0.05f, 0.1f},  {0.01f, 1}};

// How directions are sorted: by cosine and turns about the normal, or, fine
// where the lobe is, by how far and whereto the half vector is tilted.
typedef enum sorting { BY_DIRECTION, BY_TILT } sorting;

// The cell of a share in [0, 1] along and of turns around.
static int cell_of(double along, double turns) {
  int row = (int)(along * ROWS),
      column = (int)((turns - floor(turns)) * COLUMNS);
  if (row >= ROWS) row = ROWS - 1;
  if (column >= COLUMNS) column = COLUMNS - 1;
  return row * COLUMNS + column;
}

static double turns_of(double y, double x) {
  return atan2(y, x) / (2 * (double)PI);
}

// A facet's slope, in units of alpha, has length m with a share m^2 / (1 + m^2)
// of all facets below it.
static int tilt_cell(double sx, double sy, double alpha) {
  double m2 = (sx * sx + sy * sy) / (alpha * alpha);
  return cell_of(m2 / (1 + m2), turns_of(sy, sx));
}

// The cell of light that a facet of that slope mirrors, in double.
static int facet_cell(sorting by, const double wo[3], double sx, double sy,
                      double alpha) {
  double length2 = 1 + sx * sx + sy * sy;
  double twice = 2 * (wo[0] * sx + wo[1] * sy + wo[2]) / length2;
  double x = twice * sx - wo[0], y = twice * sy - wo[1], z = twice - wo[2];
  if (!(z > 0)) return CELLS;
  return by == BY_TILT ? tilt_cell(sx, sy, alpha) : cell_of(z, turns_of(y, x));
}

// The probability of each cell: facets in known shares of their distribution,
// the steep ones, which are rare, in finer steps, each weighed by what the
// viewer sees of it.
static void facet_shares(sorting by, const double wo[3], double alpha,
                         double *expected) {
  const int n = (int)shortened(4000) + 100, around = 1440;
  double all = 0;
  for (int i = 0; i <= CELLS; i++)
    expected[i] = 0;
  for (int i = 0; i < n; i++)
    for (int k = 0; k < around; k++) {
      double rest = 1 - (i + 0.5) / n, shift = fmod(i * 0.6180339887, 1);
      double turn = 2 * (double)PI * (k + shift) / around;
      double rare = rest * rest * rest * rest;
      double m = alpha * sqrt((1 - rare) / rare);
      double sx = m * cos(turn), sy = m * sin(turn);
      double seen = fmax(wo[0] * sx + wo[1] * sy + wo[2], 0);
      seen *= rest * rest * rest;
      expected[facet_cell(by, wo, sx, sy, alpha)] += seen;
      all += seen;
    }
  for (int i = 0; i <= CELLS; i++)
    expected[i] /= all;
}

// Cells of n samples of a metal, and the largest weight.
static double count_facets(counted *c, sorting by, const bsdf_rough *b, vec3 wo,
                           long n) {
  double largest = 0;
  for (long k = 0; k < n; k++) {
    rng r = rng_of(77, 0, (uint64_t)k);
    float u[3] = {rng_next(&r), rng_next(&r), rng_next(&r)};
    vec3 wi, weight;
    int cell = CELLS;
    if (bsdf_rough_sample(b, wo, u, &wi, &weight)) {
      double x = (double)wi.x + (double)wo.x, y = (double)wi.y + (double)wo.y;
      double z = (double)wi.z + (double)wo.z;
      cell = by == BY_TILT
                 ? tilt_cell(x / z, y / z, (double)b->terms.alpha)
                 : cell_of((double)wi.z, turns_of((double)wi.y, (double)wi.x));
      largest = fmax(largest, (double)weight.x);
    }
    c->cells[cell]++;
  }
  return largest;
}

// Narrow lobes and grazing ones are distributed as visible facets are: sorted
// by direction, and, where the floats of wi can tell, by the tilt of the
// facet; and no weight exceeds 1.
static void narrow_lobes_follow_their_facets(void **state) {
  const tables *t = *state;
  long n = shortened(1000000);
  for (int i = 0; i < 2 * NARROW; i++) {
    sampler_case at = NARROW_CASE[i / 2];
    sorting by = i % 2 == 0 ? BY_DIRECTION : BY_TILT;
    bsdf_rough b = bsdf_rough_of(&t->of[PBR_GGX], WHITE, 1, at.roughness);
    // The rounding of wi moves the half vector by 1e-7 over its cosine.
    if (by == BY_TILT && !(b.terms.alpha * at.cos_o > 9e-6f)) continue;
    vec3 wo = at_angle(at.cos_o, 0.13f);
    const double exact[3] = {(double)wo.x, (double)wo.y, (double)wo.z};
    double expected[CELLS + 1];
    counted c = {0};
    facet_shares(by, exact, (double)b.terms.alpha, expected);
    double largest = count_facets(&c, by, &b, wo, n), p = fit(&c, expected, n);
    print_message("# cos_o %.2f r %.3f by %s: p = %.3f, largest %.3f\n",
                  (double)at.cos_o, (double)at.roughness,
                  by == BY_TILT ? "tilt" : "direction", p, largest);
    assert_true(p > 1.1e-3 && largest <= 1 + 1e-6);
  }
}

// A random surface of any roughness and kind.
static bsdf_rough any_surface(const tables *t, rng *r) {
  vec3 c = {rng_next(r), rng_next(r), rng_next(r)};
  float roughness = rng_next(r), metallic = rng_next(r);
  roughness = 1e-3f + roughness * roughness;
  const dfg *table = &t->of[rng_next(r) < 0.5f ? PBR_GGX : PBR_REPORT];
  if (metallic < 0.3f) metallic = 0;
  return bsdf_rough_of(table, c, metallic > 0.7f ? 1 : metallic,
                       fminf(roughness, 1));
}

// A weight is f wi.z / pdf for every roughness at which the floats of wi still
// know their half vector, and finite for all.
static void weight_is_the_quotient(void **state) {
  rng r = rng_of(3, 0, 0);
  for (long i = 0; i < shortened(200000); i++) {
    bsdf_rough b = any_surface(*state, &r);
    vec3 wo = at_angle(1 - rng_next(&r), rng_next(&r)), wi, weight;
    float u[3] = {rng_next(&r), rng_next(&r), rng_next(&r)};
    if (!bsdf_rough_sample(&b, wo, u, &wi, &weight)) continue;
    assert_true(vec3_finite(weight) && wi.z > 0);
    assert_true(fabsf(vec3_length(wi) - 1) < 1e-6f);
    vec3 f = bsdf_rough_eval(&b, wo, wi);
    float pdf = bsdf_rough_pdf(&b, wo, wi);
    assert_true(isfinite(pdf) && pdf > 0);
    vec3 want = vec3_scale(f, wi.z / pdf);
    assert_true(vec3_length(vec3_sub(weight, want)) <
                1e-5f * vec3_length(want));
  }
}

// The coat alone never weighs more than F, from the least roughness on and at
// any angle.
static void coat_weighs_at_most_one(void **state) {
  const tables *t = *state;
  rng r = rng_of(4, 0, 0);
  for (long i = 0; i < shortened(200000); i++) {
    float x = rng_next(&r), z = rng_next(&r);
    bsdf_rough b =
        bsdf_rough_of(&t->of[PBR_GGX], WHITE, 1, fmaxf(x * x, 1e-3f));
    vec3 wo = at_angle(z * z * z, rng_next(&r)), wi, weight;
    float u[3] = {rng_next(&r), rng_next(&r), rng_next(&r)};
    if (!bsdf_rough_sample(&b, wo, u, &wi, &weight)) continue;
    assert_true(weight.x <= 1 + 1e-6f && weight.x > 0);
  }
}

// A dielectric by PBR_GGX returns all of white light, by quadrature, within
// the error of the table.
static void porcelain_loses_nothing(void **state) {
  const tables *t = *state;
  for (int i = 0; i < CASES; i++) {
    bsdf_rough b = bsdf_rough_of(&t->of[PBR_GGX], WHITE, 0, CASE[i].roughness);
    integrand light = {&b, at_angle(CASE[i].cos_o, 0), true};
    double albedo = hemisphere_integral(&light);
    print_message("# %.5f\n", albedo);
    assert_true(fabs(albedo - 1) < 1e-3);
  }
}

// Nothing happens below the surface, and below ALPHA_MIN only the ground is
// left.
static void ends(void **state) {
  const tables *t = *state;
  bsdf_rough b = bsdf_rough_of(&t->of[PBR_GGX], COPPER, 0.5f, 0.3f);
  vec3 up = at_angle(0.4f, 0.1f), down = at_angle(-0.4f, 0.7f), wi, weight;
  const float u[3] = {0.9f, 0.3f, 0.3f};
  assert_true(vec3_peak(bsdf_rough_eval(&b, up, down)) == 0);
  assert_true(vec3_peak(bsdf_rough_eval(&b, down, up)) == 0);
  assert_true(bsdf_rough_pdf(&b, up, down) == 0);
  assert_false(bsdf_rough_sample(&b, down, u, &wi, &weight));
  b = bsdf_rough_of(&t->of[PBR_GGX], COPPER, 0.5f, 0);
  vec3 mirrored = {-up.x, -up.y, up.z};
  assert_true(bsdf_rough_eval(&b, up, mirrored).x < 0.5f * COPPER.x);
  assert_float_equal(bsdf_rough_pdf(&b, up, mirrored), up.z / PI, 1e-6);
  b = bsdf_rough_of(&t->of[PBR_GGX], COPPER, 1, 0);
  assert_false(bsdf_rough_sample(&b, up, u, &wi, &weight));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(samples_follow_pdf),
      cmocka_unit_test(narrow_lobes_follow_their_facets),
      cmocka_unit_test(weight_is_the_quotient),
      cmocka_unit_test(coat_weighs_at_most_one),
      cmocka_unit_test(porcelain_loses_nothing),
      cmocka_unit_test(ends),
  };
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
