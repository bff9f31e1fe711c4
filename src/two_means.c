// two_means.c — the trick: ((a - b) / 2)^2 has the expectation of the squared
// error of (a + b) / 2, whatever makes that error.  What is left to guess is
// the radiance to divide by, and a pixel must not be its own judge there: the
// sample that made it wrong made it bright.

#include "two_means.h"

#include <math.h>
#include <string.h>

// A pixel asks those of a window around it: REACH to each side.
enum { REACH = 2, WINDOW = 2 * REACH + 1 };

// A side of a patch, which is what a thread does at once.  The pixels around it
// are guessed, too, and those around these are seen.  All are constants, for
// vector instructions.
enum { PATCH = 32, GUESSED = PATCH + 2 * REACH, SEEN = GUESSED + 2 * REACH };

// One channel of the pixels that are seen; 0 where there is none.
typedef struct channel {
  double mean[SEEN][SEEN];  // (a + b) / 2
  double half[SEEN][SEEN];  // (a - b) / 2
  double other[SEEN][SEEN];
} channel;

// The others of each pixel's window: 1 / number, 1 / (number - 1); both 0 where
// there are not two.
typedef struct others {
  double each[GUESSED][GUESSED], rest[GUESSED][GUESSED];
} others;

// What one channel of the pixels of a patch and around it may be.
typedef struct guesses {
  float likely[GUESSED][GUESSED];  // radiance; infinite where there's no pixel
  float share[GUESSED][GUESSED];   // 1 / (likely^2 + 0.01)
  float square[GUESSED][GUESSED];  // what its square is expected to be
  float sure[GUESSED][GUESSED];    // and no less than that
  float sharp[GUESSED][GUESSED];   // 1 / the variance of a half
} guesses;

// The patch whose first pixel is (x, y), with as many rows; row r and column k
// of what is seen are the pixel (x + k - 2 REACH, y + r - 2 REACH).
typedef struct patch {
  int x, y, rows;
  double there[SEEN][SEEN];  // 1 where there is a pixel
  others others;
  channel seen[3];
  guesses guess;  // of one channel
  // Sums over channels: of squares, and of what is averaged like them.
  double terms[PATCH][PATCH], other[PATCH][PATCH];
} patch;

static double more(double a, double b) {
  return a > b ? a : b;
}

// Sums over columns of a window to sums over all of it but the pixel itself,
// whose column without it is `own`.  Nothing is taken off again, where one
// pixel may be a million times the others.
static void join_columns(const double *column, const double *own,
                         double *restrict out) {
  for (int k = 0; k < GUESSED; k++)
    out[k] =
        column[k] + column[k + 1] + own[k + 2] + column[k + 3] + column[k + 4];
}

static void count_others(patch *p, int row) {
  double own[SEEN] = {0}, column[SEEN], n[GUESSED];
  double *restrict each = p->others.each[row - REACH];
  double *restrict rest = p->others.rest[row - REACH];
  for (int r = row - REACH; r <= row + REACH; r++)
    for (int k = 0; k < SEEN && r != row; k++)
      own[k] += p->there[r][k];
  for (int k = 0; k < SEEN; k++)
    column[k] = own[k] + p->there[row][k];
  join_columns(column, own, n);
  for (int k = 0; k < GUESSED; k++) {
    each[k] = n[k] > 1 ? 1 / n[k] : 0;
    rest[k] = n[k] > 1 ? 1 / (n[k] - 1) : 0;
  }
}

// Sums over the others.
typedef struct other_sums {
  double mean[SEEN], mean2[SEEN], square[SEEN];
} other_sums;

static void add_row(const channel *c, int row, other_sums *restrict out) {
  for (int k = 0; k < SEEN; k++) {
    double mean = c->mean[row][k], half = c->half[row][k];
    out->mean[k] += mean;
    out->mean2[k] += mean * mean;
    out->square[k] += half * half;
  }
}

static void sum_others(const channel *c, int row, other_sums *out) {
  other_sums own = {{0}, {0}, {0}};
  for (int r = row - REACH; r <= row + REACH; r++)
    if (r != row) add_row(c, r, &own);
  other_sums column = own;
  add_row(c, row, &column);
  join_columns(column.mean, own.mean, out->mean);
  join_columns(column.mean2, own.mean2, out->mean2);
  join_columns(column.square, own.square, out->square);
}

// Radiance as a pixel and its neighbours let expect it: the neighbours have a
// mean, vary around it by themselves (spread), and all are uncertain.  The less
// certain the pixel is, the more its neighbours count.  Who has not two of them
// has only itself.
// Source: James and Stein, 1961.
static void expect_row(const patch *p, const channel *c, int row,
                       guesses *restrict g) {
  other_sums o;
  sum_others(c, row, &o);
  int r = row - REACH;
  for (int k = 0; k < GUESSED; k++) {
    double mean = c->mean[row][k + REACH], half = c->half[row][k + REACH];
    double each = p->others.each[r][k];
    double around = o.mean[k] * each, noise = o.square[k] * each;
    double vary = (o.mean2[k] - o.mean[k] * around) * p->others.rest[r][k];
    double spread = more(vary - noise, 0), own = more(noise, half * half);
    double all = spread + own;
    double trust = spread / (all > 0 ? all : 1);
    double likely = around + trust * (mean - around);
    // Half of what the square of an uncertain number exceeds the square of its
    // mean by, because it is to be divided by.
    double square = likely * likely + (1 - trust) * spread / 2;
    double lone = each > 0 ? 0 : more((mean + half) * (mean - half), 0);
    // A lamp among dark neighbours: both means see it, as no accident would.
    double sure = more(mean - fabs(half) - 2 * sqrt(noise), 0);
    g->likely[r][k] = (float)(likely + sqrt(lone));
    g->square[r][k] = (float)(square + lone);
    g->sure[r][k] = (float)(sure * sure);
    g->sharp[r][k] = (float)(1 / more(own < 1e30 ? 2 * own : 1e30, 1e-30));
  }
}

