// build_kernel.h — what bvh_part does, by more lanes and in fewer passes; the
// same tree to the bit.  Compiled once a level.

#ifndef BUILD_KERNEL_H
#define BUILD_KERNEL_H

#include "bvh_part.h"
#include "build_lanes.h"

#include <float.h>

enum { AHEAD = 64 };
// The slices of all axes.
typedef struct lane_bins {
  f8 slice[3][SAH_MAX_BINS];
} lane_bins;

// A node to be, as bvh_part.
typedef struct lane_part {
  f8 box, centres;
  uint32_t begin, end, node;
  int depth;
} lane_part;

SIMD void bins_clear(lane_bins *s, int bins) {
  f8 none = slice_empty();
  for (int i = 0; i < bins; i++)
    s->slice[0][i] = s->slice[1][i] = s->slice[2][i] = none;
}

SIMD f8 *slice_at(f8 *slices, int32_t bytes) {
  return (f8 *)(void *)((char *)slices + bytes);
}

// The slices of two refs, as places in bytes.
SIMD void places_find(int32_t at[8], const sah_ref *p, const sah_ref *q, f8 lo, f8 scale,
                      f8 last) {
  const __m256i three = _mm256_set_epi32(0, -1, -1, -1, 0, -1, -1, -1);
  const __m256 half = _mm256_set1_ps(0.5f);
  __m256 a = f8_load(p->box.lo).v, b = f8_load(q->box.lo).v;
  __m256 l = _mm256_permute2f128_ps(a, b, 0x20);
  __m256 h = _mm256_permute2f128_ps(a, b, 0x31);
  l = _mm256_and_ps(l, _mm256_castsi256_ps(three));
  h = _mm256_and_ps(h, _mm256_castsi256_ps(three));
  __m256 c = _mm256_add_ps(_mm256_mul_ps(half, l), _mm256_mul_ps(half, h));
  c = _mm256_min_ps(_mm256_mul_ps(_mm256_sub_ps(c, lo.v), scale.v), last.v);
  _mm256_store_si256((__m256i *)(void *)at, _mm256_slli_epi32(_mm256_cvttps_epi32(c), 5));
}

SIMD void bins_put(lane_bins *s, const int32_t at[4], const sah_box *from) {
  f8 box = box8_load(from);
  f8 *a = slice_at(s->slice[0], at[0]), *b = slice_at(s->slice[1], at[1]);
  f8 *c = slice_at(s->slice[2], at[2]);
  *a = slice_add(*a, box);
  *b = slice_add(*b, box);
  *c = slice_add(*c, box);
}

SIMD void bins_fill(lane_bins *s, const sah_grid *g, const sah_ref *refs,
                    size_t n) {
  _Alignas(32) int32_t at[AHEAD + 1][4];
  const f8 last = f8_all((float)(g->bins - 1));
  const f8 lo = f8_halves(sah_load(g->lo), sah_load(g->lo));
  const f8 scale = f8_halves(sah_load(g->scale), sah_load(g->scale));
  for (size_t i = 0; i < n; i += AHEAD) {
    size_t m = n - i < AHEAD ? n - i : AHEAD;
    for (size_t k = 0; k < m; k += 2)
      places_find(at[k], refs + i + k, refs + i + k + (k + 1 < m), lo, scale, last);
    for (size_t k = 0; k < m; k++)
      bins_put(s, at[k], &refs[i + k].box);
  }
}

// Half the areas of three boxes times the numbers of their triangles, by
// their halves added up: a lane an axis, left sides in the lower half, right
// ones in the upper.  scale is negative, as these sums are.
SIMD f8 side_prices(const f8 left[3], const f8 right[3], f8 scale) {
  f8 v[4], s[3];
  for (int k = 0; k < 3; k++)
    s[k] = f8_fold(left[k], right[k]);
  f8_mix(v, s[0], s[1], s[2], s[2]);
  f8 x = f8_mul(v[0], scale), y = f8_mul(v[1], scale), z = f8_mul(v[2], scale);
  f8 areas = f8_add(f8_add(f8_mul(x, y), f8_mul(y, z)), f8_mul(z, x));
  return f8_mul(areas, v[3]);
}

