// sah.c — the price list of cuts.

#include "sah.h"

#include "aabb.h"

double sah_half_area(const sah_box *b) {
  return aabb_half_area(
      (aabb){{b->lo[0], b->lo[1], b->lo[2]}, {b->hi[0], b->hi[1], b->hi[2]}});
}

sah_grid sah_grid_of(const sah_box *centres, int bins) {
  sah_grid g = {.bins = bins};
  for (int k = 0; k < 3; k++) {
    float scale = (float)bins / (centres->hi[k] - centres->lo[k]);
    g.lo[k] = centres->lo[k];
    g.scale[k] = isfinite(scale) ? scale : 0;
  }
  return g;
}

void sah_bins_clear(sah_bins *s, const sah_grid *g) {
  for (int axis = 0; axis < 3; axis++) {
    for (int i = 0; i < g->bins; i++) {
      s->box[axis][i] = sah_box_empty();
      s->count[axis][i] = 0;
    }
  }
}

void sah_bins_add(sah_bins *s, const sah_grid *g, const sah_ref *refs,
                  size_t n) {
  for (size_t i = 0; i < n; i++) {
    const sah_box *b = &refs[i].box;
    sah_slices at = sah_slices_of(g, b);
    sah_lanes lo = sah_load(b->lo), hi = sah_load(b->hi);
    sah_grow(&s->box[0][at[0]], lo, hi);
    sah_grow(&s->box[1][at[1]], lo, hi);
    sah_grow(&s->box[2][at[2]], lo, hi);
    s->count[0][at[0]]++;
    s->count[1][at[1]]++;
    s->count[2][at[2]]++;
  }
}

void sah_bins_join(sah_bins *s, const sah_grid *g, const sah_bins *other) {
  for (int axis = 0; axis < 3; axis++) {
    for (int i = 0; i < g->bins; i++) {
      sah_box_join(&s->box[axis][i], &other->box[axis][i]);
      s->count[axis][i] += other->count[axis][i];
    }
  }
}

// Two sweeps over the slices: from the right, what lies behind each cut; from
// the left, what lies before it, and the sum.
void sah_costs(const sah_bins *s, const sah_grid *g, int axis, double *cost) {
  sah_box box = sah_box_empty();
  uint32_t count = 0;
  for (int i = g->bins - 1; i > 0; i--) {
    sah_box_join(&box, &s->box[axis][i]);
    count += s->count[axis][i];
    cost[i - 1] = count > 0 ? sah_half_area(&box) * count : HUGE_VAL;
  }
  box = sah_box_empty();
  count = 0;
  for (int i = 0; i < g->bins - 1; i++) {
    sah_box_join(&box, &s->box[axis][i]);
    count += s->count[axis][i];
    cost[i] += count > 0 ? sah_half_area(&box) * count : HUGE_VAL;
  }
}

// The two sides of a cut.
static void fill_sides(sah_split *split, const sah_bins *s, const sah_grid *g) {
  split->left = split->right = sah_box_empty();
  split->left_count = 0;
  for (int i = 0; i < g->bins; i++) {
    sah_box_join(i <= split->after ? &split->left : &split->right,
                 &s->box[split->axis][i]);
    if (i <= split->after) split->left_count += s->count[split->axis][i];
  }
}

sah_split sah_best_split(const sah_bins *s, const sah_grid *g,
                         double node_area) {
  sah_split best = {.axis = -1, .cost = HUGE_VAL};
  for (int axis = 0; axis < 3; axis++) {
    double cost[SAH_MAX_BINS];
    if (!(g->scale[axis] > 0)) continue;
    sah_costs(s, g, axis, cost);
    for (int i = 0; i < g->bins - 1; i++) {
      if (!(cost[i] < best.cost)) continue;
      best.axis = axis;
      best.after = i;
      best.cost = cost[i];
    }
  }
  best.cost += SAH_NODE_COST * node_area;
  if (best.axis >= 0) fill_sides(&best, s, g);
  return best;
}

sah_split sah_middle_split(const sah_bins *s, const sah_grid *g,
                           const sah_box *centres) {
  sah_split cut = {.axis = -1, .after = g->bins / 2 - 1, .cost = 0};
  float longest = 0;
  for (int axis = 0; axis < 3; axis++) {
    float side = centres->hi[axis] - centres->lo[axis];
    if (side > longest && g->scale[axis] > 0) {
      longest = side;
      cut.axis = axis;
    }
  }
  if (cut.axis >= 0) fill_sides(&cut, s, g);
  return cut;
}
