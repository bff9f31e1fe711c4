// twice.c — paths by floats against the same paths by doubles: how far they
// are apart after so many bounces, and what that does to the mean.

#include "kernel.h"
#include "stress.h"

typedef struct pair {
  kernel_request ask;
  double *a, *b;
} pair;

static void try_batch(void *context, size_t item, int worker) {
  (void)worker;
  const pair *p = context;
  kernel_request q = p->ask;
  q.first = item * q.n;
  kernel_float(&q, p->a + q.first);
  kernel_double(&q, p->b + q.first);
}

static int by_size(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

// A row for paths of one length, or two more for the longest.
static void compare(stress *s, int depth, size_t n, bool last) {
  size_t parts = s->size == STRESS_SHORT ? 1 : 4;
  pair p = {.ask = {.max_depth = depth, .seed = 17 + s->slice, .n = n / parts}};
  p.a = calloc(2 * n, sizeof *p.a);
  p.b = p.a + n;
  pool_run(s->threads, parts, try_batch, &p);
  double sum = 0, difference = 0, square = 0, wrong = 0, parted = 0;
  size_t lit = 0;
  double *off = calloc(n, sizeof *off);
  for (size_t i = 0; i < n; i++) {
    double d = p.a[i] - p.b[i];
    wrong += !isfinite(p.a[i]) || !isfinite(p.b[i]);
    sum += p.b[i];
    difference += d;
    square += d * d;
    if (p.b[i] > 0) off[lit++] = fabs(d) / p.b[i];
    parted += fabs(d) > 0.01 * p.b[i];
  }
  qsort(off, lit, sizeof *off, by_size);
  double mean = difference / (double)n;
  double error = sqrt(fmax(square / (double)n - mean * mean, 0) / (double)n);
  char what[80];
  snprintf(what, sizeof what, "float to double, %d segments: 99 %% within",
           depth);
  stress_print(s,
               (stress_row){what, (double)n, wrong,
                            lit > 0 ? off[lit * 99 / 100] : 1, 1e-4, "none"});
  if (last) {
    stress_print(s,
                 (stress_row){"the same: share of paths that went elsewhere",
                              (double)n, 0, parted / (double)n, 1e-2, "none"});
    double z = fabs(mean) / (error + 1e-7 * sum / (double)n);
    stress_print(s, (stress_row){"the same: z of the difference of the means",
                                 (double)n, 0, z, 4, "none"});
  }
  free(off);
  free(p.a);
}

void stress_twice(stress *s) {
  size_t n = stress_count(s, 2e3, 1e5, 2e6);
  const int depth[] = {2, 4, 8, 16};
  for (int i = s->size == STRESS_SHORT ? 2 : 0; i < 4; i++)
    compare(s, depth[i], n, i == 3);
}
