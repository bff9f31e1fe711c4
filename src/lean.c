// lean.c

#include "lean.h"

#include "bsdf_rough.h"

// The panels of the integral, along and around; each has four Gauss points.
enum { LEAN_PANELS = 6, LEAN_POINTS = 4 * LEAN_PANELS };

// Point i of a rule on [0, 1], and its weight.
static double lean_point(int i, double *weight) {
  static const double x[4] = {0.0694318442029737, 0.3300094782075719,
                              0.6699905217924281, 0.9305681557970263};
  static const double w[4] = {0.1739274225687269, 0.3260725774312731,
                              0.3260725774312731, 0.1739274225687269};
  *weight = w[i % 4] / LEAN_PANELS;
  return (i / 4 + x[i % 4]) / LEAN_PANELS;
}

// Sums of light that is thrown along the normal and along the surface.
typedef struct lean_sums {
  double up[2], along[2];
} lean_sums;

// Add the light that a visible normal throws, of that weight.
static void lean_add(lean_sums *s, vec3 wo, vec3 h, float alpha, double w) {
  float oh = vec3_dot(wo, h);
  vec3 wi = vec3_sub(vec3_scale(h, 2 * oh), wo);
  if (!(wi.z > 0)) return;
  float g1 = ggx_g1_over_4nv(wo.z, alpha);
  w *= (double)(ggx_v(wi.z, wo.z, alpha) * wi.z / g1);
  double f = (double)fresnel_schlick(vec3_all(0), oh).x;
  const double share[2] = {w * (1 - f), w * f};
  for (int k = 0; k < 2; k++) {
    s->up[k] += share[k] * (double)wi.z;
    s->along[k] -= share[k] * (double)wi.x;
  }
}

// At the normal itself, and along the surface, R and n do not span a plane:
// from this far on the coefficients are those of the neighbour.
#define LEAN_SINE_MIN 0.01f

// Normals are taken as the viewer sees them, so that D and one half of the
// shadowing are in the density of points.  Half of them are enough: the plane
// of normal and viewer is a mirror.
lean_pair lean_integral(float nv, float roughness) {
  float alpha = roughness * roughness;
  float m = 1 - nv, f = m * m * m * m * m;
  if (!(alpha >= ALPHA_MIN)) return (lean_pair){1 - f, 0, f, 0};
  float c = fminf(fmaxf(nv, 1e-4f), 1 - 0.5f * LEAN_SINE_MIN * LEAN_SINE_MIN);
  vec3 wo = {sqrtf((1 - c) * (1 + c)), 0, c};
  lean_sums s = {{0}, {0}};
  for (int i = 0; i < LEAN_POINTS; i++)
    for (int k = 0; k < LEAN_POINTS; k++) {
      double wi, wk, x = 1 - lean_point(i, &wi), turn = lean_point(k, &wk);
      float u1 = (float)(1 - x * x), u2 = (float)(0.25 + 0.5 * turn);
      lean_add(&s, wo, ggx_visible_normal(wo, alpha, u1, u2), alpha,
               2 * x * wi * wk);
    }
  double r1 = s.along[0] / (double)wo.x, r2 = s.along[1] / (double)wo.x;
  return (lean_pair){(float)r1, (float)(s.up[0] - r1 * (double)c), (float)r2,
                     (float)(s.up[1] - r2 * (double)c)};
}

// What the threads need to fill rows.
typedef struct lean_job {
  lean_pair *table;
  bool wanted[LEAN_ROWS];
} lean_job;

static void lean_fill_row(void *context, size_t item, int worker) {
  (void)worker;
  const lean_job *job = context;
  if (!job->wanted[item]) return;
  float y = (float)item / (LEAN_ROWS - 1);
  for (int i = 0; i < LEAN_COLUMNS; i++) {
    float x = (float)i / (LEAN_COLUMNS - 1);
    job->table[item * LEAN_COLUMNS + (size_t)i] = lean_integral(x * x, y * y);
  }
}

static void lean_fill(lean *out, lean_job *job, arena *mem, pool *threads) {
  out->table = ARENA_NEW(mem, lean_pair, (size_t)LEAN_ROWS * LEAN_COLUMNS);
  job->table = out->table;
  pool_run(threads, LEAN_ROWS, lean_fill_row, job);
}

void lean_build(lean *out, arena *mem, pool *threads) {
  lean_job job;
  for (int y = 0; y < LEAN_ROWS; y++)
    job.wanted[y] = true;
  lean_fill(out, &job, mem, threads);
}

// (1 - t) a + t b.
static lean_pair lean_mix(lean_pair a, lean_pair b, float t) {
  return (lean_pair){a.r1 + t * (b.r1 - a.r1), a.n1 + t * (b.n1 - a.n1),
                     a.r2 + t * (b.r2 - a.r2), a.n2 + t * (b.n2 - a.n2)};
}

// Where the square root of x lies between n nodes: its cell, and the place in
// it.
static int lean_cell(float x, int n, float *t) {
  float at = sqrtf(fminf(fmaxf(x, 0), 1)) * (float)(n - 1);
  int i = (int)at < n - 2 ? (int)at : n - 2;
  *t = at - (float)i;
  return i;
}

// As in dfg.c: so near to a row a graphics card may read the one beyond.
#define LEAN_SLACK 0.01f

void lean_build_for(lean *out, const float *roughness, int count, arena *mem,
                    pool *threads) {
  lean_job job = {.table = NULL};
  for (int i = 0; i < count; i++) {
    float t;
    int y = lean_cell(roughness[i], LEAN_ROWS, &t);
    job.wanted[y] = job.wanted[y + 1] = true;
    if (t < LEAN_SLACK && y > 0) job.wanted[y - 1] = true;
    if (t > 1 - LEAN_SLACK && y + 2 < LEAN_ROWS) job.wanted[y + 2] = true;
  }
  lean_fill(out, &job, mem, threads);
}

lean_pair lean_lookup(const lean *l, float nv, float roughness) {
  float tx, ty;
  int x = lean_cell(nv, LEAN_COLUMNS, &tx);
  int y = lean_cell(roughness, LEAN_ROWS, &ty);
  const lean_pair *a = l->table + y * LEAN_COLUMNS + x, *b = a + LEAN_COLUMNS;
  return lean_mix(lean_mix(a[0], a[1], tx), lean_mix(b[0], b[1], tx), ty);
}

vec3 lean_towards(const lean *l, vec3 n, vec3 wo, float f0, float roughness) {
  float nv = vec3_dot(n, wo);
  lean_pair p = lean_lookup(l, nv, roughness);
  vec3 mirrored = vec3_sub(vec3_scale(n, 2 * nv), wo);
  vec3 sum = vec3_scale(mirrored, f0 * p.r1 + p.r2);
  return vec3_unit(vec3_mad(sum, f0 * p.n1 + p.n2, n));
}
