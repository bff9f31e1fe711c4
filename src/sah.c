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

// What lies on one side of a cut along each axis.
typedef struct sah_side {
  sah_lanes lo[3], hi[3];
  sah_slices count;
} sah_side;

static sah_side empty_side(void) {
  const float inf = INFINITY;
  const sah_lanes above = {inf, inf, inf, inf};
  return (sah_side){{above, above, above}, {-above, -above, -above}, {0}};
}

static inline void side_grow(sah_side *side, const sah_box *b, int axis) {
  side->lo[axis] = sah_min(sah_load(b->lo), side->lo[axis]);
  side->hi[axis] = sah_max(sah_load(b->hi), side->hi[axis]);
}

// Slice i of each axis joins a side.
static inline void side_add(sah_side *side, const sah_bins *s, int i) {
  side_grow(side, &s->box[0][i], 0);
  side_grow(side, &s->box[1][i], 1);
  side_grow(side, &s->box[2][i], 2);
  side->count += (sah_slices){(int32_t)s->count[0][i], (int32_t)s->count[1][i],
                              (int32_t)s->count[2][i], 0};
}

// Half the area times the number of triangles, a lane an axis, in units of
// 1 / scale squared; infinite or NaN where there are none.
static inline sah_lanes side_prices(const sah_side *side, sah_lanes scale) {
  sah_lanes a = side->hi[0] - side->lo[0], b = side->hi[1] - side->lo[1];
  sah_lanes c = side->hi[2] - side->lo[2];
  sah_lanes x = scale * (sah_lanes){a[0], b[0], c[0], 0};
  sah_lanes y = scale * (sah_lanes){a[1], b[1], c[1], 0};
  sah_lanes z = scale * (sah_lanes){a[2], b[2], c[2], 0};
  return (x * y + y * z + z * x) *
         __builtin_convertvector(side->count, sah_lanes);
}

// By what to multiply the sides of a node so that no area in it overflows.
static float side_scale(const sah_box *node) {
  float longest = 0;
  for (int k = 0; k < 3; k++)
    longest = fmaxf(longest, node->hi[k] - node->lo[k]);
  float scale = 1 / longest;
  return isfinite(scale) ? scale : 1;
}

// The cheapest of the cuts along each axis, a lane each.
typedef struct sah_cheapest {
  sah_lanes price;
  sah_slices after;
} sah_cheapest;

// Two sweeps over the slices of all axes: from the right, what lies behind
// each cut; from the left, what lies before it, and the sum.
static sah_cheapest cheapest_cuts(const sah_bins *s, int bins,
                                  sah_lanes scale) {
  sah_lanes behind[SAH_MAX_BINS];
  sah_side right = empty_side(), left = right;
  for (int i = bins - 1; i > 0; i--) {
    side_add(&right, s, i);
    behind[i - 1] = side_prices(&right, scale);
  }
  sah_cheapest best = {{INFINITY, INFINITY, INFINITY, INFINITY}, {0}};
  for (int i = 0; i < bins - 1; i++) {
    side_add(&left, s, i);
    sah_lanes price = side_prices(&left, scale) + behind[i];
    sah_slices less = price < best.price;
    best.price = (sah_lanes)(((sah_slices)price & less) |
                             ((sah_slices)best.price & ~less));
    best.after = (best.after & ~less) | ((sah_slices){i, i, i, i} & less);
  }
  return best;
}

sah_split sah_best_split(const sah_bins *s, const sah_grid *g,
                         const sah_box *node) {
  float unit = side_scale(node), least = INFINITY;
  sah_split best = {.axis = -1, .cost = HUGE_VAL};
  sah_cheapest cut =
      cheapest_cuts(s, g->bins, (sah_lanes){unit, unit, unit, unit});
  for (int axis = 0; axis < 3; axis++) {
    if (!(g->scale[axis] > 0) || !(cut.price[axis] < least)) continue;
    least = cut.price[axis];
    best.axis = axis;
    best.after = cut.after[axis];
  }
  if (best.axis < 0) return best;
  best.cost = (double)least / ((double)unit * (double)unit) +
              SAH_NODE_COST * sah_half_area(node);
  fill_sides(&best, s, g);
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
