// wide_ready.h — eight rays made ready together.

#ifndef WIDE_READY_H
#define WIDE_READY_H

#include "wide_columns.h"

// Of rays v, number by number.
SIMD void ready_columns(ready_rays *q, const wide_tree *t, const f8 v[8]) {
  f8 d[3], a[3], far[3], turned[3];
  f8 *to = q->column[0], one = f8_all(1), minus = f8_all(-1);
  uint32_t odd = 0, some = 0;
  a[0] = ready_direction(d, v, 0, &odd, &some);
  a[1] = ready_direction(d, v, 1, &odd, &some);
  a[2] = ready_direction(d, v, 2, &odd, &some);
  q->can = ~odd & some & 0xff;
  far[0] = ready_far(t, v, 0);
  far[1] = ready_far(t, v, 1);
  far[2] = ready_far(t, v, 2);
  f8 x = f8_where_lt(a[2], a[0], minus, one);
  f8 y = f8_where_lt(a[2], a[1], minus, one);
  x = f8_where_lt(a[1], a[0], x, one);
  y = f8_where_lt(a[1], a[0], one, y);
  turn_axes(to, v + RAY_O, x, y);
  turn_axes(turned, d, x, y);
  f8 dz = turned[2];
  to[3] = f8_div(turned[0], dz);
  to[4] = f8_div(turned[1], dz);
  to[5] = f8_div(one, dz);
  to[6] = v[RAY_MIN];
  to[7] = v[RAY_MAX];
  to = q->column[1];
  to[0] = f8_div(one, d[0]);
  to[1] = f8_div(one, d[1]);
  to[2] = f8_div(one, d[2]);
  turn_axes(turned, far, x, y);
  to[3] = f8_div(turned[2], f8_abs(dz));
  ready_axis(q, 0, v[RAY_O], a[0], far[0]);
  ready_axis(q, 1, v[RAY_O + 1], a[1], far[1]);
  ready_axis(q, 2, v[RAY_O + 2], a[2], far[2]);
  to[7] = x;
  to = q->column[2];
  to[3] = y;
  to[4] = v[RAY_MAX];
  to[5] = to[6] = f8_all(0);
  to[7] = f8_bits(HIT_NONE);
  to = q->column[3];
  const f8 axis[3] = {f8_bits(0), f8_bits(1), f8_bits(2)};
  turn_axes(to + 3, axis, x, y);
  to[6] = f8_max(v[RAY_MIN], f8_all(0));
  to[7] = f8_all(t->large);
}

// Row i of a walk.
SIMD void walk_row(wide_walk *w, size_t i, const float row[8]) {
  memcpy((char *)w + i * sizeof(f8), row, sizeof(f8));
}

// One ray alone; false for one that can hit nothing.
SIMD bool walk_start(wide_walk *w, const wide_tree *t, const ray *r) {
  f8 v[8];
  ready_rays q;
  if (t->nodes == NULL) return false;
  for (int k = 0; k < 8; k++)
    v[k] = f8_all((&r->o.x)[k]);
  ready_columns(&q, t, v);
  float row[8][8];
  for (size_t i = 0; i < ROWS; i++) {
    f8_store_rows(row, q.column[i]);
    walk_row(w, i, row[0]);
  }
  w->r = r;
  return (q.can & 1) != 0;
}

#endif
