// two_means.h — how wrong a picture is, by how far two pictures of the same
// thing are apart.

#ifndef TWO_MEANS_H
#define TWO_MEANS_H

#include "pool.h"

#include <stdbool.h>
#include <stddef.h>

// Pixels of a row, three channels of one after the other: two means with the
// same expectation and errors that know nothing of each other, and something
// else to be averaged like the error.
typedef struct two_means_run {
  double *a, *b, *other;  // all 0 before
  bool *has;              // two means; else nothing else counts
} two_means_run;

// Whoever knows the pixels: n of a row, from pixel i on.
typedef struct two_means {
  int width, height;
  const void *self;
  void (*run)(const void *self, size_t i, int n, const two_means_run *out);
} two_means;

// Averages over pixels and channels of x / (radiance^2 + 0.01).
typedef struct two_means_sums {
  double square;  // x = ((a - b) / 2)^2: estimates relMSE of (a + b) / 2
  double other;   // x = other
  double doubt;   // the standard error of square
} two_means_sums;

// All 0 when no pixel has two means.  terms may be NULL, or gets what each
// pixel adds to the sum behind `square`, row by row.
two_means_sums two_means_measure(const two_means *t, double *terms,
                                 pool *threads);

#endif
