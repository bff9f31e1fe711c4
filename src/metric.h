// metric.h — how far one picture is from another.

#ifndef METRIC_H
#define METRIC_H

#include "image.h"

// Differences of a picture a from a reference b over all channels of all
// pixels, in the units of the images.
typedef struct metric {
  double rmse, mae, max, p999;  // p999: 99.9th percentile of a pixel's largest
  double mse, relmse;           // relmse = mean((a-b)^2 / (b^2 + 0.01))
  double psnr;                  // 10 log10(1 / mse) dB, infinity when equal
  double mean;                  // of a - b, signed
  int worst_x, worst_y;         // the pixel of max
  long differing;               // pixels that differ at all
  bool non_finite;              // then only bad_x, bad_y, bad_in_b are set
  int bad_x, bad_y;
  bool bad_in_b;
} metric;

// Compare two images of the same size; scratch is for the percentile.
metric metric_compare(const image *a, const image *b, arena *scratch);

#endif
