// polygon.h — a polygon in space cut into triangles.

#ifndef POLYGON_H
#define POLYGON_H

#include "arena.h"
#include "vec.h"

#include <stdint.h>

// Twice the signed area as a vector (Newell): along the normal of a planar
// polygon, counter-clockwise seen from its tip.
void polygon_newell(const vec3 *p, size_t n, double out[3]);

// Cut the polygon of n >= 3 corners into n - 2 triangles, written as 3 (n - 2)
// corner numbers 0..n-1.  A convex polygon gives the fan from corner 0; a
// concave one is clipped ear by ear on its Newell plane, which preserves its
// area when it is planar and does not cross itself.  Always n - 2 triangles,
// whatever the input.  scratch is freed by the caller.  Returns false when the
// triangles do not cover what the outline encloses: it crosses itself or has no
// area.  A quad is never blamed: a bent one may seem to cross itself, and there
// are only two ways to cut it.
bool polygon_triangulate(const vec3 *p, size_t n, uint32_t *out,
                         arena *scratch);

#endif
