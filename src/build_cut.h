// build_cut.h — the cheapest cut between slices, in lanes.  For AVX2.

#ifndef BUILD_CUT_H
#define BUILD_CUT_H

#include "build_bins.h"

#if defined(__AVX2__)

// Of three sides left of cuts and three right of them: half their areas times
// their triangles, a lane an axis, left ones in the lower half.  The halves of
// a box add up to its sides negated, and so scale is negative.
SIMD f8 side_prices(const f8 left[3], const f8 right[3], f8 scale) {
  f8 s[3], v[4];
  for (int k = 0; k < 3; k++)
    s[k] = f8_add(f8_lows(left[k], right[k]), f8_highs(left[k], right[k]));
  f8_mix(v, s[0], s[1], s[2], s[2]);
  f8 x = f8_mul(v[0], scale), y = f8_mul(v[1], scale), z = f8_mul(v[2], scale);
  f8 areas = f8_add(f8_add(f8_mul(x, y), f8_mul(y, z)), f8_mul(z, x));
  return f8_mul(areas, v[3]);
}

// Both sweeps of sah_best_split at once: prices of what is before each cut, and
// of what is behind it.
SIMD void sweep(f4 *before, f4 *behind, const lane_bins *s, int cuts,
                float unit) {
  const f8 scale = f8_all(-unit);
  f8 left[3], right[3];
  for (int k = 0; k < 3; k++)
    left[k] = right[k] = slice_empty();
  for (int i = 0; i < cuts; i++) {
    for (int k = 0; k < 3; k++) {
      left[k] = slice_join(left[k], s->slice[k][i]);
      right[k] = slice_join(right[k], s->slice[k][cuts - i]);
    }
    f8 prices = side_prices(left, right, scale);
    before[i] = f8_low(prices);
    behind[cuts - 1 - i] = f8_high(prices);
  }
}

// By what to multiply the sides of a node so that no area in it overflows.
SIMD float unit_of(f8 node) {
  f4 d = box_sides(node);
  float longest = d[0] > d[1] ? d[0] : d[1];
  float unit = 1 / (longest > d[2] ? longest : d[2]);
  return unit <= FLT_MAX ? unit : 1;
}

// sah_split without its boxes; the price is in units of 1 / unit squared.
typedef struct lane_cut {
  int axis, after;
  float price, unit;
} lane_cut;

// sah_best_split.
SIMD lane_cut cut_find(const lane_bins *s, const sah_grid *g, f8 node) {
  lane_cut cut = {-1, 0, INFINITY, unit_of(node)};
  f4 before[SAH_MAX_BINS], behind[SAH_MAX_BINS], least = f8_low(box_empty());
  i4 after = {0};
  sweep(before, behind, s, g->bins - 1, cut.unit);
  for (int i = 0; i < g->bins - 1; i++) {
    f4 price = before[i] + behind[i];
    i4 less = price < least;
    least = f4_pick(less, price, least);
    after = (after & ~less) | ((i4){i, i, i, i} & less);
  }
  for (int axis = 0; axis < 3; axis++) {
    if (!(g->scale[axis] > 0) || !(least[axis] < cut.price)) continue;
    cut.price = least[axis];
    cut.axis = axis;
    cut.after = after[axis];
  }
  return cut;
}

SIMD f8 slices_bound(const f8 *slice, int begin, int end) {
  f8 box = box_empty();
  for (int i = begin; i < end; i++)
    box = box_join(box, slice[i]);
  return box;
}

#endif

#endif
