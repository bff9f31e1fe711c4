// wide_leaf.h — a ray and up to eight triangles.
//
// Which triangle is hit where is decided by triangle_hit and slab_hold; what is
// here only keeps from them those that they would refuse.

#ifndef WIDE_LEAF_H
#define WIDE_LEAF_H

#include "wide_box.h"

// A coordinate of eight corners, before the shear.
SIMD f8 corners_at(const uint32_t *leaf, uint32_t n, int corner, int axis,
                   float o) {
  const uint32_t *p = leaf + (uint32_t)(3 * corner + axis) * n;
  return f8_sub(f8_load((const float *)(const void *)p), f8_all(o));
}

// The triangles of a leaf that the ray may hit: all but those with two edge
// functions of opposite sign, in the very arithmetic of triangle_hit.
SIMD uint32_t leaf_candidates(const wide_walk *w, const uint32_t *leaf,
                              uint32_t n) {
  static const int turned[3][3] = {{1, 2, 0}, {2, 0, 1}, {0, 1, 2}};
  const int *axis = turned[w->shear.kz];
  const float o[3] = {w->r.o.x, w->r.o.y, w->r.o.z};
  f8 sx = f8_all(w->shear.sx), sy = f8_all(w->shear.sy), x[3], y[3];
  for (int i = 0; i < 3; i++) {
    f8 z = corners_at(leaf, n, i, axis[2], o[axis[2]]);
    x[i] = f8_sub(corners_at(leaf, n, i, axis[0], o[axis[0]]), f8_mul(sx, z));
    y[i] = f8_sub(corners_at(leaf, n, i, axis[1], o[axis[1]]), f8_mul(sy, z));
  }
  f8 u = f8_sub(f8_mul(x[2], y[1]), f8_mul(y[2], x[1]));
  f8 v = f8_sub(f8_mul(x[0], y[2]), f8_mul(y[0], x[2]));
  f8 s = f8_sub(f8_mul(x[1], y[0]), f8_mul(y[1], x[0]));
  f8 zero = f8_all(0);
  uint32_t less = f8_lt(u, zero) | f8_lt(v, zero) | f8_lt(s, zero);
  uint32_t more = f8_lt(zero, u) | f8_lt(zero, v) | f8_lt(zero, s);
  return ~(less & more) & ((1u << n) - 1);
}

static vec3 corner_of(const uint32_t *leaf, uint32_t n, uint32_t i) {
  vec3 p;
  memcpy(&p.x, leaf + i, sizeof(float));
  memcpy(&p.y, leaf + n + i, sizeof(float));
  memcpy(&p.z, leaf + 2 * (size_t)n + i, sizeof(float));
  return p;
}

// Test the triangles of a leaf and keep the best hit: the smallest t, of equal
// t the lowest triangle.  With `any`, stop at the first.
SIMD bool walk_leaf(wide_walk *w, const wide_tree *t, uint32_t child,
                    bool any) {
  uint32_t n = wide_leaf_count(child);
  const uint32_t *leaf = t->triangles + 10 * (size_t)wide_leaf_first(child);
  bool found = false;
  for (uint32_t m = leaf_candidates(w, leaf, n); m != 0; m &= m - 1) {
    uint32_t i = (uint32_t)__builtin_ctz(m);
    vec3 p[3];
    for (uint32_t k = 0; k < 3; k++)
      p[k] = corner_of(leaf + 3 * (size_t)k * n, n, i);
    hit h = {.triangle = leaf[9 * n + i]};
    if (!triangle_hit(&w->r, &w->shear, p[0], p[1], p[2], &h) ||
        !slab_hold(&w->slab, &w->r, p, &h))
      continue;
    if (any) return true;
    if (h.t > w->best.t || (h.t == w->best.t && h.triangle > w->best.triangle))
      continue;
    w->best = h;
    found = true;
  }
  return found;
}

#endif
