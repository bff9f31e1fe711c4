// metric.c

#include "metric.h"

#include <string.h>

// Floats are sorted by the upper and then the lower half of their bits.
enum { HALF_RANGE = 1 << 16 };

// The bits of a float that is not negative: they grow as the number does.
static uint32_t float_bits(float x) {
  uint32_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits;
}

// The half that holds the element of the given rank, which becomes its rank
// among those of that half.
static uint32_t half_of_rank(const size_t *count, size_t *rank) {
  uint32_t half = 0;
  while (*rank >= count[half])
    *rank -= count[half++];
  return half;
}

// The element number rank (from 0) of the n values, none negative, in
// ascending order; two counting passes, no sorting.
static float value_of_rank(const float *values, size_t n, size_t rank,
                           arena *scratch) {
  size_t *count = ARENA_NEW(scratch, size_t, HALF_RANGE);
  for (size_t i = 0; i < n; i++)
    count[float_bits(values[i]) >> 16]++;
  uint32_t upper = half_of_rank(count, &rank);
  memset(count, 0, HALF_RANGE * sizeof *count);
  for (size_t i = 0; i < n; i++)
    if (float_bits(values[i]) >> 16 == upper)
      count[float_bits(values[i]) & (HALF_RANGE - 1)]++;
  uint32_t bits = upper << 16 | half_of_rank(count, &rank);
  float x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

// Find the first pixel that cannot be compared.
static bool find_non_finite(metric *m, const image *a, const image *b) {
  size_t n = (size_t)a->width * (size_t)a->height;
  for (size_t i = 0; i < n; i++) {
    bool good_a = vec3_finite(a->pixels[i]), good_b = vec3_finite(b->pixels[i]);
    if (good_a && good_b) continue;
    m->non_finite = true;
    m->bad_in_b = good_a;
    m->bad_x = (int)(i % (size_t)a->width);
    m->bad_y = (int)(i / (size_t)a->width);
    return true;
  }
  return false;
}

// Sums over all channels so far.
typedef struct metric_sums {
  double signed_sum, absolute, square, relative;
} metric_sums;

// Add one channel; returns the size of the difference.
static double add_channel(metric_sums *s, float a, float b) {
  double d = (double)a - (double)b, ref = (double)b;
  s->signed_sum += d;
  s->absolute += fabs(d);
  s->square += d * d;
  s->relative += d * d / (ref * ref + 0.01);
  return fabs(d);
}

metric metric_compare(const image *a, const image *b, arena *scratch) {
  metric m = {0};
  if (find_non_finite(&m, a, b)) return m;
  size_t n = (size_t)a->width * (size_t)a->height, worst = 0;
  float *largest = ARENA_NEW(scratch, float, n);
  metric_sums s = {0};
  for (size_t i = 0; i < n; i++) {
    vec3 p = a->pixels[i], q = b->pixels[i];
    double x = add_channel(&s, p.x, q.x), y = add_channel(&s, p.y, q.y),
           z = add_channel(&s, p.z, q.z), peak = fmax(x, fmax(y, z));
    largest[i] = (float)peak;
    m.differing += peak > 0;
    if (peak > m.max) m.max = peak, worst = i;
  }
  double channels = 3 * (double)n;
  m.mean = s.signed_sum / channels;
  m.mae = s.absolute / channels;
  m.mse = s.square / channels;
  m.rmse = sqrt(m.mse);
  m.relmse = s.relative / channels;
  m.psnr = m.mse > 0 ? -10 * log10(m.mse) : (double)INFINITY;
  // At least 99.9 % of the pixels differ by p999 or less.
  size_t rank = (n * 999 + 999) / 1000 - 1;
  m.p999 = (double)value_of_rank(largest, n, rank, scratch);
  m.worst_x = (int)(worst % (size_t)a->width);
  m.worst_y = (int)(worst / (size_t)a->width);
  return m;
}
