// wide_planes.h — the planes of a leaf's triangles, and what is above them.
//
// Most of what they are asked about is below them by far, and single precision
// can tell.

#ifndef WIDE_PLANES_H
#define WIDE_PLANES_H

#include "simd.h"
#include "wide_tree.h"

#include <float.h>

// What a leaf looks through: at most WIDE - 1 children wait of each level.
enum { PATCH_WAITING = (WIDE - 1) * 64 + WIDE };

// The planes of a leaf's triangles: unit normals n by the winding, a corner,
// and in single precision n . x = d.
typedef struct leaf_planes {
  float x[WIDE], y[WIDE], z[WIDE], d[WIDE];
  double n[WIDE][3], corner[WIDE][3];
  float unsure;    // by so much single precision may be wrong
  uint32_t alive;  // bit k: nothing has been found above plane k so far
  uint32_t looks;
  uint32_t waiting;  // children to look at, and the planes that they reach
  uint32_t child[PATCH_WAITING];
  uint8_t reached[PATCH_WAITING];
} leaf_planes;

// Corner i of triangle k of a leaf of n.
SIMD vec3 leaf_corner(const uint32_t *leaf, uint32_t n, uint32_t k,
                      uint32_t i) {
  vec3 p;
  memcpy(&p.x, &leaf[(3 * i + 0) * n + k], sizeof(float));
  memcpy(&p.y, &leaf[(3 * i + 1) * n + k], sizeof(float));
  memcpy(&p.z, &leaf[(3 * i + 2) * n + k], sizeof(float));
  return p;
}

SIMD void difference(double out[3], vec3 a, vec3 b) {
  out[0] = (double)a.x - (double)b.x;
  out[1] = (double)a.y - (double)b.y;
  out[2] = (double)a.z - (double)b.z;
}

SIMD void set_plane(leaf_planes *p, uint32_t k, vec3 c0, vec3 c1, vec3 c2) {
  double a[3], b[3], *n = p->n[k], *at = p->corner[k];
  difference(a, c1, c0);
  difference(b, c2, c0);
  difference(at, c0, (vec3){0, 0, 0});
  n[0] = a[1] * b[2] - a[2] * b[1];
  n[1] = a[2] * b[0] - a[0] * b[2];
  n[2] = a[0] * b[1] - a[1] * b[0];
  double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  if (length > 0 && length <= DBL_MAX) p->alive |= 1u << k;
  for (int i = 0; i < 3; i++)
    n[i] /= length;
  p->x[k] = (float)n[0];
  p->y[k] = (float)n[1];
  p->z[k] = (float)n[2];
  p->d[k] = (float)(n[0] * at[0] + n[1] * at[1] + n[2] * at[2]);
}

// Whether v is above plane k, by more than the roundings of this sum.
SIMD bool is_above(const leaf_planes *p, uint32_t k, vec3 v) {
  const double *n = p->n[k], *at = p->corner[k];
  double x = n[0] * ((double)v.x - at[0]), y = n[1] * ((double)v.y - at[1]);
  double z = n[2] * ((double)v.z - at[2]);
  return x + y + z > 0x1p-50 * (fabs(x) + fabs(y) + fabs(z));
}

// Lanes that are above plane k, or may be.
SIMD uint32_t lanes_reach(const leaf_planes *p, uint32_t k, const f8 v[3]) {
  f8 x = f8_mul(f8_all(p->x[k]), v[0]), y = f8_mul(f8_all(p->y[k]), v[1]);
  f8 sum = f8_add(f8_add(x, y), f8_mul(f8_all(p->z[k]), v[2]));
  return ~f8_lt(sum, f8_all(p->d[k] - p->unsure)) & 0xff;
}

// Planes of m that a corner of a leaf is above are not alive.
SIMD void meet_leaf(leaf_planes *p, const wide_tree *t, uint32_t child,
                    uint32_t m) {
  const uint32_t n = wide_leaf_count(child);
  const uint32_t *leaf = t->triangles + 10 * (size_t)wide_leaf_first(child);
  for (m &= p->alive; m != 0; m &= m - 1) {
    uint32_t k = (uint32_t)__builtin_ctz(m);
    for (uint32_t i = 0; i < 3; i++) {
      const float *at = (const float *)(const void *)(leaf + 3 * i * n);
      f8 v[3] = {f8_load(at), f8_load(at + n), f8_load(at + 2 * n)};
      uint32_t near = lanes_reach(p, k, v) & ((1u << n) - 1);
      for (; near != 0; near &= near - 1) {
        uint32_t j = (uint32_t)__builtin_ctz(near);
        if (is_above(p, k, leaf_corner(leaf, n, j, i))) p->alive &= ~(1u << k);
      }
    }
  }
}

#endif
