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

// The rate r at which variance falls by doubling, if it always was the same,
// after n samples.  V is the variance of one: of the mean of n, n^log2(r) V is
// left, and so the samples differ by (1 - n^log2(r)) V n / (n - 1) only.  Of
// that, `left` is what the last of k doublings took, r^(k-1) (1 - r) V. Limits:
// r = 1/2 is chance, 1/8 is as smooth as it gets; two halves of one sample each
// tell nothing of r.
static double rate_of(double left, int k, double n) {
  double low = k > 1 ? 0.125 : 0.5, high = 0.5;
  for (int i = 0; i < 40; i++) {
    double r = (low + high) / 2, differ = (1 - pow(n, log2(r))) * n / (n - 1);
    if (pow(r, k - 1) * (1 - r) > left * differ)
      high = r;
    else
      low = r;
  }
  return (low + high) / 2;
}

static double doubling_error(void *self, pool *threads) {
  const doubling *d = self;
  uint32_t n = d->all->count[0], m = n > 0 ? power_below(n) : 0;
  if (m < 2) return 0;
  two_means t = {d->all->width, d->all->height, d, doubling_run};
  two_means_sums s = two_means_measure(&t, NULL, threads);
  if (!(s.other > 0)) return 0;
  int k = 0;
  while (1u << (k + 1) <= m)
    k++;
  double r = rate_of(s.square / s.other, k, n);
  // E[((a - b) / 2)^2] = V(k-1) - V(k) = V(k) (1 - r) / r, and from there on to
  // n samples.
  double at_power = s.square * r / (1 - r);
  return sqrt(at_power * pow((double)m / n, -log2(r)));
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
