// wide_few_leaf.h — eight rays and the triangles of a leaf.

#ifndef WIDE_FEW_LEAF_H
#define WIDE_FEW_LEAF_H

#include "wide_few.h"

// The lanes whose triangle lies behind the ray or beyond its end, so far that
// no rounding matters.
SIMD uint32_t few_apart(const leaf_shear *c, const few_rays *r) {
  f8 zero = f8_all(0), det = f8_add(f8_add(c->e[0], c->e[1]), c->e[2]);
  f8 t = f8_add(f8_mul(c->e[0], c->z[0]), f8_mul(c->e[1], c->z[1]));
  t = f8_mul(f8_add(t, f8_mul(c->e[2], c->z[2])), r->of.sz);
  t = f8_where_lt(det, zero, f8_sub(zero, t), t);
  f8 end = f8_add(f8_mul(f8_abs(det), r->end), r->error);
  return f8_lt(r->error, f8_sub(zero, t)) | f8_lt(end, t);
}

// Which rays enter leaf i: cut_axis, axis by axis.
SIMD uint32_t few_enter(const few_leaves *l, uint32_t i, const few_rays *r) {
  f8 near = r->begin, far = r->of.tmax, zero = f8_all(0);
  for (int k = 0; k < 3; k++) {
    f8 lo = f8_all(l->lo[i][r->axis[k]]), hi = f8_all(l->hi[i][r->axis[k]]);
    f8 inv = r->of.inv[k];
    f8 a = f8_sub(f8_where_lt(inv, zero, hi, lo), r->of.enter[k]);
    f8 b = f8_sub(f8_where_lt(inv, zero, lo, hi), r->of.leave[k]);
    near = f8_max(f8_mul(a, inv), near);
    far = f8_min(f8_mul(b, inv), far);
  }
  return f8_le(near, far);
}

// Ray i and triangle k of a leaf of n, which single precision does not decide.
SIMD bool few_unsure(const few_rays *r, uint32_t i, const uint32_t *leaf,
                     uint32_t n, uint32_t k, bool close, float large) {
  const vec3 p[3] = {leaf_corner(leaf, n, k, 0), leaf_corner(leaf, n, k, 1),
                     leaf_corner(leaf, n, k, 2)};
  ray one = *r->ray[i];
  one.d = ray_flush(one.d);
  if (close && !triangle_ahead(&one, p)) return false;
  wide_walk w = {.sx = r->sx[i], .sy = r->sy[i], .sz = r->sz[i]};
  for (int a = 0; a < 3; a++) {
    w.inv[a] = r->inv[a][i];
    w.enter[a] = r->enter[a][i];
    w.leave[a] = r->leave[a][i];
    w.side[a] = w.inv[a] < 0 ? WIDE : 0;
    w.axis[a] = r->axis[a];
  }
  w.large = large;
  w.r = r->ray[i];
  const float *at = (const float *)(const void *)leaf + k;
  float turned[9];
  for (int c = 0; c < 9; c++)
    turned[c] = at[((uint32_t)c / 3 * 3 + r->axis[c % 3]) * n];
  hit h;
  return leaf_one(&w, &(leaf_triangle){turned, 1}, close, &h);
}

// Corner i of a triangle, for all rays.
SIMD void few_corner(leaf_corners *to, const float *at, uint32_t n,
                     const uint32_t axis[3], int i) {
  to->of[3 * i] = f8_all(at[axis[0] * n]);
  to->of[3 * i + 1] = f8_all(at[axis[1] * n]);
  to->of[3 * i + 2] = f8_all(at[axis[2] * n]);
}

// Those of the rays m that triangle k of a leaf of n stops.
SIMD uint32_t few_stopped(few_rays *r, const uint32_t *leaf, uint32_t n,
                          uint32_t k, uint32_t m) {
  const float *at = (const float *)(const void *)leaf + k;
  leaf_shear c;
  leaf_found f;
  few_corner(&r->of.at, at, n, r->axis, 0);
  few_corner(&r->of.at, at + 3 * n, n, r->axis, 1);
  few_corner(&r->of.at, at + 6 * n, n, r->axis, 2);
  m &= leaf_edges(&c, &r->of.rays, &r->of.at);
  if (m == 0) return 0;
  m &= ~few_apart(&c, r);
  if (m == 0) return 0;
  leaf_distances(&f, &c, &r->of, m);
  uint32_t stopped = f.hits;
  for (m = f.unsure & ~stopped; m != 0; m &= m - 1) {
    uint32_t i = (uint32_t)__builtin_ctz(m);
    bool close = f.close >> i & 1;
    if (few_unsure(r, i, leaf, n, k, close, r->of.large)) stopped |= 1u << i;
  }
  return stopped;
}

#endif
