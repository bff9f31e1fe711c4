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

// Coordinate `axis` of a corner of each of the n triangles of a leaf; lanes
// beyond n hold something.
SIMD f8 leaf_load(const uint32_t *leaf, uint32_t n, uint32_t corner,
                  uint32_t axis) {
  return f8_load((const float *)(const void *)(leaf + (3 * corner + axis) * n));
}

// The triangles of a leaf that the ray may hit: all but those with two edge
// functions of opposite sign, in the very arithmetic of triangle_hit.
SIMD uint32_t leaf_edges(leaf_shear *c, const wide_walk *w,
                         const uint32_t *leaf, uint32_t n) {
  f8 ox = f8_all(w->o[0]), oy = f8_all(w->o[1]), oz = f8_all(w->o[2]);
  f8 sx = f8_all(w->shear.sx), sy = f8_all(w->shear.sy);
  for (uint32_t i = 0; i < 3; i++) {
    f8 z = f8_sub(leaf_load(leaf, n, i, w->axis[2]), oz);
    f8 x = f8_sub(leaf_load(leaf, n, i, w->axis[0]), ox);
    f8 y = f8_sub(leaf_load(leaf, n, i, w->axis[1]), oy);
    c->x[i] = f8_sub(x, f8_mul(sx, z));
    c->y[i] = f8_sub(y, f8_mul(sy, z));
    c->z[i] = z;
  }
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    c->e[i] = f8_sub(f8_mul(c->x[k], c->y[j]), f8_mul(c->y[k], c->x[j]));
  }
  f8 least = f8_min(f8_min(c->e[0], c->e[1]), c->e[2]);
  f8 most = f8_max(f8_max(c->e[0], c->e[1]), c->e[2]);
  uint32_t apart = f8_lt(least, f8_all(0)) & f8_lt(f8_all(0), most);
  return ~apart & ((1u << n) - 1);
}

#endif
