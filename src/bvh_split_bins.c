// bvh_split_bins.c — prices only: what is computed here in floats chooses a
// plane, and no box of the tree comes from it.

#include "bvh_split_bins.h"

#include <math.h>
#include <stdbool.h>

bvh_split_grid bvh_split_grid_of(const sah_box *box) {
  bvh_split_grid g;
  for (int k = 0; k < 3; k++) {
    g.lo[k] = box->lo[k];
    g.hi[k] = box->hi[k];
    float scale = (float)SPLIT_BINS / (g.hi[k] - g.lo[k]);
    g.scale[k] = isfinite(scale) ? scale : 0;
  }
  return g;
}

// The plane below slice i.
static inline float plane_of(const bvh_split_grid *g, int axis, int i) {
  return g->lo[axis] + (g->hi[axis] - g->lo[axis]) * ((float)i / SPLIT_BINS);
}

static inline int slice_of(const bvh_split_grid *g, int axis, float x) {
  float s = (x - g->lo[axis]) * g->scale[axis];
  return s < 0 ? 0 : s < (float)SPLIT_BINS ? (int)s : SPLIT_BINS - 1;
}

void bvh_split_bins_clear(bvh_split_bins *s) {
  for (int axis = 0; axis < 3; axis++) {
    for (int i = 0; i < SPLIT_BINS; i++) {
      s->box[axis][i] = sah_box_empty();
      s->enter[axis][i] = s->leave[axis][i] = 0;
    }
  }
}

void bvh_split_bins_join(bvh_split_bins *s, const bvh_split_bins *other) {
  for (int axis = 0; axis < 3; axis++) {
    for (int i = 0; i < SPLIT_BINS; i++) {
      sah_box_join(&s->box[axis][i], &other->box[axis][i]);
      s->enter[axis][i] += other->enter[axis][i];
      s->leave[axis][i] += other->leave[axis][i];
    }
  }
}

static inline float centre_of(const sah_box *b, int axis) {
  return 0.5f * b->lo[axis] + 0.5f * b->hi[axis];
}

void bvh_split_bins_add(bvh_split_bins *s, const bvh_split_grid *g,
                        const sah_box *box) {
  for (int axis = 0; axis < 3; axis++) {
    int i = slice_of(g, axis, centre_of(box, axis));
    sah_box_join(&s->box[axis][i], box);
    s->enter[axis][i]++;
    s->leave[axis][i]++;
  }
}

// Grow a slice by a point, moved into the box of the part: so moved, the
// points of an outline span what the part and the box have in common.
static inline void add_point(sah_box *slice, const sah_box *box, sah_lanes v) {
  v = sah_max(sah_min(v, sah_load(box->hi)), sah_load(box->lo));
  sah_grow(slice, v, v);
}

// One edge: its ends in their slices, and where it crosses a plane between
// slices first..last, in the two at the plane.
static void add_edge(sah_box *slices, const bvh_split_grid *g, int axis,
                     const sah_box *box, const sah_lanes ends[2],
                     const int range[2]) {
  bool up = ends[0][axis] <= ends[1][axis];
  sah_lanes a = ends[up ? 0 : 1], b = ends[up ? 1 : 0];
  int i = slice_of(g, axis, a[axis]), j = slice_of(g, axis, b[axis]);
  if (i >= range[0] && i <= range[1]) add_point(&slices[i], box, a);
  if (j >= range[0] && j <= range[1]) add_point(&slices[j], box, b);
  if (i < range[0]) i = range[0];
  if (j > range[1]) j = range[1];
  float inv = 1 / (b[axis] - a[axis]);
  for (; i < j; i++) {
    float t = (plane_of(g, axis, i + 1) - a[axis]) * inv;
    sah_lanes v = a + (sah_lanes){t, t, t, t} * (b - a);
    add_point(&slices[i], box, v);
    add_point(&slices[i + 1], box, v);
  }
}

void bvh_split_bins_add_parts(bvh_split_bins *s, const bvh_split_grid *g,
                              const sah_box *box, const vec3 p[3]) {
  const sah_lanes v[3] = {{p[0].x, p[0].y, p[0].z, 0},
                          {p[1].x, p[1].y, p[1].z, 0},
                          {p[2].x, p[2].y, p[2].z, 0}};
  for (int axis = 0; axis < 3; axis++) {
    int range[2] = {slice_of(g, axis, box->lo[axis]),
                    slice_of(g, axis, box->hi[axis])};
    s->enter[axis][range[0]]++;
    s->leave[axis][range[1]]++;
    if (range[0] == range[1]) {
      sah_box_join(&s->box[axis][range[0]], box);
      continue;
    }
    for (int i = 0; i < 3; i++)
      add_edge(s->box[axis], g, axis, box,
               (const sah_lanes[2]){v[i], v[(i + 1) % 3]}, range);
  }
}

int bvh_split_side(const bvh_split_cut *cut, const sah_box *box) {
  return centre_of(box, cut->axis) < cut->at ? 0 : 1;
}

// The price of each cut along an axis, as sah_costs.
static void price_axis(const bvh_split_bins *s, int axis, double *cost) {
  sah_box box = sah_box_empty();
  uint32_t count = 0;
  for (int i = SPLIT_BINS - 1; i > 0; i--) {
    sah_box_join(&box, &s->box[axis][i]);
    count += s->leave[axis][i];
    cost[i - 1] = count > 0 ? sah_half_area(&box) * count : HUGE_VAL;
  }
  box = sah_box_empty();
  count = 0;
  for (int i = 0; i < SPLIT_BINS - 1; i++) {
    sah_box_join(&box, &s->box[axis][i]);
    count += s->enter[axis][i];
    cost[i] += count > 0 ? sah_half_area(&box) * count : HUGE_VAL;
  }
}

// The two sides of the cut behind slice `after`.
static void fill_sides(bvh_split_cut *cut, const bvh_split_bins *s, int after) {
  cut->side[0] = cut->side[1] = sah_box_empty();
  cut->count[0] = cut->count[1] = 0;
  for (int i = 0; i < SPLIT_BINS; i++) {
    sah_box_join(&cut->side[i > after], &s->box[cut->axis][i]);
    if (i <= after)
      cut->count[0] += s->enter[cut->axis][i];
    else
      cut->count[1] += s->leave[cut->axis][i];
  }
}

bvh_split_cut bvh_split_best(const bvh_split_bins *s, const bvh_split_grid *g,
                             double node_area) {
  bvh_split_cut best = {.axis = -1, .cost = HUGE_VAL};
  int after = 0;
  for (int axis = 0; axis < 3; axis++) {
    double cost[SPLIT_BINS];
    if (!(g->scale[axis] > 0)) continue;
    price_axis(s, axis, cost);
    for (int i = 0; i < SPLIT_BINS - 1; i++) {
      if (!(cost[i] < best.cost)) continue;
      best.axis = axis;
      best.cost = cost[i];
      after = i;
    }
  }
  if (best.axis < 0) return best;
  best.at = plane_of(g, best.axis, after + 1);
  best.cost += SAH_NODE_COST * node_area;
  fill_sides(&best, s, after);
  return best;
}
