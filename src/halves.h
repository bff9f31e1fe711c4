// halves.h — every pixel twice, by two sequences of samples that know nothing
// of each other.

#ifndef HALVES_H
#define HALVES_H

#include "film.h"
#include "path_world.h"

// The same paths with other numbers: the even samples of a pixel are the
// first, second, ... of its own sequence, the odd ones those of a pixel beyond
// the film, which nobody else uses.
typedef struct halves_walk {
  const integrator *by;
  uint64_t pixels;  // of the full film
} halves_walk;

integrator halves_integrator(const halves_walk *w);

// Sums of even and odd samples, apart, with squares.
typedef struct halves {
  film half[2];
} halves;

halves halves_new(arena *mem, int width, int height);
void halves_add(halves *h, size_t i, uint32_t sample, vec3 color);

// The mean of the two means, whatever their numbers of samples are: then it
// does not matter who decided on these numbers.  And the variance of that.
vec3 halves_mean(const halves *h, size_t i);
vec3 halves_variance(const halves *h, size_t i);

// The two means of a channel; 0 where there is no sample.
void halves_means(const halves *h, size_t i, int channel, double out[2]);

// The relative error of the picture, and how well that is known: its standard
// error, as a share of it.  Both 0 where no pixel has both means.  terms may be
// NULL, or gets what each pixel has in the sum of squared errors.
typedef struct halves_estimate {
  double error, doubt;
} halves_estimate;

halves_estimate halves_error(const halves *h, double *terms, pool *threads);

#endif
