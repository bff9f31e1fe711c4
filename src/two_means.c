// two_means.c — the trick: ((a - b) / 2)^2 has the expectation of the squared
// error of (a + b) / 2, whatever makes that error.  What is left to guess is
// the radiance to divide by, and a pixel must not be its own judge there: the
// sample that made it wrong made it bright.

#include "two_means.h"

#include <math.h>

// Pixels a side of a block whose other pixels say what to expect of one.
enum { BLOCK = 4, BLOCK_PIXELS = BLOCK * BLOCK };

// One channel of a block.
typedef struct block {
  int count;
  double mean[BLOCK_PIXELS], mean2[BLOCK_PIXELS];  // of the two means
  double square[BLOCK_PIXELS];                     // ((a - b) / 2)^2
  double least[BLOCK_PIXELS], other[BLOCK_PIXELS];
} block;

// Sums over the others of each pixel.
typedef struct others {
  double mean[BLOCK_PIXELS], mean2[BLOCK_PIXELS], square[BLOCK_PIXELS];
} others;

static double more(double a, double b) {
  return a > b ? a : b;
}

// Those before a pixel and those behind it: nothing is taken off again, where
// one pixel may be a million times the others.
static void sum_others(double *out, const double *of, int count) {
  double before = 0, behind = 0;
  for (int k = 0; k < count; k++) {
    out[k] = before;
    before += of[k];
  }
  for (int k = count - 1; k >= 0; k--) {
    out[k] += behind;
    behind += of[k];
  }
}

static void ask_others(const block *b, others *out) {
  sum_others(out->mean, b->mean, b->count);
  sum_others(out->mean2, b->mean2, b->count);
  sum_others(out->square, b->square, b->count);
}

// What each pixel of a block may be, and how sharply that is known.
typedef struct guesses {
  double share[BLOCK_PIXELS];  // 1 / (radiance^2 + 0.01): the first guess
  double most[BLOCK_PIXELS];   // and no more than that
  float mean[BLOCK_PIXELS], sharp[BLOCK_PIXELS];
  float likely[BLOCK_PIXELS], likely_share[BLOCK_PIXELS];
} guesses;

// Radiance as a pixel and its neighbours let expect it: the neighbours have a
// mean, vary around it by themselves (spread), and all are uncertain.  The less
// certain the pixel is, the more its neighbours count.  All pixels at once,
// those that are not there too.
// Source: James and Stein, 1961.
static void expect_shares(const block *b, const others *o, guesses *g) {
  double each = 1.0 / (b->count - 1), rest = 1.0 / (b->count - 2);
  for (int k = 0; k < BLOCK_PIXELS; k++) {
    double mean = b->mean[k], square = b->square[k];
    double around = o->mean[k] * each, noise = o->square[k] * each;
    double vary = (o->mean2[k] - o->mean[k] * around) * rest;
    double spread = more(vary - noise, 0), own = more(noise, square);
    double all = spread + own;
    double trust = spread / (all > 0 ? all : 1);
    double likely = around + trust * (mean - around);
    // Half of what the square of an uncertain number exceeds the square of its
    // mean by, because it is to be divided by.
    double expected = likely * likely + (1 - trust) * spread / 2;
    // A lamp among dark neighbours: both means see it, as no accident would.
    double sure = more(b->least[k] - 2 * sqrt(noise), 0);
    g->share[k] = 1 / (expected + 0.01);
    g->most[k] = 1 / (sure * sure + 0.01);
    g->mean[k] = (float)mean;
    g->sharp[k] = (float)(1 / sqrt(more(own + noise, 1e-30)));
    g->likely[k] = (float)likely;
    g->likely_share[k] = (float)(1 / (likely * likely + 0.01));
  }
}

// At an edge there are two kinds of pixels and none between them.  So let a
// pixel be one of its block, the likelier the better that fits its mean and
// noise: the mean of these pixels' shares.
static void mix_shares(const guesses *g, int count, float *out) {
  float sum[BLOCK_PIXELS] = {0}, all[BLOCK_PIXELS] = {0};
  for (int i = 0; i < count; i++)
    for (int k = 0; k < BLOCK_PIXELS; k++) {
      float off = (g->mean[k] - g->likely[i]) * g->sharp[k];
      float fit = 1 / (1 + off * off);
      fit = fit * fit * (fit * fit);
      sum[k] += fit * g->likely_share[i];
      all[k] += fit;
    }
  for (int k = 0; k < BLOCK_PIXELS; k++)
    out[k] = all[k] > 0 ? sum[k] / all[k] : g->likely_share[k];
}

