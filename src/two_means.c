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

// A row is as wide as its pixels have channels.
enum { NEXT = 3, WIDE = NEXT * PATCH, SEEN_WIDE = NEXT * SEEN };

// The patch whose first pixel is (x, y), with as many rows; row r and column k
// of what is seen are the pixel (x + k - REACH, y + r - REACH).  Channel by
// channel, and 0 where there is no pixel:
typedef struct patch {
  int x, y, rows;
  bool whole;                      // a pixel is everywhere
  double there[SEEN][SEEN_WIDE];   // 1 where there is one
  double mean[SEEN][SEEN_WIDE];    // (a + b) / 2
  double mean2[SEEN][SEEN_WIDE];   // its square
  double square[SEEN][SEEN_WIDE];  // ((a - b) / 2)^2
  double other[SEEN][SEEN_WIDE];
  // Sums over channels: of squares, and of what is averaged like them.
  double terms[PATCH][PATCH], others[PATCH][PATCH];
} patch;

static double more(double a, double b) {
  return a > b ? a : b;
}

// For all of a row: sums over the windows of its pixels, without these pixels
// themselves.  First columns are added up, with and without the row, then three
// of them.  Nothing is taken off again, where one pixel may be a million times
// the others.
static void sum_others(double (*seen)[SEEN_WIDE], int row,
                       double *restrict out) {
  double own[SEEN_WIDE], column[SEEN_WIDE];
  const double *above = seen[row - 1], *at = seen[row], *below = seen[row + 1];
  for (int k = 0; k < SEEN_WIDE; k++) {
    own[k] = above[k] + below[k];
    column[k] = own[k] + at[k];
  }
  for (int k = 0; k < WIDE; k++)
    out[k] = column[k] + own[k + NEXT] + column[k + 2 * NEXT];
}

// The others of the pixels of a row: 1 / number, 1 / (number - 1); where there
// are not two both are 0, and lone is 1.
typedef struct others {
  double each[WIDE], rest[WIDE], lone[WIDE];
} others;

static void count_others(patch *p, int row, others *restrict out) {
  double n[WIDE];
  sum_others(p->there, row, n);
  for (int k = 0; k < WIDE; k++) {
    out->each[k] = n[k] > 1 ? 1 / n[k] : 0;
    out->rest[k] = n[k] > 1 ? 1 / (n[k] - 1) : 0;
    out->lone[k] = n[k] > 1 ? 0 : 1;
  }
}

// The terms of a row.  Radiance is as a pixel and its neighbours let expect it:
// the neighbours have a mean, vary around it by themselves (spread), and all
// are uncertain.  The less certain the pixel is, the more its neighbours count.
// Who has not two of them has only itself.  Source: James and Stein, 1961.
static void find_terms(patch *p, int row, const others *restrict n) {
  double mean_sum[WIDE], mean2_sum[WIDE], square_sum[WIDE], shares[WIDE];
  sum_others(p->mean, row, mean_sum);
  sum_others(p->mean2, row, mean2_sum);
  sum_others(p->square, row, square_sum);
  const double *means = &p->mean[row][NEXT], *means2 = &p->mean2[row][NEXT];
  const double *squares = &p->square[row][NEXT], *other = &p->other[row][NEXT];
  for (int k = 0; k < WIDE; k++) {
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
  double *restrict rests = p->others[row - REACH];
  for (int k = 0; k < PATCH; k++) {
    const double *s = &shares[NEXT * k], *square = &squares[NEXT * k];
    const double *rest = &other[NEXT * k];
    terms[k] = s[0] * square[0] + s[1] * square[1] + s[2] * square[2];
    rests[k] = s[0] * rest[0] + s[1] * rest[1] + s[2] * rest[2];
  }
}

// What a row of the picture knows of what is seen of it.
typedef struct row_seen {
  double a[SEEN_WIDE], b[SEEN_WIDE], other[SEEN_WIDE];
  bool has[SEEN];
} row_seen;

// Ask for row number `row`.
static void ask_row(const patch *p, const two_means *t, int row, row_seen *q) {
  int left = p->x - REACH, x0 = left < 0 ? 0 : left, y = p->y + row - REACH;
  int x1 = left + SEEN < t->width ? left + SEEN : t->width;
  memset(q, 0, sizeof *q);
  if (y < 0 || y >= t->height) return;
  size_t i = (size_t)y * (size_t)t->width + (size_t)x0;
  size_t k = (size_t)(x0 - left), at = NEXT * k;
  two_means_run out = {q->a + at, q->b + at, q->other + at, q->has + k};
  t->run(t->self, i, x1 - x0, &out);
}

// Take it down; how many pixels there are.
static int see_row(patch *p, int row, const row_seen *q) {
  double *there = p->there[row];
  int count = 0;
  for (int k = 0; k < SEEN; k++) {
    count += q->has[k];
    for (int c = 0; c < NEXT; c++)
      there[NEXT * k + c] = q->has[k] ? 1 : 0;
  }
  for (int k = 0; k < SEEN_WIDE; k++) {
    double a = there[k] > 0 ? q->a[k] : 0, b = there[k] > 0 ? q->b[k] : 0;
    double mean = (a + b) / 2, half = (a - b) / 2;
    p->mean[row][k] = mean;
    p->mean2[row][k] = mean * mean;
    p->square[row][k] = half * half;
    p->other[row][k] = there[k] > 0 ? q->other[k] : 0;
  }
  return count;
}

// See the pixels; how many there are.
static int see_pixels(patch *p, const two_means *t) {
  int count = 0;
  row_seen q;
  for (int row = 0; row < p->rows + 2 * REACH; row++) {
    ask_row(p, t, row, &q);
    count += see_row(p, row, &q);
  }
  p->whole = count == (p->rows + 2 * REACH) * SEEN;
  return count;
}

static void measure_patch(patch *p) {
  others n;
  for (int row = REACH; row < p->rows + REACH; row++) {
    if (row == REACH || !p->whole) count_others(p, row, &n);
    find_terms(p, row, &n);
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
      out->sums.other += p->others[row][k];
      out->pixels += p->there[row + REACH][NEXT * (k + REACH)];
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
  memset(p->others, 0, sizeof p->others);
  if (see_pixels(p, t) > 0) measure_patch(p);
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
