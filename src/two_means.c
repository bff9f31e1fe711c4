// two_means.c — the trick: ((a - b) / 2)^2 has the expectation of the squared
// error of (a + b) / 2, whatever makes that error.  What is left to guess is
// the radiance to divide by, and a pixel must not be its own judge there: the
// sample that made it wrong made it bright.

#include "two_means.h"

#include <math.h>
#include <string.h>

// A pixel asks those of a window around it: REACH to each side.  A patch is
// what a thread does at once.  The pixels around it are guessed, too, and those
// around these are seen.  All sizes are constants, for vector instructions.
enum {
  REACH = 2,
  WINDOW = 2 * REACH + 1,
  PATCH = 32,
  GUESSED = PATCH + 2 * REACH,
  SEEN = GUESSED + 2 * REACH,
};

// One channel of the pixels that are seen; 0 where there is none.
typedef struct channel {
  double a[SEEN][SEEN], b[SEEN][SEEN], other[SEEN][SEEN];
} channel;

// What one channel of the pixels of a patch and around it may be.
typedef struct guesses {
  float likely[GUESSED][GUESSED];  // radiance; infinite where there's no pixel
  float share[GUESSED][GUESSED];   // 1 / (likely^2 + 0.01)
  float first[GUESSED][GUESSED];   // the same of an expected square
  float most[GUESSED][GUESSED];    // and no more than that
  float sharp[GUESSED][GUESSED];   // 1 / the variance of a half
} guesses;

// The patch whose first pixel is (x, y), with as many rows; row r and column k
// of what is seen are the pixel (x + k - 2 REACH, y + r - 2 REACH).
typedef struct patch {
  int x, y, rows;
  double there[SEEN][SEEN];  // 1 where there is a pixel
  channel seen[3];
  guesses guess;               // of one channel
  double terms[PATCH][PATCH];  // sums over channels
} patch;

// Sums over pixels of a window.
typedef struct window_sums {
  double there[SEEN], mean[SEEN], mean2[SEEN], square[SEEN];
} window_sums;

// What is expected of a row of pixels.
typedef struct expected {
  float likely[GUESSED], square[GUESSED];  // radiance, and its square
  float sure[GUESSED];                     // the square is not less
  float variance[GUESSED];                 // of a half
} expected;

static double more(double a, double b) {
  return a > b ? a : b;
}

static void add_row(const patch *p, const channel *c, int row,
                    window_sums *restrict out) {
  for (int k = 0; k < SEEN; k++) {
    double mean = (c->a[row][k] + c->b[row][k]) / 2;
    double half = (c->a[row][k] - c->b[row][k]) / 2;
    out->there[k] += p->there[row][k];
    out->mean[k] += mean;
    out->mean2[k] += mean * mean;
    out->square[k] += half * half;
  }
}

// Two columns at each side, and the pixel's own without itself.
static void join_columns(const double *column, const double *own,
                         double *restrict out) {
  for (int k = 0; k < GUESSED; k++)
    out[k] =
        column[k] + column[k + 1] + own[k + 2] + column[k + 3] + column[k + 4];
}

// Sums over the others of each pixel's window.  Nothing is taken off again,
// where one pixel may be a million times the others.
static void sum_others(const patch *p, const channel *c, int row,
                       window_sums *out) {
  window_sums column = {{0}, {0}, {0}, {0}};
  for (int r = row - REACH; r <= row + REACH; r++)
    if (r != row) add_row(p, c, r, &column);
  window_sums own = column;
  add_row(p, c, row, &column);
  join_columns(column.there, own.there, out->there);
  join_columns(column.mean, own.mean, out->mean);
  join_columns(column.mean2, own.mean2, out->mean2);
  join_columns(column.square, own.square, out->square);
}

// Radiance as a pixel and its neighbours let expect it: the neighbours have a
// mean, vary around it by themselves (spread), and all are uncertain.  The less
// certain the pixel is, the more its neighbours count.  Who has not two of them
// has only itself.
// Source: James and Stein, 1961.
static void expect_row(const double *a, const double *b, const window_sums *o,
                       expected *restrict e) {
  for (int k = 0; k < GUESSED; k++) {
    double mean = (a[k] + b[k]) / 2, half = (a[k] - b[k]) / 2;
    double n = o->there[k], each = 1 / more(n, 1), rest = 1 / more(n - 1, 1);
    double around = o->mean[k] * each, noise = o->square[k] * each;
    double vary = (o->mean2[k] - o->mean[k] * around) * rest;
    double spread = more(vary - noise, 0), own = more(noise, half * half);
    double all = spread + own;
    double trust = spread / (all > 0 ? all : 1);
    double likely = around + trust * (mean - around);
    // Half of what the square of an uncertain number exceeds the square of its
    // mean by, because it is to be divided by.
    double square = likely * likely + (1 - trust) * spread / 2;
    double alone = more(a[k] * b[k], 0);
    // A lamp among dark neighbours: both means see it, as no accident would.
    double least = a[k] < b[k] ? a[k] : b[k];
    double sure = more(least - 2 * sqrt(noise), 0);
    e->likely[k] = (float)(n > 1 ? likely : sqrt(alone));
    e->square[k] = (float)(n > 1 ? square : alone);
    e->sure[k] = (float)(sure * sure);
    e->variance[k] = (float)(2 * own);
  }
}

