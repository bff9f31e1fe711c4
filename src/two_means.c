// two_means.c — the trick: ((a - b) / 2)^2 has the expectation of the squared
// error of (a + b) / 2, whatever makes that error.  What is left to guess is
// the radiance to divide by, and a pixel must not be its own judge there: the
// sample that made it wrong made it bright.

#include "two_means.h"

#include <math.h>
#include <string.h>

// A pixel asks those of a window around it: REACH to each side.
enum { REACH = 1 };

// A side of a patch, which is what a thread does at once; the pixels around it
// are seen, too.  All are constants, for vector instructions.
enum { PATCH = 32, SEEN = PATCH + 2 * REACH };

// One channel of the pixels that are seen; 0 where there is none.
typedef struct channel {
  double mean[SEEN][SEEN];    // (a + b) / 2
  double mean2[SEEN][SEEN];   // its square
  double square[SEEN][SEEN];  // ((a - b) / 2)^2
  double other[SEEN][SEEN];
} channel;

// The patch whose first pixel is (x, y), with as many rows; row r and column k
// of what is seen are the pixel (x + k - REACH, y + r - REACH).
typedef struct patch {
  int x, y, rows;
  double there[SEEN][SEEN];  // 1 where there is a pixel
  channel seen[3];
  // Sums over channels: of squares, and of what is averaged like them.
  double terms[PATCH][PATCH], other[PATCH][PATCH];
} patch;

static double more(double a, double b) {
  return a > b ? a : b;
}

// For all of a row: sums over the windows of its pixels, without these pixels
// themselves.  First columns are added up, with and without the row, then three
// of them.  Nothing is taken off again, where one pixel may be a million times
// the others.
static void sum_others(const double (*seen)[SEEN], int row,
                       double *restrict out) {
  double own[SEEN], column[SEEN];
  const double *above = seen[row - 1], *at = seen[row], *below = seen[row + 1];
  for (int k = 0; k < SEEN; k++) {
    own[k] = above[k] + below[k];
    column[k] = own[k] + at[k];
  }
  for (int k = 0; k < PATCH; k++)
    out[k] = column[k] + own[k + 1] + column[k + 2];
}

// The others of the pixels of a row: 1 / number, 1 / (number - 1); where there
// are not two both are 0, and lone is 1.
typedef struct others {
  double each[PATCH], rest[PATCH], lone[PATCH];
} others;

static void count_others(const patch *p, int row, others *restrict out) {
  double n[PATCH];
  sum_others(p->there, row, n);
  for (int k = 0; k < PATCH; k++) {
    out->each[k] = n[k] > 1 ? 1 / n[k] : 0;
    out->rest[k] = n[k] > 1 ? 1 / (n[k] - 1) : 0;
    out->lone[k] = n[k] > 1 ? 0 : 1;
  }
}

// Add a channel to the terms of a row.  Radiance is as a pixel and its
// neighbours let expect it: the neighbours have a mean, vary around it by
// themselves (spread), and all are uncertain.  The less certain the pixel is,
// the more its neighbours count.  Who has not two of them has only itself.
// Source: James and Stein, 1961.
static void add_terms(patch *p, const channel *c, int row,
                      const others *restrict n) {
  double mean_sum[PATCH], mean2_sum[PATCH], square_sum[PATCH], shares[PATCH];
  sum_others(c->mean, row, mean_sum);
  sum_others(c->mean2, row, mean2_sum);
  sum_others(c->square, row, square_sum);
  const double *means = &c->mean[row][REACH], *means2 = &c->mean2[row][REACH];
  const double *squares = &c->square[row][REACH];
  for (int k = 0; k < PATCH; k++) {
    double each = n->each[k];
    double around = mean_sum[k] * each, noise = square_sum[k] * each;
    double vary = (mean2_sum[k] - mean_sum[k] * around) * n->rest[k];
    double spread = more(vary - noise, 0);
    double trust = spread / more(spread + squares[k], 1e-300);
    double likely = around + trust * (means[k] - around);
    double lone = n->lone[k] * more(means2[k] - squares[k], 0);
    shares[k] = 1 / (likely * likely + lone + 0.01);
  }
  double *restrict terms = p->terms[row - REACH];
  double *restrict other = p->other[row - REACH];
  for (int k = 0; k < PATCH; k++) {
    terms[k] += shares[k] * squares[k];
    other[k] += shares[k] * c->other[row][k + REACH];
  }
}

