// wide_few_ready.h — eight rays of the same longest axis, made ready.

#ifndef WIDE_FEW_READY_H
#define WIDE_FEW_READY_H

#include "wide_few.h"

// t det is at most three products of three numbers, and none of those is larger
// than `most`: t_error of triangle.c is at most 171 roundings of its cube over
// det, an error of det no more than 120, and the bound more than twice the sum.
SIMD void few_bound(few_rays *r, const wide_tree *t, const f8 v[8]) {
  f8 far = f8_max(f8_max(ready_far(t, v, 0), ready_far(t, v, 1)),
                  ready_far(t, v, 2));
  f8 most = f8_max(f8_mul(f8_all(2), far), r->of.reach);
  f8 cube = f8_mul(most, f8_mul(most, most));
  r->error = f8_add(f8_mul(cube, f8_all(0x1.8p-15f)), f8_all(0x1p-80f));
  r->end = f8_mul(r->of.tmax, f8_all(1 + 0x1p-20f));
}

// Eight rays of a list, from number `first` on; the last one again where it
// ends.
SIMD void few_ready(few_rays *r, const few_leaves *l, const ray *rays,
                    const uint32_t *list, uint32_t count) {
  ready_rays q;
  f8 v[8];
  const char *row[8];
  for (uint32_t i = 0; i < 8; i++) {
    r->ray[i] = &rays[list[i < count ? i : count - 1]];
    row[i] = (const char *)r->ray[i];
  }
  f8_columns(v, row, 0);
  ready_columns(&q, l->t, v);
  const f8 *a = q.column[0], *b = q.column[1], *c = q.column[2];
  r->of.rays = (leaf_rays){{a[0], a[1], a[2]}, a[3], a[4]};
  r->of.sz = a[5], r->of.tmin = a[6], r->of.tmax = r->of.best = a[7];
  r->of.reach = b[3], r->of.large = l->t->large;
  r->begin = q.column[3][6];
  few_bound(r, l->t, v);
  f8_store(r->sx, a[3]);
  f8_store(r->sy, a[4]);
  f8_store(r->sz, a[5]);
  for (uint32_t k = 0; k < 3; k++) {
    uint32_t x = r->axis[k];
    r->of.inv[k] = b[x], r->of.enter[k] = b[4 + x], r->of.leave[k] = c[x];
    f8_store(r->inv[k], b[k]);
    f8_store(r->enter[k], b[4 + k]);
    f8_store(r->leave[k], c[k]);
  }
  r->alive = q.can & ((1u << count) - 1);
}

#endif
