// build_move.h — refs to the sides of a cut, in lanes.  For AVX2.

#ifndef BUILD_MOVE_H
#define BUILD_MOVE_H

#include "build_cut.h"
#include "bvh_part.h"

#if defined(__AVX2__)

// Where refs go, and the bounds of the centres of those that have gone.
typedef struct lane_ways {
  sah_ref *to[2];
  f8 centres[2];
} lane_ways;

// n refs to their sides of a cut, in order.  With `both` each is written to
// both, for a side to write over where it ends.
SIMD void refs_part(lane_ways *ways, const sah_ref *refs, size_t n,
                    const sah_grid *grid, const lane_cut *cut, bool both) {
  const uint32_t k = (uint32_t)cut->axis, axis[8] = {k, k, k, k, k, k, k, k};
  const lane_grid g = grid_lanes(grid);
  const f8 limit = f8_all((float)(cut->after + 1)), none = box_empty();
  sah_ref *left = ways->to[0], *right = ways->to[1];
  f8 a = none, b = none;
  for (size_t i = 0; i < n; i++) {
    f8 r = f8_load(refs[i].box.lo);
    f8 c = centres_of(f8_lows(r, r), f8_highs(r, r));
    f8 x = f8_choose(f8_mul(f8_sub(c, g.lo), g.scale), axis);
    size_t goes_left = f8_lt(x, limit) & 1;
    c = f8_negate_high(c);
    a = box_join(a, f8_where_lt(x, limit, c, none));
    b = box_join(b, f8_where_lt(x, limit, none, c));
    f8_store((both || goes_left != 0 ? left : right)->box.lo, r);
    if (both) f8_store(right->box.lo, r);
    left += goes_left;
    right += 1 - goes_left;
  }
  *ways = (lane_ways){{left, right}, {a, b}};
}

static void move_lanes(bvh_move *m) {
  const sah_split *split = &m->cut->split;
  if (split->axis < 0) {
    bvh_plain_hands.move(m);
    return;
  }
  lane_cut cut = {split->axis, split->after, 0, 0};
  lane_ways ways = {.to = {m->to[0], m->to[1]}};
  refs_part(&ways, m->refs + m->begin, m->end - m->begin, &m->cut->grid, &cut,
            false);
  box_store(&m->centres[0], ways.centres[0]);
  box_store(&m->centres[1], ways.centres[1]);
}

#endif

#endif