// Whether there is one.
static bool see_pixel(patch *p, const two_means *t, int row, int column) {
  int x = p->x + column - REACH, y = p->y + row - REACH;
  size_t i = (size_t)y * (size_t)t->width + (size_t)x;
  two_means_pixel q = {{0}, {0}, {0}};
  bool there = x >= 0 && x < t->width && y >= 0 && y < t->height &&
               t->pixel(t->self, i, &q);
  p->there[row][column] = there;
  for (int c = 0; c < 3; c++) {
    channel *of = &p->seen[c];
    double mean = (q.a[c] + q.b[c]) / 2, half = (q.a[c] - q.b[c]) / 2;
    of->mean[row][column] = there ? mean : 0;
    of->mean2[row][column] = there ? mean * mean : 0;
    of->square[row][column] = there ? half * half : 0;
    of->other[row][column] = there ? q.other[c] : 0;
  }
  return there;
}

// Whether there is any.
static bool see_pixels(patch *p, const two_means *t) {
  bool any = false;
  for (int row = 0; row < p->rows + 2 * REACH; row++)
    for (int k = 0; k < SEEN; k++)
      any |= see_pixel(p, t, row, k);
  return any;
}

static void measure_patch(patch *p) {
  for (int row = REACH; row < p->rows + REACH; row++) {
    others n;
    count_others(p, row, &n);
    for (int c = 0; c < 3; c++)
      add_terms(p, &p->seen[c], row, &n);
  }
}

// The sums of a patch, and its pixels.
typedef struct patch_sums {
  two_means_sums sums;
  double pixels;
} patch_sums;

static void sum_patch(const patch *p, patch_sums *out) {
  for (int row = 0; row < p->rows; row++)
    for (int k = 0; k < PATCH; k++) {
      double term = p->terms[row][k];
      out->sums.square += term;
      out->sums.doubt += term * term;
      out->sums.other += p->other[row][k];
      out->pixels += p->there[row + REACH][k + REACH];
    }
}

// Hand out the terms of the pixels that are there, row by row.
static void copy_terms(const patch *p, const two_means *t, double *terms) {
  int columns = t->width - p->x < PATCH ? t->width - p->x : PATCH;
  for (int row = 0; row < p->rows; row++) {
    size_t first = (size_t)(p->y + row) * (size_t)t->width + (size_t)p->x;
    memcpy(terms + first, p->terms[row], (size_t)columns * sizeof *terms);
  }
}

typedef struct measuring {
  const two_means *of;
  double *terms;  // NULL: nobody wants them
  patch *room;    // of each worker
  patch_sums *out;
} measuring;

static int patches(int length) {
  return (length + PATCH - 1) / PATCH;
}

static void measure_item(void *context, size_t item, int worker) {
  const measuring *m = context;
  const two_means *t = m->of;
  int across = patches(t->width);
  patch *p = &m->room[worker];
  p->x = (int)item % across * PATCH;
  p->y = (int)item / across * PATCH;
  p->rows = t->height - p->y < PATCH ? t->height - p->y : PATCH;
  memset(p->terms, 0, sizeof p->terms);
  memset(p->other, 0, sizeof p->other);
  if (see_pixels(p, t)) measure_patch(p);
  sum_patch(p, &m->out[item]);
  if (m->terms != NULL) copy_terms(p, t, m->terms);
}

two_means_sums two_means_measure(const two_means *t, double *terms,
                                 pool *threads) {
  arena scratch = {0};
  size_t items = (size_t)patches(t->width) * (size_t)patches(t->height);
  size_t workers = threads != NULL ? (size_t)pool_threads(threads) : 1;
  measuring m = {t, terms, ARENA_NEW(&scratch, patch, workers),
                 ARENA_NEW(&scratch, patch_sums, items)};
  pool_run(threads, items, measure_item, &m);
  two_means_sums sums = {0, 0, 0};
  double pixels = 0;
  for (size_t i = 0; i < items; i++) {
    sums.square += m.out[i].sums.square;
    sums.other += m.out[i].sums.other;
    sums.doubt += m.out[i].sums.doubt;
    pixels += m.out[i].pixels;
  }
  arena_free(&scratch);
  if (!(pixels > 0)) return sums;
  return (two_means_sums){sums.square / (3 * pixels), sums.other / (3 * pixels),
                          sqrt(sums.doubt) / (3 * pixels)};
}
