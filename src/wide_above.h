// wide_above.h — what is above the planes of a leaf's triangles.
//
// Most of what they are asked about is below them by far, and single precision
// can tell.

#ifndef WIDE_ABOVE_H
#define WIDE_ABOVE_H

#include "wide_faces.h"

// Whether v is above face f of triangle k, by more than the roundings of this
// sum.
static inline bool is_above(const leaf_planes *p, uint32_t k, int f, vec3 v) {
  const double *n = p->n[k][f], *at = p->corner[k][f];
  double x = n[0] * ((double)v.x - at[0]), y = n[1] * ((double)v.y - at[1]);
  double z = n[2] * ((double)v.z - at[2]);
  return x + y + z > 0x1p-50 * (fabs(x) + fabs(y) + fabs(z));
}

// Lanes that are above face f of triangle k, or may be.
SIMD uint32_t lanes_reach(const leaf_planes *p, uint32_t k, int f,
                          const f8 v[3]) {
  f8 x = f8_mul(f8_all(p->x[k][f]), v[0]);
  f8 y = f8_mul(f8_all(p->y[k][f]), v[1]);
  f8 sum = f8_add(f8_add(x, y), f8_mul(f8_all(p->z[k][f]), v[2]));
  return ~f8_lt(sum, f8_all(p->d[k][f] - p->unsure)) & 0xff;
}

// The triangles of a leaf of n that have a corner above a face.
static inline uint32_t leaf_above(const leaf_planes *p, uint32_t k, int f,
                                  const uint32_t *leaf, uint32_t n) {
  uint32_t above = 0;
  for (uint32_t i = 0; i < 3; i++) {
    const float *at = (const float *)(const void *)(leaf + 3 * i * n);
    f8 v[3] = {f8_load(at), f8_load(at + n), f8_load(at + 2 * n)};
    uint32_t near = lanes_reach(p, k, f, v) & ((1u << n) - 1) & ~above;
    for (; near != 0; near &= near - 1) {
      uint32_t j = (uint32_t)__builtin_ctz(near);
      above |= (uint32_t)is_above(p, k, f, leaf_corner(leaf, n, j, i)) << j;
    }
  }
  return above;
}

// Triangles of m are not alive if one of a leaf is below none of their planes.
APART void meet_leaf(leaf_planes *p, const wide_tree *t, uint32_t child,
                     uint32_t m) {
  const uint32_t n = wide_leaf_count(child);
  const uint32_t *leaf = t->triangles + 10 * (size_t)wide_leaf_first(child);
  for (m &= p->alive; m != 0; m &= m - 1) {
    uint32_t k = (uint32_t)__builtin_ctz(m), above = (1u << n) - 1;
    for (int f = 0; f < FACES && above != 0; f++)
      above &= leaf_above(p, k, f, leaf, n);
    if (above != 0) p->alive &= ~(1u << k);
  }
}

#endif
