// doubling.c

#include "doubling.h"

#include "pages.h"
#include "two_means.h"

#include <math.h>
#include <string.h>

struct doubling {
  size_t pixels;
  const film *all;  // of others
  doubling_marks marks;
};

doubling *doubling_new(arena *mem, int width, int height) {
  doubling *d = ARENA_NEW(mem, doubling, 1);
  size_t n = (size_t)width * (size_t)height;
  d->pixels = n;
  d->marks.whole = ARENA_NEW(mem, vec3, n);
  d->marks.half = ARENA_NEW(mem, vec3, n);
  pages_expect(d->marks.whole, n * sizeof *d->marks.whole);
  pages_expect(d->marks.half, n * sizeof *d->marks.half);
  return d;
}

static void doubling_watch(void *self, const film *all) {
  doubling *d = self;
  d->all = all;
}

static vec3 sum_of(const film *f, size_t i) {
  const double *s = f->sum[i];
  return (vec3){(float)s[0], (float)s[1], (float)s[2]};
}

static void doubling_add(void *self, size_t i, uint32_t sample, vec3 color) {
  doubling *d = self;
  uint32_t n = d->all->count[i];
  if (n > 0 && (n & (n - 1)) == 0) {
    if (n > 1) d->marks.half[i] = d->marks.whole[i];
    d->marks.whole[i] = sum_of(d->all, i);
  }
  (void)sample, (void)color;
}

// The largest power of two that is at most n > 0.
static uint32_t power_below(uint32_t n) {
  uint32_t p = 1;
  while (p <= n / 2)
    p *= 2;
  return p;
}

// Pixels that have as many samples, from i on, n at most.
static size_t alike(const film *f, size_t i, size_t n) {
  size_t some = 1;
  while (some < n && f->count[i + some] == f->count[i])
    some++;
  return some;
}

// The means of the first and the second half of the first 2^k samples, and the
// variance of one sample, of pixels that have as many: channel after channel.
static void run_alike(const doubling *d, size_t i, size_t pixels,
                      const two_means_run *out) {
  uint32_t n = d->all->count[i], m = power_below(n);
  double of_half = 2.0 / m, of_all = 1.0 / n, of_rest = 1.0 / (n - 1);
  const double *sum = d->all->sum[i], *square = d->all->square[i];
  const float *whole = (const float *)&d->marks.whole[i];
  const float *half = (const float *)&d->marks.half[i];
  double *restrict a = out->a, *restrict b = out->b,
                   *restrict other = out->other;
  for (size_t k = 0; k < 3 * pixels; k++) {
    float w = n == m ? (float)sum[k] : whole[k];
    float h = n == m ? whole[k] : half[k];
    double spread = square[k] - sum[k] * sum[k] * of_all;
    other[k] = spread > 0 ? spread * of_rest : 0;
    a[k] = (double)h * of_half;
    b[k] = (double)(w - h) * of_half;
  }
}

static void doubling_run(const void *self, size_t i, int n,
                         const two_means_run *out) {
  const doubling *d = self;
  size_t some;
  for (size_t k = 0; k < (size_t)n; k += some) {
    some = alike(d->all, i + k, (size_t)n - k);
    bool has = d->all->count[i + k] > 1;
    two_means_run to = {out->a + 3 * k, out->b + 3 * k, out->other + 3 * k,
                        NULL};
    if (has) run_alike(d, i + k, some, &to);
    memset(out->has + k, has, some);
  }
}

// The variance of the mean of n samples as a sum of two: A n^-1.5, which even
// points leave where there is an edge in a plane (He and Wang, 2015), and B /
// n, which is chance.  `took` is by how much it fell from m / 2 samples to m,
// `differ` how much the n samples differ among each other, which lacks the
// variance of their mean.  Two samples have one difference, and it is taken for
// chance.
static double variance_left(double took, double differ, double m, double n) {
  double edge_took = pow(m / 2, -1.5) - pow(m, -1.5), chance_took = 1 / m;
  double edge_differ = (1 - pow(n, -1.5)) * n / (n - 1);
  double edge = 0, chance = took / chance_took;
  if (m > 2) {
    double both = chance_took * edge_differ - edge_took;
    edge = (chance_took * differ - took) / both;
    edge = fmin(fmax(edge, 0), took / edge_took);
    chance = (took - edge * edge_took) / chance_took;
  }
  return edge * pow(n, -1.5) + chance / n;
}

static double doubling_error(void *self, pool *threads) {
  const doubling *d = self;
  uint32_t n = d->all->count[0], m = n > 0 ? power_below(n) : 0;
  if (m < 2) return 0;
  two_means t = {d->all->width, d->all->height, d, doubling_run};
  two_means_sums s = two_means_measure(&t, NULL, threads);
  return sqrt(variance_left(s.square, s.other, m, n));
}

render_guide doubling_guide(doubling *d) {
  return (render_guide){.self = d,
                        .watch = doubling_watch,
                        .add = doubling_add,
                        .error = doubling_error};
}

doubling_marks doubling_look(const doubling *d) {
  return d->marks;
}

void doubling_go_on(doubling *d, const doubling_marks *marks) {
  memcpy(d->marks.whole, marks->whole, d->pixels * sizeof *marks->whole);
  memcpy(d->marks.half, marks->half, d->pixels * sizeof *marks->half);
}
