// light_triangle.h — points of a shining triangle, chosen for the surface that
// they are to light.

#ifndef LIGHT_TRIANGLE_H
#define LIGHT_TRIANGLE_H

#include "vec.h"

// From this many radii on a triangle is far away: over its area the density
// per steradian varies by a few tenths at most.
#define LIGHT_FAR_RADII 10

// Closer to the plane than this many radii is on the plane.
#define LIGHT_LEAST_HEIGHT 1e-4f

// A triangle that shines on the side of n, its normal by the winding.
typedef struct light_triangle {
  vec3 a, ab, ac;  // a corner and the edges to the others
  vec3 n;          // unit
  float area;
  vec3 middle;   // of a sphere around it
  float radius;  // of that sphere
} light_triangle;

// False when it has no area, or more than a float holds.
bool light_triangle_of(light_triangle *out, vec3 a, vec3 b, vec3 c);

// The height of p above the shining side, 0 where p is behind the triangle or
// so close to its plane that scattered rays do better.
float light_triangle_height(const light_triangle *t, vec3 p);

// Weights of the corners b and c, the direction from p, and the density per
// steradian.  Uniform in solid angle from nearby, in area from far away.
typedef struct light_point {
  float b, c;
  vec3 at, wi;
  float pdf;
} light_point;

// False when p does not see the shining side.
bool light_triangle_sample(const light_triangle *t, vec3 p, float u1, float u2,
                           light_point *out);

// The density of that at the point q of the triangle, seen from p.
float light_triangle_pdf(const light_triangle *t, vec3 p, vec3 q);

#endif
