// ibl_wave.h — functions on the sphere as sums of spherical harmonics, up to
// order 511, and back.

#ifndef IBL_WAVE_H
#define IBL_WAVE_H

#include "image.h"
#include "pool.h"

// The largest degree l.
enum { WAVE_MAX_DEGREE = 511 };

// Real and imaginary part of red, green and blue.
typedef struct wave_rgb {
  double c[3][2];
} wave_rgb;

// Coefficients for 0 <= m <= l <= degree; those of -m are conjugates, as the
// function is real.  Y_lm = P_lm(cos theta) e^(i m phi) has unit norm; phi =
// 2 pi u, theta = pi v.
typedef struct wave {
  int degree;
  wave_rgb *a;  // by wave_at
} wave;

// Where the coefficient (l, m) lies: those of one m together, m = 0 first.
static inline size_t wave_at(const wave *w, int l, int m) {
  return (size_t)(m * (2 * w->degree + 3 - m) / 2 + l - m);
}

// The coefficients of a picture whose texels are points in their middle; they
// weigh nearly their solid angle.  Its width is a power of two, up to 1024.
void wave_analyse(wave *out, const image *map, arena *mem, pool *threads);

// The sum of k[l] a_lm Y_lm for l <= degree, at nodes u = i / width and v =
// j / (height - 1), written to rows of `width` texels; height is odd, width a
// power of two > 2 degree.
typedef struct wave_grid {
  int width, height;
  vec3 *texels;
} wave_grid;
void wave_synthesise(const wave_grid *out, const wave *w, const double *k,
                     int degree, pool *threads);

#endif
