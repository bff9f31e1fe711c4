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
  double mean[BLOCK_PIXELS], least[BLOCK_PIXELS];  // of the two
  double square[BLOCK_PIXELS], other[BLOCK_PIXELS];
} block;

// Radiance squared at pixel k, as the pixel and its neighbours let expect: the
// neighbours have a mean, vary around it by themselves (spread), and all are
// uncertain.  The less certain the pixel is, the more its neighbours count.
// Source: James and Stein, 1961.
static double expected_square(const block *b, int k) {
  double sum = 0, sum2 = 0, noise = 0, n = (double)b->count - 1;
  if (n < 2) return fmax(b->mean[k] * b->mean[k] - b->square[k], 0);
  for (int i = 0; i < b->count; i++) {
    if (i == k) continue;
    sum += b->mean[i];
    sum2 += b->mean[i] * b->mean[i];
    noise += b->square[i];
  }
  double around = sum / n;
  noise /= n;
  double spread = fmax((sum2 - sum * around) / (n - 1) - noise, 0);
  double own = fmax(noise, b->square[k]);
  double trust = spread > 0 ? spread / (spread + own) : 0;
  double likely = around + trust * (b->mean[k] - around);
  // Half of what the square of an uncertain number exceeds the square of its
  // mean by, because it is to be divided by.
  double square = likely * likely + (1 - trust) * spread / 2;
  // A lamp among dark neighbours: both means see it, as no accident would.
  double sure = fmax(b->least[k] - 2 * sqrt(noise), 0);
  return fmax(square, sure * sure);
}

static void add_block(const block *b, two_means_sums *sums) {
  for (int k = 0; k < b->count; k++) {
    double share = 1 / (expected_square(b, k) + 0.01);
    sums->square += share * b->square[k];
    sums->other += share * b->other[k];
  }
}

static void put(block *b, const two_means_pixel *p, int channel) {
  double x = p->a[channel], y = p->b[channel];
  b->mean[b->count] = (x + y) / 2;
  b->least[b->count] = fmin(x, y);
  b->square[b->count] = (x - y) * (x - y) / 4;
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
  for (int c = 0; c < 3; c++)
    add_block(&b[c], sums);
  return b[0].count;
}

two_means_sums two_means_measure(const two_means *t) {
  two_means_sums sums = {0, 0};
  double pixels = 0;
  for (int y = 0; y < t->height; y += BLOCK)
    for (int x = 0; x < t->width; x += BLOCK)
      pixels += measure_block(t, x, y, &sums);
  if (!(pixels > 0)) return sums;
  return (two_means_sums){sums.square / (3 * pixels),
                          sums.other / (3 * pixels)};
}
