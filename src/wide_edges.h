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

// The corners of eight triangles, axes turned by the shear: of[3 i + k] is
// coordinate k of corner i.
typedef struct leaf_corners {
  f8 of[9];
} leaf_corners;

// Those of a leaf of n; lanes beyond n hold whatever comes next in memory.
SIMD void corners_load(leaf_corners *c, const uint32_t *leaf, size_t n,
                       const uint32_t axis[3]) {
  const float *p = (const float *)(const void *)leaf;
  const float *x = p + axis[0] * n, *y = p + axis[1] * n, *z = p + axis[2] * n;
  size_t to = 3 * n;
  c->of[0] = f8_load(x);
  c->of[1] = f8_load(y);
  c->of[2] = f8_load(z);
  c->of[3] = f8_load(x + to);
  c->of[4] = f8_load(y + to);
  c->of[5] = f8_load(z + to);
  to += to;
  c->of[6] = f8_load(x + to);
  c->of[7] = f8_load(y + to);
  c->of[8] = f8_load(z + to);
}

// The origins and the slopes of eight rays, axes turned by the shear.
typedef struct leaf_rays {
  f8 o[3], sx, sy;
} leaf_rays;

// One ray eight times.
SIMD leaf_rays walk_rays(const wide_walk *w) {
  return (leaf_rays){{f8_all(w->o[0]), f8_all(w->o[1]), f8_all(w->o[2])},
                     f8_all(w->sx),
                     f8_all(w->sy)};
}

// A corner in shear space.
SIMD void shear_corner(leaf_shear *c, const leaf_rays *r, int i,
                       const f8 at[3]) {
  c->z[i] = f8_sub(at[2], r->o[2]);
  c->x[i] = f8_sub(at[0], r->o[0]);
  c->y[i] = f8_sub(at[1], r->o[1]);
  c->x[i] = f8_sub(c->x[i], f8_mul(r->sx, c->z[i]));
  c->y[i] = f8_sub(c->y[i], f8_mul(r->sy, c->z[i]));
}

// The edge function of corners j and k.
SIMD f8 edge_of(const leaf_shear *c, int j, int k) {
  return f8_sub(f8_mul(c->x[k], c->y[j]), f8_mul(c->y[k], c->x[j]));
}

// Rays and triangles in shear space; the lanes that may be hits: all but those
// with two edge functions of opposite sign, in the very arithmetic of
// triangle_hit.
SIMD uint32_t leaf_edges(leaf_shear *c, const leaf_rays *r,
                         const leaf_corners *at) {
  shear_corner(c, r, 0, at->of);
  shear_corner(c, r, 1, at->of + 3);
  shear_corner(c, r, 2, at->of + 6);
  c->e[0] = edge_of(c, 1, 2);
  c->e[1] = edge_of(c, 2, 0);
  c->e[2] = edge_of(c, 0, 1);
  f8 least = f8_min(f8_min(c->e[0], c->e[1]), c->e[2]);
  f8 most = f8_max(f8_max(c->e[0], c->e[1]), c->e[2]);
  return ~(f8_lt(least, f8_all(0)) & f8_lt(f8_all(0), most));
}

#endif
