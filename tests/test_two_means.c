// test_two_means.c — the squared error of a mean is guessed as the book has it,
// wherever a thing lies.

#include "num.h"
#include "rng.h"
#include "two_means.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// What is known of a pixel.
typedef struct two_means_pixel {
  double a[3], b[3], other[3];
} two_means_pixel;

// Two means, one of which is wrong here and there; some pixels have none.  The
// last pixel has nobody near.
enum { RAGGED_WIDTH = 41, RAGGED_HEIGHT = 37, RAGGED = 41 * 37 };

static double radiance(size_t i) {
  size_t x = i % RAGGED_WIDTH, y = i / RAGGED_WIDTH;
  return (x + y > 40 ? 3 : 0.2) * (0.3 + (double)y / RAGGED_HEIGHT);
}

static bool two_pixels(size_t i, two_means_pixel *out) {
  rng r = rng_of(7, i, 0);
  for (int c = 0; c < 3; c++) {
    out->a[c] = radiance(i) * (double)rng_next(&r);
    out->b[c] = radiance(i) * (double)rng_next(&r);
    out->other[c] = (double)rng_next(&r);
    if (rng_next(&r) < 0.05f) out->a[c] += 1000;
  }
  size_t x = i % RAGGED_WIDTH, y = i / RAGGED_WIDTH;
  if (i != RAGGED - 1 && x > 36 && y > 32) return false;
  return i % 7 != 3 || i == RAGGED - 1;
}

static void put_pixel(const two_means_run *out, size_t k, bool has,
                      const two_means_pixel *p) {
  out->has[k] = has;
  memcpy(out->a + 3 * k, p->a, sizeof p->a);
  memcpy(out->b + 3 * k, p->b, sizeof p->b);
  memcpy(out->other + 3 * k, p->other, sizeof p->other);
}

static void two_run(const void *self, size_t i, int n,
                    const two_means_run *out) {
  (void)self;
  for (size_t k = 0; k < (size_t)n; k++) {
    two_means_pixel p;
    bool has = two_pixels(i + k, &p);
    put_pixel(out, k, has, &p);
  }
}

// The next pixel of the window around pixel i, from *at on.
static bool next_near(size_t i, size_t *at, two_means_pixel *out) {
  int x = (int)(i % RAGGED_WIDTH), y = (int)(i / RAGGED_WIDTH);
  for (++*at; *at < RAGGED; ++*at) {
    int u = (int)(*at % RAGGED_WIDTH), v = (int)(*at / RAGGED_WIDTH);
    if (abs(u - x) <= 1 && abs(v - y) <= 1 && two_pixels(*at, out)) return true;
  }
  return false;
}

// The mean of f of the others in the window of pixel i; their number.
static int of_others(double *mean, size_t i, int channel,
                     double (*f)(double a, double b)) {
  two_means_pixel p;
  int n = 0;
  *mean = 0;
  for (size_t at = (size_t)-1; next_near(i, &at, &p);)
    if (at != i) {
      *mean += f(p.a[channel], p.b[channel]);
      n++;
    }
  *mean /= n > 0 ? n : 1;
  return n;
}

static double middle(double a, double b) {
  return (a + b) / 2;
}

static double square(double a, double b) {
  return middle(a, b) * middle(a, b);
}

static double apart(double a, double b) {
  return (a - b) * (a - b) / 4;
}

// 1 / (radiance^2 + 0.01), guessed as the book has it.
static double share_of(size_t i, int c) {
  two_means_pixel p;
  two_pixels(i, &p);
  double mu, squares, noise, m = middle(p.a[c], p.b[c]);
  double own = apart(p.a[c], p.b[c]);
  int n = of_others(&mu, i, c, middle);
  of_others(&squares, i, c, square);
  of_others(&noise, i, c, apart);
  if (n < 2) return 1 / (fmax(m * m - own, 0) + 0.01);
  double tau2 = fmax((squares - mu * mu) * n / (n - 1) - noise, 0);
  double trust = tau2 > 0 ? tau2 / (tau2 + own) : 0;
  double likely = mu + trust * (m - mu);
  return 1 / (likely * likely + 0.01);
}

