// chi.h — whether counts are what probabilities say.

#ifndef CHI_H
#define CHI_H

#include <math.h>
#include <stddef.h>

// The probability that a chi-square variable of k degrees of freedom exceeds
// x.  Source: Wilson and Hilferty 1931.
static inline double chi_tail(double x, int k) {
  double v = 2.0 / (9.0 * k);
  double z = (cbrt(x / k) - (1 - v)) / sqrt(v);
  return 0.5 * erfc(z / sqrt(2.0));
}

// The probability of counts as far as these from what is expected, where both
// are of cells of one partition; cells are pooled to an expected 5.  What is
// left at the end may not be many where next to none are expected.
static inline double chi_probability(const double *got, const double *want,
                                     size_t n) {
  double sum = 0, of_got = 0, of_want = 0;
  int cells = 0;
  for (size_t i = 0; i < n; i++) {
    of_got += got[i];
    of_want += want[i];
    if (of_want < 5) continue;
    sum += (of_got - of_want) * (of_got - of_want) / of_want;
    of_got = of_want = 0;
    cells++;
  }
  if (of_got >= 30) return 0;
  return cells < 2 ? 1 : chi_tail(sum, cells - 1);
}

#endif
