// dfg.c — the integral in coordinates where it is a ratio of polynomials.

#include "dfg.h"

#include "num.h"

#include <stdint.h>
#include <string.h>

// Gauss points along each half of the meridian, and around.
enum { DFG_ALONG = 20, DFG_AROUND = 18, DFG_POINTS = 20 };

// Points and weights of a Gauss-Legendre rule on [0, 1].
typedef struct gauss_rule {
  int n;
  double x[DFG_POINTS], w[DFG_POINTS];
} gauss_rule;

// The Legendre polynomial of degree n at x, and its derivative.
static double legendre_at(int n, double x, double *slope) {
  double p0 = 1, p1 = x;
  for (int k = 2; k <= n; k++) {
    double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
    p0 = p1, p1 = p2;
  }
  *slope = n * (x * p1 - p0) / (x * x - 1);
  return p1;
}

// Newton's method from Chebyshev's points.
static gauss_rule gauss_rule_of(int n) {
  gauss_rule g = {.n = n};
  for (int i = 0; i < n; i++) {
    float turn = ((float)i + 0.75f) / ((float)n + 0.5f) * 0.5f;
    double x = (double)num_circle(turn).x, slope = 1;
    for (int k = 0; k < 6; k++) {
      double p = legendre_at(n, x, &slope);
      x -= p / slope;
    }
    (void)legendre_at(n, x, &slope);
    g.x[i] = 0.5 - 0.5 * x;
    g.w[i] = 1 / ((1 - x * x) * slope * slope);
  }
  return g;
}

// What stays the same while light goes around: sines and cosines of viewer
// and light to the normal, and alpha.
typedef struct dfg_ring {
  double so, nv, si, nl, alpha;
} dfg_ring;

// A pair in double, for sums.
typedef struct dfg_sum {
  double c1, c2;
} dfg_sum;

// A variable that is fine around 0: scale sinh(octaves ln2 x) for x in [0, 1].
typedef struct dfg_zoom {
  double scale;
  float octaves;
} dfg_zoom;

// The one that is `range` at x = 1.
static dfg_zoom dfg_zoom_to(double range, double scale) {
  double ratio = range / scale;
  float octaves = num_log2((float)(ratio + sqrt(1 + ratio * ratio)));
  return (dfg_zoom){scale, octaves};
}

// 2^y for y in [0, 1000], to 1e-8: num_exp2 without its tenfold division, as
// half of the table's time went there.
static double dfg_exp2(double y) {
  int n = (int)(y + 0.5);
  double x = (y - n) * 0.693147180559945;
  double series =
      1 +
      x * (1 + x * (1.0 / 2 +
                    x * (1.0 / 6 +
                         x * (1.0 / 24 +
                              x * (1.0 / 120 + x * (1.0 / 720 + x / 5040))))));
  uint64_t bits = (uint64_t)(n + 1023) << 52;
  double power;
  memcpy(&power, &bits, sizeof power);
  return power * series;
}

// Its value at x and, in *step, its derivative.
static double dfg_zoom_at(dfg_zoom z, double x, double *step) {
  double e = dfg_exp2((double)z.octaves * x);
  *step = z.scale * 0.5 * (e + 1 / e) * (double)z.octaves * 0.693147180559945;
  return z.scale * 0.5 * (e - 1 / e);
}

// Twice the integral of D (1, (1 - oh)^5) over the azimuth from the mirror
// direction to the viewer's side, by p = tan(azimuth / 4) in [0, 1].  D is
// alpha^2 |s|^4 / (pi (across^2 + alpha^2 up^2)^2) for the sum s = wo + wi.
static dfg_sum ring_integral(const dfg_ring *r, const gauss_rule *g) {
  double apart = (r->si - r->so) * (r->si - r->so), up = r->nl + r->nv;
  double both = fmax(r->si * r->so, 1e-30), up2 = up * up;
  double base = apart + r->alpha * r->alpha * up2;
  dfg_zoom z = dfg_zoom_to(1, fmin(0.25 * sqrt(base / both), 1));
  dfg_sum sum = {0, 0};
  for (int i = 0; i < g->n; i++) {
    double step, p = dfg_zoom_at(z, g->x[i], &step);
    double q = 1 / (1 + p * p), half = 2 * p * q;  // sin(azimuth / 2)
    double gap = 4 * both * half * half;
    double s2 = apart + gap + up2, m = 1 - 0.5 * sqrt(s2), m2 = m * m;
    double d = r->alpha * s2 / (base + gap), f = m2 * m2 * m;
    double w = g->w[i] * step * 4 * q * d * d;
    sum.c1 += w * (1 - f);
    sum.c2 += w * f;
  }
  const double scale = 2 / 3.14159265358979324;
  return (dfg_sum){scale * sum.c1, scale * sum.c2};
}

