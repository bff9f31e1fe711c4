// ibl_level.h — one prepared sum as a function on the sphere: stored as a cubic
// spline, so that few nodes do.

#ifndef IBL_LEVEL_H
#define IBL_LEVEL_H

#include "pool.h"
#include "vec.h"

// One sum as a function on the sphere.  texels are coefficients of a cubic
// B-spline on nodes at u = i / width and v = j / (height - 1), so that first
// and last row are the poles; a row more lies before the first and after the
// last: (height + 2) * width texels.
typedef struct ibl_level {
  float roughness;  // below 0: irradiance
  int width, height;
  vec3 *texels;
} ibl_level;

// A level of the size that the roughness asks for, without texels.
ibl_level ibl_level_of(float roughness);
size_t ibl_level_texels(const ibl_level *l);
void ibl_level_allocate(ibl_level *l, arena *mem);

// Turn values at the nodes, in all rows but the first and the last, into the
// coefficients of the spline through them.
void ibl_level_to_spline(ibl_level *l, pool *threads);

// The value at (u, v), u of any size; never negative.  ibl.glsl has its twin.
vec3 ibl_level_at(const ibl_level *l, float u, float v);

#endif
