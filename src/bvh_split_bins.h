// bvh_split_bins.h — where to cut a node in two so that triangles are cut too.
//
// As sah.h, but a slice is a part of space: a large triangle counts in every
// slice that it crosses, each time with the box of its part.

#ifndef BVH_SPLIT_BINS_H
#define BVH_SPLIT_BINS_H

#include "sah.h"
#include "vec.h"

// Slices along an axis.
enum { SPLIT_BINS = 16 };

// Slices of equal width from lo to hi; scale 0 along an axis without width.
typedef struct bvh_split_grid {
  float lo[3], hi[3], scale[3];
} bvh_split_grid;

// What lies in each slice, and how many triangles begin and end in it.
typedef struct bvh_split_bins {
  sah_box box[3][SPLIT_BINS];
  uint32_t enter[3][SPLIT_BINS], leave[3][SPLIT_BINS];
} bvh_split_bins;

// A cut at a plane across an axis, -1 for none, with what it expects on either
// side; cost as in sah_split.
typedef struct bvh_split_cut {
  int axis;
  float at;
  double cost;
  uint32_t count[2];
  sah_box side[2];
} bvh_split_cut;

bvh_split_grid bvh_split_grid_of(const sah_box *box);

void bvh_split_bins_clear(bvh_split_bins *s);
void bvh_split_bins_join(bvh_split_bins *s, const bvh_split_bins *other);

// A triangle that stays whole, in the slice of its centre; the part in `box`
// of the triangle p.
void bvh_split_bins_add(bvh_split_bins *s, const bvh_split_grid *g,
                        const sah_box *box);
void bvh_split_bins_add_parts(bvh_split_bins *s, const bvh_split_grid *g,
                              const sah_box *box, const vec3 p[3]);

// On which side of a cut a triangle that stays whole belongs.
int bvh_split_side(const bvh_split_cut *cut, const sah_box *box);

// The cheapest cut along any axis; among equals the first.
bvh_split_cut bvh_split_best(const bvh_split_bins *s, const bvh_split_grid *g,
                             double node_area);

#endif
