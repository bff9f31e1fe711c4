// build_bins.h — refs into slices, in lanes.  For AVX2.

#ifndef BUILD_BINS_H
#define BUILD_BINS_H

#include "build_lanes.h"
#include "sah.h"

#include <float.h>

#if defined(__AVX2__)

// The places of so many refs are found together.
enum { PLACES = 64 };

// The slices of all axes.
typedef struct lane_bins {
  f8 slice[3][SAH_MAX_BINS];
} lane_bins;

// sah_grid in both halves of registers.
typedef struct lane_grid {
  f8 lo, scale, last;
} lane_grid;

SIMD lane_grid grid_lanes(const sah_grid *g) {
  f4 lo = sah_load(g->lo), scale = sah_load(g->scale);
  return (lane_grid){f8_halves(lo, lo), f8_halves(scale, scale),
                     f8_all((float)(g->bins - 1))};
}

// sah_grid_of.
SIMD sah_grid grid_of(f8 centres, int bins) {
  sah_grid g = {.bins = bins};
  const float n = (float)bins;
  const f4 most = {FLT_MAX, FLT_MAX, FLT_MAX, FLT_MAX};
  const i4 three = {-1, -1, -1, 0};
  f4 lo = f8_low(centres), scale = (f4){n, n, n, n} / box_sides(centres);
  i4 finite = (scale <= most) & (scale >= -most) & three;
  lo = (f4)((i4)lo & three);
  scale = (f4)((i4)scale & finite);
  memcpy(g.lo, &lo, sizeof lo);
  memcpy(g.scale, &scale, sizeof scale);
  return g;
}

// sah_centre of two refs, from the lower and the upper halves of both.
SIMD f8 centres_of(f8 lo, f8 hi) {
  const f8 half = f8_all(0.5f), zero = f8_all(0);
  return f8_add(f8_mul(half, f8_fourths(lo, zero)),
                f8_mul(half, f8_fourths(hi, zero)));
}

// sah_slices_of two refs, in bytes from the first slice.
SIMD void places_find(int32_t at[8], const sah_ref *p, const sah_ref *q,
                      const lane_grid *g) {
  f8 a = f8_load(p->box.lo), b = f8_load(q->box.lo);
  f8 c = centres_of(f8_lows(a, b), f8_highs(a, b));
  f8 x = f8_min(f8_mul(f8_sub(c, g->lo), g->scale), g->last);
  __m256i places = _mm256_slli_epi32(_mm256_cvttps_epi32(x.v), 5);
  _mm256_storeu_si256((__m256i *)(void *)at, places);
}

SIMD void slice_grow(f8 *slices, int32_t place, f8 box) {
  f8 *s = (f8 *)(void *)((char *)slices + place);
  *s = slice_add(*s, box);
}

// n refs into empty slices.  First where a block of them go, then they go: what
// is written to slices would else stand between the one and the next.
SIMD void bins_fill(lane_bins *s, const sah_grid *grid, const sah_ref *refs,
                    size_t n) {
  int32_t at[PLACES][4];
  const lane_grid g = grid_lanes(grid);
  for (int i = 0; i < grid->bins; i++)
    s->slice[0][i] = s->slice[1][i] = s->slice[2][i] = slice_empty();
  for (size_t i = 0; i < n; i += PLACES) {
    const sah_ref *r = refs + i;
    size_t m = n - i < PLACES ? n - i : PLACES;
    for (size_t k = 0; k < m; k += 2)
      places_find(at[k], r + k, r + k + (k + 1 < m), &g);
    for (size_t k = 0; k < m; k++) {
      f8 box = box_load(&r[k].box);
      slice_grow(s->slice[0], at[k][0], box);
      slice_grow(s->slice[1], at[k][1], box);
      slice_grow(s->slice[2], at[k][2], box);
    }
  }
}

static void bin_lanes(sah_bins *to, const sah_grid *g, const sah_ref *refs,
                      size_t n) {
  lane_bins bins;
  bins_fill(&bins, g, refs, n);
  for (int axis = 0; axis < 3; axis++) {
    for (int i = 0; i < g->bins; i++) {
      box_store(&to->box[axis][i], bins.slice[axis][i]);
      to->count[axis][i] = (uint32_t)to->box[axis][i].lo[3];
    }
  }
}

#endif

#endif
