// triangle.h — where a ray meets a triangle, without leaks.
//
// Source: Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection".  No
// fused multiply-add anywhere here: contraction breaks the symmetry that makes
// shared edges watertight.

#ifndef TRIANGLE_H
#define TRIANGLE_H

#include "ray.h"

// The shear that turns a ray's direction into +z: the axis kz along which it
// runs fastest, and the factors for the other two (cyclically after kz) and for
// kz itself.  One per ray.
typedef struct ray_shear {
  int kz;
  float sx, sy, sz;
} ray_shear;

ray_shear ray_shear_of(vec3 d);

// Whether r meets the triangle p0 p1 p2, from either side, at tmin <= t <=
// tmax of r; then t, b1, b2 of *h are set and its triangle left alone.  Of two
// triangles that share an edge, in any order of corners, at least one is hit
// by every ray that passes through the edge.  A ray that starts in the plane of
// a triangle, within double precision, does not hit it: with tmin 0 it never
// meets the triangle it starts on.  Triangles without area, and rays and
// corners that are not finite, give no hit.
bool triangle_hit(const ray *r, const ray_shear *s, vec3 p0, vec3 p1, vec3 p2,
                  hit *h);

// Whether the plane of a triangle lies ahead of where r starts.  If not, and if
// t of triangle_hit has an error bound that does not tell it from 0, r misses
// the triangle.
bool triangle_ahead(const ray *r, const vec3 p[3]);

// The weights of the three corners where a ray that triangle_hit let through
// meets the triangle, each within 2^-51 of itself; false for a ray that misses.
bool triangle_weights(const ray *r, const ray_shear *s, const vec3 p[3],
                      double w[3]);

#endif