// Guesses for a row of what is seen, from the third to the last but two.
static void guess_row(patch *p, const channel *c, int row) {
  window_sums others;
  expected e;
  guesses *restrict g = &p->guess;
  int r = row - REACH;
  sum_others(p, c, row, &others);
  expect_row(&c->a[row][REACH], &c->b[row][REACH], &others, &e);
  for (int k = 0; k < GUESSED; k++) {
    float likely = e.likely[k], share = 1 / (likely * likely + 0.01f);
    float variance = e.variance[k] < 1e30f ? e.variance[k] : 1e30f;
    bool there = p->there[row][k + REACH] > 0;
    g->likely[r][k] = there ? likely : INFINITY;
    g->share[r][k] = there ? share : 0;
    g->first[r][k] = 1 / (e.square[k] + 0.01f);
    g->most[r][k] = 1 / (e.sure[k] + 0.01f);
    g->sharp[r][k] = 1 / (variance > 1e-30f ? variance : 1e-30f);
  }
}

// A row of pixels that ask which of their neighbours they may be.
typedef struct asking {
  float a[PATCH], b[PATCH], sharp[PATCH];
  float sum[PATCH], all[PATCH];
} asking;

// May each be the neighbour on one side of it?
static void ask_neighbours(asking *restrict p, const float *likely,
                           const float *share) {
  for (int k = 0; k < PATCH; k++) {
    float a = p->a[k] - likely[k], b = p->b[k] - likely[k];
    float off = (1 + a * a * p->sharp[k]) * (1 + b * b * p->sharp[k]);
    float fit = 1 / (off * off);
    p->sum[k] += fit * share[k];
    p->all[k] += fit;
  }
}

// At an edge there are two kinds of pixels and none between them.  So let a
// pixel be one of its window, itself or another, the likelier the better that
// fits both its halves: the mean of these pixels' shares.
static void mix_row(const patch *p, const channel *c, int row,
                    float *restrict mixed) {
  const guesses *g = &p->guess;
  int r = row + REACH, s = r + REACH;
  asking q = {{0}, {0}, {0}, {0}, {0}};
  for (int k = 0; k < PATCH; k++) {
    q.a[k] = (float)c->a[s][k + 2 * REACH];
    q.b[k] = (float)c->b[s][k + 2 * REACH];
    q.sharp[k] = g->sharp[r][k + REACH];
  }
  for (int v = row; v < row + WINDOW; v++)
    for (int u = 0; u < WINDOW; u++)
      ask_neighbours(&q, &g->likely[v][u], &g->share[v][u]);
  for (int k = 0; k < PATCH; k++)
    mixed[k] = q.all[k] > 0 ? q.sum[k] / q.all[k] : g->share[r][k + REACH];
}

// Add a channel to the terms of a row.  At edges the first guess is too low and
// the second too high, by about as much; elsewhere they agree.
static void add_terms(patch *p, const channel *c, int row,
                      two_means_sums *sums) {
  int r = row + REACH, s = r + REACH;
  float mixed[PATCH];
  mix_row(p, c, row, mixed);
  for (int k = 0; k < PATCH; k++) {
    double both = sqrt((double)p->guess.first[r][k + REACH] * (double)mixed[k]);
    double most = (double)p->guess.most[r][k + REACH];
    double share = both < most ? both : most;
    double half = (c->a[s][k + 2 * REACH] - c->b[s][k + 2 * REACH]) / 2;
    p->terms[row][k] += share * half * half;
    sums->other += share * c->other[s][k + 2 * REACH];
  }
}

static void see_pixel(patch *p, const two_means *t, int row, int column) {
  int x = p->x + column - 2 * REACH, y = p->y + row - 2 * REACH;
  size_t i = (size_t)y * (size_t)t->width + (size_t)x;
  two_means_pixel pixel = {{0}, {0}, {0}};
  bool there = x >= 0 && x < t->width && y >= 0 && y < t->height &&
               t->pixel(t->self, i, &pixel);
  p->there[row][column] = there;
  for (int c = 0; c < 3; c++) {
    p->seen[c].a[row][column] = there ? pixel.a[c] : 0;
    p->seen[c].b[row][column] = there ? pixel.b[c] : 0;
    p->seen[c].other[row][column] = there ? pixel.other[c] : 0;
  }
}

static void see_pixels(patch *p, const two_means *t) {
  memset(p->terms, 0, sizeof p->terms);
  for (int row = 0; row < p->rows + 4 * REACH; row++)
    for (int k = 0; k < SEEN; k++)
      see_pixel(p, t, row, k);
}

// The sums of a patch, and its pixels.
typedef struct patch_sums {
  two_means_sums sums;
  double pixels;
} patch_sums;

static void measure_patch(patch *p, patch_sums *out) {
  for (int c = 0; c < 3; c++) {
    for (int row = REACH; row < p->rows + 3 * REACH; row++)
      guess_row(p, &p->seen[c], row);
    for (int row = 0; row < p->rows; row++)
      add_terms(p, &p->seen[c], row, &out->sums);
  }
  for (int row = 0; row < p->rows; row++)
    for (int k = 0; k < PATCH; k++) {
      double term = p->terms[row][k];
      out->sums.square += term;
      out->sums.doubt += term * term;
      out->pixels += p->there[row + 2 * REACH][k + 2 * REACH];
    }
}

typedef struct measuring {
  const two_means *of;
  patch *room;  // of each worker
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
  see_pixels(p, t);
  measure_patch(p, &m->out[item]);
}

two_means_sums two_means_measure(const two_means *t, pool *threads) {
  arena scratch = {0};
  size_t items = (size_t)patches(t->width) * (size_t)patches(t->height);
  size_t workers = threads != NULL ? (size_t)pool_threads(threads) : 1;
  measuring m = {t, ARENA_NEW(&scratch, patch, workers),
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
