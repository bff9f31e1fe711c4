// sah.h — where to cut a set of triangles in two.
//
// The surface area heuristic on bins: triangles are sorted into equal slices
// by the centres of their boxes, and only the cuts between slices are priced.

#ifndef SAH_H
#define SAH_H

#include "sah_box.h"

#include <stddef.h>

// Most slices along an axis, and the price of one visit to a node, in triangle
// tests.
enum { SAH_MAX_BINS = 32 };
#define SAH_NODE_COST 1.0

// How many slices, and how a centre finds its slice: (centre - lo) * scale.
// scale is 0 along an axis on which all centres agree.
typedef struct sah_grid {
  int bins;
  float lo[4], scale[4];
} sah_grid;

// The slices of a box along all axes.  The comparison comes before the
// conversion, which is undefined for numbers out of range; the largest centre
// lands on `bins` and belongs to the last.
static inline sah_slices sah_slices_of(const sah_grid *g, const sah_box *b) {
  sah_lanes x = (sah_centre(b) - sah_load(g->lo)) * sah_load(g->scale);
  float bins = (float)g->bins;
  sah_lanes last = {bins - 1, bins - 1, bins - 1, bins - 1};
  sah_slices within = x < (sah_lanes){bins, bins, bins, bins};
  x = (sah_lanes)(((sah_slices)x & within) | ((sah_slices)last & ~within));
  return __builtin_convertvector(x, sah_slices);
}

// What lies in each slice of each axis.
typedef struct sah_bins {
  sah_box box[3][SAH_MAX_BINS];
  uint32_t count[3][SAH_MAX_BINS];
} sah_bins;

// A cut behind slice `after` of an axis, -1 for none; left and right are what
// it parts, cost is in units of one triangle test times an area.
typedef struct sah_split {
  int axis, after;
  double cost;
  uint32_t left_count;
  sah_box left, right;
} sah_split;

// Half the surface area, 0 for an empty box.
double sah_half_area(const sah_box *b);

// A grid of `bins` slices over centres with the given bounds.
sah_grid sah_grid_of(const sah_box *centres, int bins);

// Empty bins; the bins of n triangles added; other bins added.
void sah_bins_clear(sah_bins *s, const sah_grid *g);
void sah_bins_add(sah_bins *s, const sah_grid *g, const sah_ref *refs,
                  size_t n);
void sah_bins_join(sah_bins *s, const sah_grid *g, const sah_bins *other);

// The cheapest cut along any axis of a node with the given box; among equals
// the first.  Prices are compared in single precision.
sah_split sah_best_split(const sah_bins *s, const sah_grid *g,
                         const sah_box *node);

// The cost of every cut along one axis: cost[i] for the cut behind slice i, in
// the units of sah_split, infinite where a side is empty.
void sah_costs(const sah_bins *s, const sah_grid *g, int axis, double *cost);

// The cut through the middle of the longest axis.
sah_split sah_middle_split(const sah_bins *s, const sah_grid *g,
                           const sah_box *centres);

#endif