// By what to multiply the sides of a node so that no area in it overflows.
SIMD float unit_of(f8 node) {
  f4 d = box8_sides(node);
  float longest = d[0] > d[1] ? d[0] : d[1];
  longest = longest > d[2] ? longest : d[2];
  float scale = 1 / longest;
  return scale <= FLT_MAX ? scale : 1;
}

// sah_split without its boxes; price is in units of 1 / unit squared.
typedef struct lane_cut {
  int axis, after;
  float price, unit;
} lane_cut;

// Both sweeps of sah_best_split at once.
SIMD void prices_sweep(const lane_bins *s, int cuts, float unit, f4 *before,
                       f4 *behind) {
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

// sah_best_split.
SIMD lane_cut cut_find(const lane_bins *s, const sah_grid *g, f8 node) {
  lane_cut cut = {-1, 0, INFINITY, unit_of(node)};
  f4 before[SAH_MAX_BINS], behind[SAH_MAX_BINS];
  f4 least = {INFINITY, INFINITY, INFINITY, INFINITY};
  i4 after = {0};
  prices_sweep(s, g->bins - 1, cut.unit, before, behind);
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

// Where refs go, and the bounds of the centres of those that went.
typedef struct lane_ways {
  sah_ref *left, *right;
  f8 centres[2];
} lane_ways;

// Refs to their sides, in order: with `both` written to both, where what is
// too much is written over.
SIMD void refs_part(lane_ways *to, const sah_ref *refs, size_t n,
                    const sah_grid *g, int axis, int after, bool both) {
  const uint32_t k = (uint32_t)axis, which[8] = {k, k, k, k, k, k, k, k};
  const f8 lo = f8_halves(sah_load(g->lo), sah_load(g->lo));
  const f8 scale = f8_halves(sah_load(g->scale), sah_load(g->scale));
  const f8 limit = f8_all((float)(after + 1)), none = box8_empty();
  f8 a = none, b = none;
  sah_ref *left = to->left, *right = to->right;
  for (size_t i = 0; i < n; i++) {
    f8 r = f8_load(refs[i].box.lo);
    f4 c = sah_centre(&refs[i].box);
    f8 cc = f8_halves(c, c), centre = f8_turn_high(cc);
    f8 x = f8_choose(f8_mul(f8_sub(cc, lo), scale), which);
    size_t goes_left = f8_lt(x, limit) & 1;
    a = box8_join(a, f8_where_lt(x, limit, centre, none));
    b = box8_join(b, f8_where_lt(x, limit, none, centre));
    if (both) {
      f8_store(left->box.lo, r);
      f8_store(right->box.lo, r);
    } else {
      f8_store((goes_left != 0 ? left : right)->box.lo, r);
    }
    left += goes_left;
    right += 1 - goes_left;
  }
  *to = (lane_ways){left, right, {a, b}};
}

SIMD sah_grid grid_of(f8 centres, int bins) {
  sah_grid g = {.bins = bins};
  const float n = (float)bins;
  sah_lanes lo = f8_low(centres);
  sah_lanes scale = (sah_lanes){n, n, n, n} / box8_sides(centres);
  const sah_slices three = {-1, -1, -1, 0};
  const sah_lanes most = {FLT_MAX, FLT_MAX, FLT_MAX, FLT_MAX};
  const sah_lanes none = {0};
  scale = (sah_lanes)((sah_slices)scale & (scale <= most) & (scale >= none) & three);
  lo = (sah_lanes)((sah_slices)lo & three);
  memcpy(g.lo, &lo, sizeof lo);
  memcpy(g.scale, &scale, sizeof scale);
  return g;
}

SIMD bvh_part plain_part(const lane_part *p) {
  bvh_part q = {p->begin, p->end, p->node, p->depth, {{0}, {0}}, {{0}, {0}}};
  box8_store(&q.box, p->box);
  box8_store(&q.centres, p->centres);
  return q;
}

SIMD lane_part part_lanes(const bvh_part *p) {
  return (lane_part){box8_load(&p->box), box8_load(&p->centres), p->begin,
                     p->end, p->node, p->depth};
}

static bool split_plainly(bvh_task *t, const lane_part *p, lane_part child[2]) {
  bvh_part from = plain_part(p), to[2];
  if (!bvh_task_split(t, &from, to)) return false;
  child[0] = part_lanes(&to[0]);
  child[1] = part_lanes(&to[1]);
  return true;
}

SIMD void leaf_put(bvh_task *t, const lane_part *p) {
  sah_box box;
  box8_store(&box, p->box);
  t->nodes[p->node] = bvh_node_of(&box, p->begin, p->end - p->begin);
  if (p->depth > t->depth) t->depth = p->depth;
}

static inline double area_of(f8 b) {
  sah_box box;
  box8_store(&box, b);
  return sah_half_area(&box);
}

SIMD bool task_split(bvh_task *t, const lane_part *p, lane_part child[2]) {
  uint32_t n = p->end - p->begin;
  if (n == 1 || (t->method == BVH_COARSE && n <= BVH_COARSE_LEAF)) {
    leaf_put(t, p);
    return false;
  }
  sah_grid g = grid_of(p->centres, bvh_bins_for(n, t->method));
  bool flat = g.scale[0] == 0 && g.scale[1] == 0 && g.scale[2] == 0;
  if (flat || t->method == BVH_MEDIAN ||
      p->depth + 32 - __builtin_clz(n - 1) >= BVH_MAX_DEPTH)
    return split_plainly(t, p, child);
  lane_bins bins;
  bins_clear(&bins, g.bins);
  bins_fill(&bins, &g, t->refs + p->begin, n);
  lane_cut cut = cut_find(&bins, &g, p->box);
  if (cut.axis < 0) return split_plainly(t, p, child);
  if (n <= BVH_MAX_LEAF && t->method != BVH_ONES) {
    double area = area_of(p->box);
    double cost = (double)cut.price / ((double)cut.unit * (double)cut.unit) +
                  SAH_NODE_COST * area;
    if (!(cost < area * n)) {
      leaf_put(t, p);
      return false;
    }
  }
  child[0].box = child[1].box = box8_empty();
  for (int i = 0; i <= cut.after; i++)
    child[0].box = box8_join(child[0].box, bins.slice[cut.axis][i]);
  for (int i = cut.after + 1; i < g.bins; i++)
    child[1].box = box8_join(child[1].box, bins.slice[cut.axis][i]);
  lane_ways ways = {.left = t->refs + p->begin, .right = t->spare};
  refs_part(&ways, t->refs + p->begin, n, &g, cut.axis, cut.after, true);
  size_t rights = (size_t)(ways.right - t->spare);
  for (size_t i = 0; i < rights; i++)
    ways.left[i] = t->spare[i];
  sah_box box;
  box8_store(&box, p->box);
  t->nodes[p->node] = bvh_node_of(&box, t->node_count, 0);
  uint32_t middle = p->end - (uint32_t)rights;
  for (int side = 0; side < 2; side++) {
    lane_part *c = &child[side];
    c->begin = side == 0 ? p->begin : middle;
    c->end = side == 0 ? middle : p->end;
    c->node = t->node_count++;
    c->depth = p->depth + 1;
    c->centres = ways.centres[side];
  }
  return true;
}

static void kernel_task(bvh_task *t) {
  lane_part stack[BVH_MAX_DEPTH + 1], child[2];
  int top = 0;
  stack[top++] = part_lanes(&t->root);
  stack[0].node = 0;
  t->node_count = 1;
  t->depth = t->root.depth;
  while (top > 0) {
    lane_part p = stack[--top];
    while (task_split(t, &p, child)) {
      stack[top++] = child[1];
      p = child[0];
    }
  }
}

static void kernel_bin(sah_bins *to, const sah_grid *g, const sah_ref *refs,
                       size_t n) {
  lane_bins bins;
  bins_clear(&bins, g->bins);
  bins_fill(&bins, g, refs, n);
  for (int axis = 0; axis < 3; axis++)
    for (int i = 0; i < g->bins; i++) {
      box8_store(&to->box[axis][i], bins.slice[axis][i]);
      to->count[axis][i] = (uint32_t)to->box[axis][i].lo[3];
    }
}

static void kernel_move(bvh_move *m) {
  lane_ways ways = {.left = m->to[0], .right = m->to[1]};
  refs_part(&ways, m->refs, m->count, &m->cut->grid, m->cut->split.axis,
            m->cut->split.after, false);
  box8_store(&m->centres[0], ways.centres[0]);
  box8_store(&m->centres[1], ways.centres[1]);
}

#define BUILD_HANDS \
  { kernel_bin, kernel_move, kernel_task }

#endif
