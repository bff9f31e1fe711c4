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

// Row i of a walk: the first numbers of eight columns, one by one, as they will
// be asked for.
SIMD void walk_first(wide_walk *w, size_t i, const f8 column[8]) {
  char *to = (char *)w + i * sizeof(f8);
  memcpy(to, &column[0], sizeof(float));
  memcpy(to + 4, &column[1], sizeof(float));
  memcpy(to + 8, &column[2], sizeof(float));
  memcpy(to + 12, &column[3], sizeof(float));
  memcpy(to + 16, &column[4], sizeof(float));
  memcpy(to + 20, &column[5], sizeof(float));
  memcpy(to + 24, &column[6], sizeof(float));
  memcpy(to + 28, &column[7], sizeof(float));
}

// One ray alone; false for one that can hit nothing.
SIMD bool walk_start(wide_walk *w, const wide_tree *t, const ray *r) {
  if (t->nodes == NULL) return false;
  const f8 v[8] = {f8_all(r->o.x),  f8_all(r->o.y), f8_all(r->o.z),
                   f8_all(r->d.x),  f8_all(r->d.y), f8_all(r->d.z),
                   f8_all(r->tmin), f8_all(r->tmax)};
  ready_rays q;
  ready_columns(&q, t, v);
  walk_first(w, 0, q.column[0]);
  walk_first(w, 1, q.column[1]);
  walk_first(w, 2, q.column[2]);
  walk_first(w, 3, q.column[3]);
  w->r = r;
  return (q.can & 1) != 0;
}

#endif
