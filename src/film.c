// film.c

#include "film.h"

#include "pages.h"

#include <float.h>
#include <string.h>

// One block, so that it may have large pages; and all pages at once: a sum is
// read before it is written, which would interrupt twice a page.
film film_new(arena *mem, int width, int height, bool with_variance) {
  size_t n = (size_t)width * (size_t)height;
  film f = {.width = width, .height = height};
  size_t sums = n * sizeof *f.sum, squares = with_variance ? sums : 0;
  size_t each = (with_variance ? 2 : 1) * sizeof *f.sum + sizeof *f.count;
  char *all = arena_alloc(mem, n, each);
  f.sum = (double(*)[3])(void *)all;
  if (with_variance) f.square = (double(*)[3])(void *)(all + sums);
  f.count = (uint32_t *)(void *)(all + sums + squares);
  pages_expect(all, n * each);
  return f;
}

void film_copy(film *to, const film *from) {
  size_t n = (size_t)from->width * (size_t)from->height;
  memcpy(to->sum, from->sum, n * sizeof *to->sum);
  memcpy(to->count, from->count, n * sizeof *to->count);
  if (to->square != NULL)
    memcpy(to->square, from->square, n * sizeof *to->square);
}

size_t film_bytes(const film *f) {
  size_t pixel = sizeof *f->sum + sizeof *f->count;
  if (f->square != NULL) pixel += sizeof *f->square;
  return f->sum == NULL ? 0 : pixel * (size_t)f->width * (size_t)f->height;
}

void film_add(film *f, size_t i, vec3 sample) {
  double x[3] = {(double)sample.x, (double)sample.y, (double)sample.z};
  f->count[i]++;
  for (int c = 0; c < 3; c++)
    f->sum[i][c] += x[c];
  if (f->square == NULL) return;
  for (int c = 0; c < 3; c++)
    f->square[i][c] += x[c] * x[c];
}

vec3 film_mean(const film *f, size_t i) {
  if (f->count[i] == 0) return vec3_all(0);
  double n = (double)f->count[i];
  const double *s = f->sum[i];
  return (vec3){(float)(s[0] / n), (float)(s[1] / n), (float)(s[2] / n)};
}

// Of the mean: the variance of one sample over their number.
static double mean_variance(const film *f, size_t i, int c) {
  double n = (double)f->count[i];
  if (f->square == NULL || n < 2) return 0;
  double spread = f->square[i][c] - f->sum[i][c] * f->sum[i][c] / n;
  return (spread > 0 ? spread : 0) / (n - 1) / n;
}

// The largest float for more than that: samples of 1e20 are floats, their
// variance is not.
static float bounded(double x) {
  return x < (double)FLT_MAX ? (float)x : FLT_MAX;
}

vec3 film_variance(const film *f, size_t i) {
  return (vec3){bounded(mean_variance(f, i, 0)),
                bounded(mean_variance(f, i, 1)),
                bounded(mean_variance(f, i, 2))};
}

static size_t pixel_count(const film *f) {
  return (size_t)f->width * (size_t)f->height;
}

image film_image(const film *f, arena *mem) {
  image out = image_new(mem, f->width, f->height);
  for (size_t i = 0; i < pixel_count(f); i++)
    out.pixels[i] = film_mean(f, i);
  return out;
}

image film_variance_image(const film *f, arena *mem) {
  image out = image_new(mem, f->width, f->height);
  for (size_t i = 0; i < pixel_count(f); i++)
    out.pixels[i] = film_variance(f, i);
  return out;
}

image film_count_image(const film *f, arena *mem) {
  image out = image_new(mem, f->width, f->height);
  for (size_t i = 0; i < pixel_count(f); i++)
    out.pixels[i] = vec3_all((float)f->count[i]);
  return out;
}

// variance / (radiance^2 + 0.01) over a block of pixels that starts at (x, y).
// Radiance comes from the whole block, because the samples that raise a
// pixel's variance raise its own mean too, and the quotient would be too low.
static double block_error(const film *f, int x, int y, int side) {
  int x1 = x + side < f->width ? x + side : f->width;
  int y1 = y + side < f->height ? y + side : f->height;
  double pixels = (double)(x1 - x) * (double)(y1 - y), error = 0;
  for (int c = 0; c < 3; c++) {
    double variance = 0, square = 0;
    for (int v = y; v < y1; v++)
      for (int u = x; u < x1; u++) {
        size_t i = (size_t)v * (size_t)f->width + (size_t)u;
        double n = f->count[i] > 0 ? (double)f->count[i] : 1;
        double mean = f->sum[i][c] / n, of_mean = mean_variance(f, i, c);
        variance += of_mean;
        square += fmax(mean * mean - of_mean, 0);
      }
    error += variance / (square / pixels + 0.01);
  }
  return error;
}

// Pixels a side of a block over which the estimate takes radiance for equal.
enum { ERROR_BLOCK = 4 };

double film_box_error(const film *f, const film_box *box) {
  double sum = 0;
  for (int y = box->y0; y < box->y1; y += ERROR_BLOCK)
    for (int x = box->x0; x < box->x1; x += ERROR_BLOCK)
      sum += block_error(f, x, y, ERROR_BLOCK);
  return sum;
}

double film_error(const film *f) {
  if (f->square == NULL) return 0;
  film_box all = {0, 0, f->width, f->height};
  return sqrt(film_box_error(f, &all) / (3 * (double)pixel_count(f)));
}