static void share_row(const patch *p, int row, guesses *restrict g) {
  for (int k = 0; k < GUESSED; k++) {
    float likely = g->likely[row][k], share = 1 / (likely * likely + 0.01f);
    bool there = p->there[row + REACH][k + REACH] > 0;
    g->likely[row][k] = there ? likely : INFINITY;
    g->share[row][k] = there ? share : 0;
  }
}

// A row of pixels that ask which of their neighbours they may be.
typedef struct asking {
  float a[PATCH], b[PATCH];
  float sum[PATCH], all[PATCH];
} asking;

// May each be the neighbour at one side of it?  As likely as both halves are
// where that one's halves vary as they do, by Student's distribution of three
// degrees of freedom: what is known of the variance is little.
static void ask_neighbours(asking *restrict p, const float *likely,
                           const float *sharp, const float *share) {
  for (int k = 0; k < PATCH; k++) {
    float a = p->a[k] - likely[k], b = p->b[k] - likely[k];
    float off = (1 + a * a * sharp[k]) * (1 + b * b * sharp[k]);
    float fit = sharp[k] / (off * off);
    p->sum[k] += fit * share[k];
    p->all[k] += fit;
  }
}

// At an edge there are two kinds of pixels and none between them.  So let a
// pixel be one of its window, itself or another, the likelier the better that
// fits: the mean of these pixels' shares.
static void mix_row(const patch *p, const channel *c, int row,
                    float *restrict mixed) {
  const guesses *g = &p->guess;
  int r = row + REACH, s = r + REACH;
  asking q = {{0}, {0}, {0}, {0}};
  for (int k = 0; k < PATCH; k++) {
    double mean = c->mean[s][k + 2 * REACH], half = c->half[s][k + 2 * REACH];
    q.a[k] = (float)(mean + half);
    q.b[k] = (float)(mean - half);
  }
  for (int v = row; v < row + WINDOW; v++)
    for (int u = 0; u < WINDOW; u++)
      ask_neighbours(&q, &g->likely[v][u], &g->sharp[v][u], &g->share[v][u]);
  for (int k = 0; k < PATCH; k++)
    mixed[k] = q.all[k] > 0 ? q.sum[k] / q.all[k] : g->share[r][k + REACH];
}

// Add a channel to the terms of a row.  At edges the first guess is too low and
// the second too high, by about as much; elsewhere they agree.
static void add_terms(patch *p, const channel *c, int row) {
  const float *square = &p->guess.square[row + REACH][REACH];
  const float *sure = &p->guess.sure[row + REACH][REACH];
  const double *half = &c->half[row + 2 * REACH][2 * REACH];
  const double *other = &c->other[row + 2 * REACH][2 * REACH];
  float mixed[PATCH], shares[PATCH];
  mix_row(p, c, row, mixed);
  for (int k = 0; k < PATCH; k++) {
    float both = sqrtf(mixed[k] / (square[k] + 0.01f));
    float most = 1 / (sure[k] + 0.01f);
    shares[k] = both < most ? both : most;
  }
  for (int k = 0; k < PATCH; k++)
    p->terms[row][k] += (double)shares[k] * (half[k] * half[k]);
  for (int k = 0; k < PATCH; k++)
    p->other[row][k] += (double)shares[k] * other[k];
}

static void see_pixel(patch *p, const two_means *t, int row, int column) {
  int x = p->x + column - 2 * REACH, y = p->y + row - 2 * REACH;
  size_t i = (size_t)y * (size_t)t->width + (size_t)x;
  two_means_pixel q = {{0}, {0}, {0}};
  bool there = x >= 0 && x < t->width && y >= 0 && y < t->height &&
               t->pixel(t->self, i, &q);
  p->there[row][column] = there;
  for (int c = 0; c < 3; c++) {
    p->seen[c].mean[row][column] = there ? (q.a[c] + q.b[c]) / 2 : 0;
    p->seen[c].half[row][column] = there ? (q.a[c] - q.b[c]) / 2 : 0;
    p->seen[c].other[row][column] = there ? q.other[c] : 0;
  }
}

static void see_pixels(patch *p, const two_means *t) {
  memset(p->terms, 0, sizeof p->terms);
  memset(p->other, 0, sizeof p->other);
  for (int row = 0; row < p->rows + 4 * REACH; row++)
    for (int k = 0; k < SEEN; k++)
      see_pixel(p, t, row, k);
  for (int row = REACH; row < p->rows + 3 * REACH; row++)
    count_others(p, row);
}

// The sums of a patch, and its pixels.
typedef struct patch_sums {
  two_means_sums sums;
  double pixels;
} patch_sums;

static void measure_patch(patch *p, patch_sums *out) {
  for (int c = 0; c < 3; c++) {
    for (int row = REACH; row < p->rows + 3 * REACH; row++)
      expect_row(p, &p->seen[c], row, &p->guess);
    for (int row = 0; row < p->rows + 2 * REACH; row++)
      share_row(p, row, &p->guess);
    for (int row = 0; row < p->rows; row++)
      add_terms(p, &p->seen[c], row);
  }
  for (int row = 0; row < p->rows; row++)
    for (int k = 0; k < PATCH; k++) {
      double term = p->terms[row][k];
      out->sums.square += term;
      out->sums.doubt += term * term;
      out->sums.other += p->other[row][k];
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
