// tonemap.h — from radiance to what a screen can show: exposure and a curve.

#ifndef TONEMAP_H
#define TONEMAP_H

#include "image.h"

typedef enum tonemap_curve {
  TONEMAP_NONE,
  TONEMAP_REINHARD,
  TONEMAP_ACES
} tonemap_curve;

// Multiply every pixel by 2^stops and apply the curve, in place.  The result
// is still linear; without a curve it may exceed 1.
void tonemap_apply(image *im, float stops, tonemap_curve curve);

#endif
