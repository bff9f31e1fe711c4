// film.h — sums of samples, pixel by pixel.

#ifndef FILM_H
#define FILM_H

#include "image.h"

// Double sums, so that neither the order nor the number of samples shows: the
// mean of 65,536 samples keeps 1e-12.  Pixel (x, y) is number y * width + x.
typedef struct film {
  int width, height;
  double (*sum)[3];
  double (*square)[3];  // sums of squares; NULL when nobody asks for variance
  uint32_t *count;
} film;

film film_new(arena *mem, int width, int height, bool with_variance);

// Make to hold what from holds: films of one size, both with squares or none.
void film_copy(film *to, const film *from);

// Bytes of its sums; 0 of one that is not there.
size_t film_bytes(const film *f);

// One more sample of pixel i, which must be finite.
void film_add(film *f, size_t i, vec3 sample);

// Mean of the samples, and the estimated variance of that mean, by channel;
// 0 where there is no sample, or fewer than two.
vec3 film_mean(const film *f, size_t i);
vec3 film_variance(const film *f, size_t i);

image film_image(const film *f, arena *mem);
image film_variance_image(const film *f, arena *mem);
image film_count_image(const film *f, arena *mem);

// The estimated relative error of the picture: the square root of relMSE =
// mean over pixels and channels of variance / (radiance^2 + 0.01).  0 when
// there are fewer than two samples or no sums of squares.
double film_error(const film *f);

// A rectangle of pixels, half-open.
typedef struct film_box {
  int x0, y0, x1, y1;
} film_box;

// The sum over its pixels and channels of variance / (radiance^2 + 0.01).
double film_box_error(const film *f, const film_box *box);

#endif
