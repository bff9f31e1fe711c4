// wide_faces.h — planes that rays which climb away from a triangle stay above.

#ifndef WIDE_FACES_H
#define WIDE_FACES_H

#include "simd.h"
#include "wide_tree.h"

#include <float.h>

// What a leaf looks through: at most WIDE - 1 children wait of each level.
enum { PATCH_WAITING = (WIDE - 1) * 64 + WIDE };

// How much the planes through edges are tilted, as a tangent.
#define PATCH_SLOPE RAY_CLIMB

// The planes of a leaf's triangles, FACES a triangle: its own, with the unit
// normal by the winding, and those through its edges, tilted up outwards.  n is
// the normal, corner a point, and in single precision n . x = d.
enum { FACES = 4 };
typedef struct leaf_planes {
  float x[WIDE][FACES], y[WIDE][FACES], z[WIDE][FACES], d[WIDE][FACES];
  double n[WIDE][FACES][3], corner[WIDE][FACES][3];
  float unsure;    // by so much single precision may be wrong
  uint32_t alive;  // bit k: all so far is below a plane of triangle k
  uint32_t looks;
  uint32_t waiting;  // children to look at, and whose planes they reach
  uint32_t child[PATCH_WAITING];
  uint8_t reached[PATCH_WAITING];
} leaf_planes;

// Corner i of triangle k of a leaf of n.
static inline vec3 leaf_corner(const uint32_t *leaf, uint32_t n, uint32_t k,
                               uint32_t i) {
  vec3 p;
  memcpy(&p.x, &leaf[(3 * i + 0) * n + k], sizeof(float));
  memcpy(&p.y, &leaf[(3 * i + 1) * n + k], sizeof(float));
  memcpy(&p.z, &leaf[(3 * i + 2) * n + k], sizeof(float));
  return p;
}

static inline void difference(double out[3], vec3 a, vec3 b) {
  out[0] = (double)a.x - (double)b.x;
  out[1] = (double)a.y - (double)b.y;
  out[2] = (double)a.z - (double)b.z;
}

// a x b, of unit length where that is possible; false where not.
static inline bool unit_cross(double out[3], const double a[3],
                              const double b[3]) {
  double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2];
  double z = a[0] * b[1] - a[1] * b[0], length = sqrt(x * x + y * y + z * z);
  out[0] = x / length;
  out[1] = y / length;
  out[2] = z / length;
  return length > 0 && length <= DBL_MAX;
}

// Face f of triangle k, through a corner: f 0 has normal n, others are tilted
// towards unit w.
static inline void set_face(leaf_planes *p, uint32_t k, int f, vec3 at,
                            const double n[3], const double w[3]) {
  double *to = p->n[k][f], *corner = p->corner[k][f];
  difference(corner, at, (vec3){0, 0, 0});
  for (int i = 0; i < 3; i++)
    to[i] = n[i] - (f > 0 ? (double)PATCH_SLOPE * w[i] : 0);
  p->x[k][f] = (float)to[0];
  p->y[k][f] = (float)to[1];
  p->z[k][f] = (float)to[2];
  p->d[k][f] =
      (float)(to[0] * corner[0] + to[1] * corner[1] + to[2] * corner[2]);
}

APART void set_planes(leaf_planes *p, uint32_t k, const vec3 c[3]) {
  double a[3], b[3], n[3], w[3];
  difference(a, c[1], c[0]);
  difference(b, c[2], c[0]);
  bool flat = unit_cross(n, a, b);
  set_face(p, k, 0, c[0], n, n);
  for (int e = 0; e < 3; e++) {
    difference(a, c[(e + 1) % 3], c[e]);
    flat &= unit_cross(w, a, n);
    set_face(p, k, e + 1, c[e], n, w);
  }
  p->alive |= (uint32_t)flat << k;
}

#endif
