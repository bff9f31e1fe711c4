// roulette.h — which paths go on: those of little throughput by chance, and
// none for ever.

#ifndef ROULETTE_H
#define ROULETTE_H

#include "vec.h"

// A path whose throughput falls below this plays roulette for it.
#define ROULETTE_BELOW 0.25f

// From this segment on even a path that lost nothing goes on with this
// probability only, so that mirrors facing each other end.
enum { ROULETTE_LOSSLESS_FROM = 4096 };
#define ROULETTE_LOSSLESS 0.999f

// The most rays of a path.  Unreachable by the roulette above (e^-99), except
// through sheets that let light straight through, which do not play.
enum { ROULETTE_MAX_RAYS = 100000 };

// The probability with which a path goes on; its survivors stand for those
// that ended, whose throughput they get.
static inline float roulette_odds(vec3 throughput, int segment) {
  float q = vec3_peak(throughput) / ROULETTE_BELOW;
  return float_min(q, segment < ROULETTE_LOSSLESS_FROM ? 1 : ROULETTE_LOSSLESS);
}

#endif
