// ibl_source.h — an environment made ready for sums: texels of known weight,
// and apart from them those so bright that each is a light of its own.

#ifndef IBL_SOURCE_H
#define IBL_SOURCE_H

#include "env.h"
#include "pool.h"

// Light from one direction: radiance times solid angle.
typedef struct ibl_sun {
  vec3 direction, power;
} ibl_sun;

// A texel that gives more than this share of all light becomes a sun; so there
// are at most 63 of them.
#define IBL_SUN_SHARE (1.0 / 64)

// Before rotation and scale of the environment.
typedef struct ibl_source {
  image map;  // width a power of two up to 1024, height 256 to 512
  ibl_sun *suns;
  int sun_count;
} ibl_source;

// A texel's light comes from its middle; a larger map is averaged down by solid
// angle, a smaller one or the built-in sky is read at 512 x 256 places.
void ibl_source_make(ibl_source *out, const env *e, arena *mem, pool *threads);

// The solid angle of a texel in row y.
float ibl_source_solid_angle(const image *map, int y);

#endif