// V nl of the set of formulas.
static double dfg_shadowing(pbr_model model, const dfg_ring *r) {
  double a2 = r->alpha * r->alpha;
  if (model == PBR_REPORT) {
    double k = r->alpha / 2;
    return 0.25 * r->nl / ((r->nl * (1 - k) + k) * (r->nv * (1 - k) + k));
  }
  double rv = sqrt(r->nv * r->nv + a2 * r->so * r->so);
  double rl = sqrt(r->nl * r->nl + a2 * r->si * r->si);
  return 0.5 * r->nl / (r->nl * rv + r->nv * rl);
}

// Both rules, made once.
typedef struct dfg_rules {
  gauss_rule along, around;
} dfg_rules;

static dfg_rules dfg_rules_new(void) {
  return (dfg_rules){gauss_rule_of(DFG_ALONG), gauss_rule_of(DFG_AROUND)};
}

// Over the lights on one side of the mirror direction, from it to the normal
// (end 0) or to the horizon (end 1).  They are counted by tau = tan(angle / 2)
// = mirror +- a zoom: fine near the mirror direction, and near the horizon
// when the viewer is there.
static dfg_sum side_integral(pbr_model model, dfg_ring r, double end,
                             const dfg_rules *g) {
  double mirror = r.so / (1 + r.nv), range = fabs(end - mirror);
  double sign = end < mirror ? -1 : 1;
  dfg_zoom z = dfg_zoom_to(range, fmin(r.alpha, fmax(r.nv, 1e-3)));
  dfg_sum sum = {0, 0};
  for (int i = 0; i < g->along.n; i++) {
    double step, zoomed = dfg_zoom_at(z, g->along.x[i], &step);
    double tau = mirror + sign * zoomed, q = 1 / (1 + tau * tau);
    r.si = 2 * tau * q;
    r.nl = (1 - tau) * (1 + tau) * q;
    if (!(r.nl > 0) || !(r.si > 0)) continue;
    double w = g->along.w[i] * step * 2 * q * r.si * dfg_shadowing(model, &r);
    dfg_sum d = ring_integral(&r, &g->around);
    sum.c1 += w * d.c1;
    sum.c2 += w * d.c2;
  }
  return sum;
}

// With the rules at hand.
static dfg_pair integral_by(const dfg_rules *g, pbr_model model, float nv,
                            float roughness) {
  double alpha = (double)roughness * (double)roughness;
  if (!(alpha >= (double)ALPHA_MIN)) {
    float m = 1 - nv, f = m * m * m * m * m;
    return (dfg_pair){1 - f, f};
  }
  double c = fmax((double)nv, 1e-6);
  dfg_ring r = {.so = sqrt((1 - c) * (1 + c)), .nv = c, .alpha = alpha};
  dfg_sum a = side_integral(model, r, 0, g), b = side_integral(model, r, 1, g);
  return (dfg_pair){(float)(a.c1 + b.c1), (float)(a.c2 + b.c2)};
}

dfg_pair dfg_integral(pbr_model model, float nv, float roughness) {
  dfg_rules g = dfg_rules_new();
  return integral_by(&g, model, nv, roughness);
}

