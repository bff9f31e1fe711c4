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

// The origins and the slopes of eight rays, axes turned by the shear.
typedef struct leaf_rays {
  f8 o[3], sx, sy;
} leaf_rays;

// A corner in shear space, of coordinates x, y and z.
SIMD void leaf_corner(leaf_shear *c, const leaf_rays *r, int i, f8 x, f8 y,
                      f8 z) {
  c->z[i] = f8_sub(z, r->o[2]);
  c->x[i] = f8_sub(x, r->o[0]);
  c->y[i] = f8_sub(y, r->o[1]);
  c->x[i] = f8_sub(c->x[i], f8_mul(r->sx, c->z[i]));
  c->y[i] = f8_sub(c->y[i], f8_mul(r->sy, c->z[i]));
}

// The edge function of corners j and k.
SIMD f8 leaf_edge(const leaf_shear *c, int j, int k) {
  return f8_sub(f8_mul(c->x[k], c->y[j]), f8_mul(c->y[k], c->x[j]));
}

// The tests that may be hits: all but those with two edge functions of
// opposite sign, in the very arithmetic of triangle_hit.
SIMD uint32_t leaf_inside(leaf_shear *c) {
  c->e[0] = leaf_edge(c, 1, 2);
  c->e[1] = leaf_edge(c, 2, 0);
  c->e[2] = leaf_edge(c, 0, 1);
  f8 least = f8_min(f8_min(c->e[0], c->e[1]), c->e[2]);
  f8 most = f8_max(f8_max(c->e[0], c->e[1]), c->e[2]);
  return ~(f8_lt(least, f8_all(0)) & f8_lt(f8_all(0), most));
}

// The triangles of a leaf that rays may hit, one ray with each, or one with
// all.
SIMD uint32_t leaf_edges(leaf_shear *c, const leaf_rays *r,
                         const uint32_t axis[3], const uint32_t *leaf,
                         size_t n) {
  const float *p = (const float *)(const void *)leaf;
  const float *x = p + axis[0] * n, *y = p + axis[1] * n, *z = p + axis[2] * n;
  size_t to = 3 * n;
  leaf_corner(c, r, 0, f8_load(x), f8_load(y), f8_load(z));
  leaf_corner(c, r, 1, f8_load(x + to), f8_load(y + to), f8_load(z + to));
  to += to;
  leaf_corner(c, r, 2, f8_load(x + to), f8_load(y + to), f8_load(z + to));
  return leaf_inside(c) & ((1u << n) - 1);
}

// One ray eight times.
SIMD leaf_rays walk_rays(const wide_walk *w) {
  return (leaf_rays){{f8_all(w->o[0]), f8_all(w->o[1]), f8_all(w->o[2])},
                     f8_all(w->shear.sx),
                     f8_all(w->shear.sy)};
}

#endif