// All pixels of a patch at once are those one by one, for any threads.
static void a_patch_is_its_pixels(void **state) {
  (void)state;
  arena mem = {0};
  two_means t = {RAGGED_WIDTH, RAGGED_HEIGHT, NULL, two_run};
  double *terms = ARENA_NEW(&mem, double, RAGGED);
  two_means_sums is = {0, 0, 0}, alone = two_means_measure(&t, terms, NULL);
  two_means_pixel p;
  double n = 0;
  for (size_t i = 0; i < RAGGED; i++) {
    double term = 0;
    for (int c = 0; c < 3 && two_pixels(i, &p); c++, n++) {
      term += share_of(i, c) * apart(p.a[c], p.b[c]);
      is.other += share_of(i, c) * p.other[c];
    }
    assert_true(fabs(terms[i] - term) <= 1e-9 * term);
    is.square += term;
  }
  assert_true(fabs(alone.square * n / is.square - 1) < 1e-9);
  assert_true(fabs(alone.other * n / is.other - 1) < 1e-9);
  pool *three = pool_new(&mem, 3);
  two_means_sums same = two_means_measure(&t, NULL, three);
  assert_memory_equal(&same, &alone, sizeof same);
  pool_free(three);
  arena_free(&mem);
}

// A lamp before a wall, which begins somewhere within the pixels of its first
// column.  Black, and known to be, around; the whole moved by `left` pixels
// from the left and `down` from above.
enum { LAMP_SIDE = 28, LAMP_FROM = 14, LAMP_SAMPLES = 32, STAGE = 96 };

typedef struct lamp {
  uint64_t seed;
  int left, down;
} lamp;

static const double LAMP = 12, WALL = 0.3, COVER = 0.4;

static double lamp_cover(int x) {
  return x < LAMP_FROM ? 0 : x > LAMP_FROM ? 1 : COVER;
}

// The mean of a half's samples.
static double lamp_half(int x, rng *r) {
  double sum = 0;
  for (int k = 0; k < LAMP_SAMPLES; k++) {
    bool met = (double)rng_next(r) < lamp_cover(x);
    sum += (met ? LAMP : WALL) * (0.9 + 0.2 * (double)rng_next(r));
  }
  return sum / LAMP_SAMPLES;
}

static bool lamp_pixel(const void *self, size_t i, two_means_pixel *out) {
  const lamp *l = self;
  int x = (int)(i % STAGE) - l->left, y = (int)(i / STAGE) - l->down;
  for (int c = 0; c < 3; c++)
    out->a[c] = out->b[c] = out->other[c] = 0;
  if (x < 0 || x >= LAMP_SIDE || y < 0 || y >= LAMP_SIDE) return true;
  rng r = rng_of(l->seed, (uint64_t)(y * LAMP_SIDE + x), 0);
  for (int c = 0; c < 3; c++) {
    out->a[c] = lamp_half(x, &r);
    out->b[c] = lamp_half(x, &r);
  }
  return true;
}

static void lamp_run(const void *self, size_t i, int n,
                     const two_means_run *out) {
  for (size_t k = 0; k < (size_t)n; k++) {
    two_means_pixel p = {{0}, {0}, {0}};
    bool has = lamp_pixel(self, i + k, &p);
    put_pixel(out, k, has, &p);
  }
}

static double lamp_error(const lamp *l) {
  two_means t = {STAGE, STAGE, l, lamp_run};
  return sqrt(two_means_measure(&t, NULL, NULL).square);
}

// What is told of a picture does not depend on where it lies on the paper.
static void moved_is_the_same(void **state) {
  (void)state;
  lamp here = {1, 8, 8};
  double told = lamp_error(&here);
  for (int k = 1; k < 36; k++) {
    lamp right = {1, 8 + k, 8}, down = {1, 8, 8 + k};
    assert_true(fabs(lamp_error(&right) / told - 1) < 1e-9);
    assert_true(fabs(lamp_error(&down) / told - 1) < 1e-9);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_patch_is_its_pixels),
      cmocka_unit_test(moved_is_the_same),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