// The mean of a row by 2 nv dnv = 4 x^3 dx, x = sqrt(NoV); Simpson's rule.
static dfg_pair row_mean(const dfg_pair *row) {
  double c1 = 0, c2 = 0, h = 1.0 / (DFG_COLUMNS - 1);
  for (int i = 0; i < DFG_COLUMNS; i++) {
    double x = i * h, w = i == 0 || i == DFG_COLUMNS - 1 ? 1 : i % 2 ? 4 : 2;
    w *= 4 * x * x * x * h / 3;
    c1 += w * (double)row[i].c1;
    c2 += w * (double)row[i].c2;
  }
  return (dfg_pair){(float)c1, (float)c2};
}

// What the threads need to fill rows.
typedef struct dfg_job {
  dfg *out;
  dfg_rules rules;
  bool wanted[DFG_ROWS];
} dfg_job;

static void fill_row(void *context, size_t item, int worker) {
  (void)worker;
  const dfg_job *job = context;
  dfg *d = job->out;
  if (!job->wanted[item]) return;
  dfg_pair *row = d->table + item * DFG_COLUMNS;
  float y = (float)item / (DFG_ROWS - 1);
  for (int i = 0; i < DFG_COLUMNS; i++) {
    float x = (float)i / (DFG_COLUMNS - 1);
    row[i] = integral_by(&job->rules, d->model, x * x, y * y);
  }
  d->mean[item] = row_mean(row);
}

static void fill_rows(dfg_job *job, pbr_model model, arena *mem,
                      pool *threads) {
  job->rules = dfg_rules_new();
  job->out->model = model;
  job->out->table = ARENA_NEW(mem, dfg_pair, (size_t)DFG_ROWS * DFG_COLUMNS);
  job->out->mean = ARENA_NEW(mem, dfg_pair, (size_t)DFG_ROWS);
  pool_run(threads, DFG_ROWS, fill_row, job);
}

void dfg_build(dfg *out, pbr_model model, arena *mem, pool *threads) {
  dfg_job job = {.out = out};
  for (int y = 0; y < DFG_ROWS; y++)
    job.wanted[y] = true;
  fill_rows(&job, model, mem, threads);
}

// (1 - t) a + t b.
static dfg_pair dfg_mix(dfg_pair a, dfg_pair b, float t) {
  return (dfg_pair){a.c1 + t * (b.c1 - a.c1), a.c2 + t * (b.c2 - a.c2)};
}

// Where x in [0, 1] lies between n nodes: its cell, and the place in it.
static int dfg_cell(float x, int n, float *t) {
  float at = float_min(float_max(x, 0), 1) * (float)(n - 1);
  int i = (int)at < n - 2 ? (int)at : n - 2;
  *t = at - (float)i;
  return i;
}

// A graphics card knows a place to 1/256 of a cell: so near to a row it may
// read the one beyond.
#define DFG_SLACK 0.01f

void dfg_build_for(dfg *out, dfg_need need, arena *mem, pool *threads) {
  dfg_job job = {.out = out};
  for (size_t i = 0; i < need.count; i++) {
    float t;
    int y = dfg_cell(sqrtf(fmaxf(need.roughness[i], 0)), DFG_ROWS, &t);
    job.wanted[y] = job.wanted[y + 1] = true;
    if (t < DFG_SLACK && y > 0) job.wanted[y - 1] = true;
    if (t > 1 - DFG_SLACK && y + 2 < DFG_ROWS) job.wanted[y + 2] = true;
  }
  fill_rows(&job, need.model, mem, threads);
}

dfg_pair dfg_lookup(const dfg *d, float nv, float roughness) {
  float tx, ty;
  int x = dfg_cell(sqrtf(float_max(nv, 0)), DFG_COLUMNS, &tx);
  int y = dfg_cell(sqrtf(float_max(roughness, 0)), DFG_ROWS, &ty);
  const dfg_pair *a = d->table + y * DFG_COLUMNS + x, *b = a + DFG_COLUMNS;
  return dfg_mix(dfg_mix(a[0], a[1], tx), dfg_mix(b[0], b[1], tx), ty);
}

dfg_pair dfg_lookup_mean(const dfg *d, float roughness) {
  float t;
  int y = dfg_cell(sqrtf(float_max(roughness, 0)), DFG_ROWS, &t);
  return dfg_mix(d->mean[y], d->mean[y + 1], t);
}
