// wide_edges.h — which of up to eight triangles a ray may pass through.

#ifndef WIDE_EDGES_H
#define WIDE_EDGES_H

#include "wide_box.h"

// Eight triangles in shear space, as triangle.c has one, and the edge
// functions.
typedef struct leaf_shear {
  f8 x[3], y[3], z[3];
  f8 e[3];
} leaf_shear;

// One coordinate of a corner of each of the n triangles of a leaf; lanes beyond
// n hold something.
SIMD f8 leaf_load(const uint32_t *leaf, size_t n, size_t corner, size_t axis) {
  return f8_load((const float *)(const void *)(leaf + (3 * corner + axis) * n));
}

// Corner i in shear space; x, y and z are where these coordinates of corner 0
// are, `step` numbers before those of corner 1.
SIMD void leaf_corner(leaf_shear *c, const wide_walk *w, int i, const float *x,
                      const float *y, const float *z, size_t step) {
  size_t at = (size_t)i * step;
  c->z[i] = f8_sub(f8_load(z + at), f8_all(w->o[2]));
  c->x[i] = f8_sub(f8_load(x + at), f8_all(w->o[0]));
  c->y[i] = f8_sub(f8_load(y + at), f8_all(w->o[1]));
  c->x[i] = f8_sub(c->x[i], f8_mul(f8_all(w->shear.sx), c->z[i]));
  c->y[i] = f8_sub(c->y[i], f8_mul(f8_all(w->shear.sy), c->z[i]));
}

// The edge function of corners j and k.
SIMD f8 leaf_edge(const leaf_shear *c, int j, int k) {
  return f8_sub(f8_mul(c->x[k], c->y[j]), f8_mul(c->y[k], c->x[j]));
}

// The triangles of a leaf that the ray may hit: all but those with two edge
// functions of opposite sign, in the very arithmetic of triangle_hit.
SIMD uint32_t leaf_edges(leaf_shear *c, const wide_walk *w,
                         const uint32_t *leaf, size_t n) {
  const float *p = (const float *)(const void *)leaf;
  const float *x = p + w->axis[0] * n, *y = p + w->axis[1] * n;
  const float *z = p + w->axis[2] * n;
  leaf_corner(c, w, 0, x, y, z, 3 * n);
  leaf_corner(c, w, 1, x, y, z, 3 * n);
  leaf_corner(c, w, 2, x, y, z, 3 * n);
  c->e[0] = leaf_edge(c, 1, 2);
  c->e[1] = leaf_edge(c, 2, 0);
  c->e[2] = leaf_edge(c, 0, 1);
  f8 least = f8_min(f8_min(c->e[0], c->e[1]), c->e[2]);
  f8 most = f8_max(f8_max(c->e[0], c->e[1]), c->e[2]);
  uint32_t apart = f8_lt(least, f8_all(0)) & f8_lt(f8_all(0), most);
  return ~apart & ((1u << n) - 1);
}

#endif