// At edges the first guess is too low and the second too high, by about as
// much; elsewhere they agree.
static void guess_shares(const block *b, double *share) {
  guesses g;
  others o = {{0}, {0}, {0}};
  float mixed[BLOCK_PIXELS];
  ask_others(b, &o);
  expect_shares(b, &o, &g);
  mix_shares(&g, b->count, mixed);
  for (int k = 0; k < BLOCK_PIXELS; k++) {
    double both = sqrt(g.share[k] * (double)mixed[k]);
    share[k] = both < g.most[k] ? both : g.most[k];
  }
}

// Add to the terms of the block's pixels, which are sums over channels.
static void add_block(const block *b, double *terms, two_means_sums *sums) {
  double share[BLOCK_PIXELS];
  if (b->count > 2)
    guess_shares(b, share);
  else
    for (int k = 0; k < b->count; k++)
      share[k] = 1 / (more(b->mean2[k] - b->square[k], 0) + 0.01);
  for (int k = 0; k < b->count; k++) {
    terms[k] += share[k] * b->square[k];
    sums->other += share[k] * b->other[k];
  }
}

static void put(block *b, const two_means_pixel *p, int channel) {
  double x = p->a[channel], y = p->b[channel], mean = (x + y) / 2;
  b->mean[b->count] = mean;
  b->mean2[b->count] = mean * mean;
  b->square[b->count] = (x - y) * (x - y) / 4;
  b->least[b->count] = x < y ? x : y;
  b->other[b->count++] = p->other[channel];
}

// The three channels of the block that starts at (x0, y0); returns its pixels.
static int measure_block(const two_means *t, int x0, int y0,
                         two_means_sums *sums) {
  block b[3] = {{0}, {0}, {0}};
  for (int y = y0; y < y0 + BLOCK && y < t->height; y++)
    for (int x = x0; x < x0 + BLOCK && x < t->width; x++) {
      two_means_pixel p = {{0}, {0}, {0}};
      size_t i = (size_t)y * (size_t)t->width + (size_t)x;
      if (!t->pixel(t->self, i, &p)) continue;
      for (int c = 0; c < 3; c++)
        put(&b[c], &p, c);
    }
  double terms[BLOCK_PIXELS] = {0};
  for (int c = 0; c < 3; c++)
    add_block(&b[c], terms, sums);
  for (int k = 0; k < b[0].count; k++) {
    sums->square += terms[k];
    sums->doubt += terms[k] * terms[k];
  }
  return b[0].count;
}

// A row of blocks, the item of work of a thread.
typedef struct block_row {
  two_means_sums sums;
  double pixels;
} block_row;

typedef struct measuring {
  const two_means *of;
  block_row *rows;
} measuring;

static void measure_row(void *context, size_t item, int worker) {
  const measuring *m = context;
  block_row *row = &m->rows[item];
  for (int x = 0; x < m->of->width; x += BLOCK)
    row->pixels += measure_block(m->of, x, BLOCK * (int)item, &row->sums);
  (void)worker;
}

two_means_sums two_means_measure(const two_means *t, pool *threads) {
  arena scratch = {0};
  size_t rows = (size_t)((t->height + BLOCK - 1) / BLOCK);
  measuring m = {t, ARENA_NEW(&scratch, block_row, rows)};
  pool_run(threads, rows, measure_row, &m);
  two_means_sums sums = {0, 0, 0};
  double pixels = 0;
  for (size_t i = 0; i < rows; i++) {
    sums.square += m.rows[i].sums.square;
    sums.other += m.rows[i].sums.other;
    sums.doubt += m.rows[i].sums.doubt;
    pixels += m.rows[i].pixels;
  }
  arena_free(&scratch);
  if (!(pixels > 0)) return sums;
  return (two_means_sums){sums.square / (3 * pixels), sums.other / (3 * pixels),
                          sqrt(sums.doubt) / (3 * pixels)};
}
