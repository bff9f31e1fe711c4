// ibl.h — light from the environment, summed beforehand: irradiance for matt
// surfaces, and radiance blurred by the lobe of a roughness for glossy ones.

#ifndef IBL_H
#define IBL_H

#include "env.h"
#include "ibl_level.h"
#include "microfacet.h"

// The most levels, and the least roughness that has one of its own: below it
// the lobe is narrower than a texel of a 1k map.
enum { IBL_MAX_LEVELS = 16 };
#define IBL_LEAST_ROUGHNESS 0.1f

// What to prepare.  Without a list of roughness values (count 0) `all` asks
// for the standard levels; more values than IBL_MAX_LEVELS do, too.
typedef struct ibl_need {
  pbr_model model;
  bool diffuse, all;
  const float *roughness;
  int count;
  bool use_cache;  // files under XDG_CACHE_HOME, else ~/.cache
} ibl_need;

typedef struct ibl {
  const env *env;  // as given: roughness 0 reads it
  pbr_model model;
  ibl_level irradiance;             // no texels where it was not needed
  ibl_level level[IBL_MAX_LEVELS];  // by increasing roughness
  int level_count;
  bool from_cache;
  double seconds;
} ibl;

// Prepare what is needed.  e must stay as it is while *out is used.  A cache
// that cannot be read or written is done without.
void ibl_make(ibl *out, const env *e, const ibl_need *need, arena *mem,
              pool *threads);

// Bytes of the sums.
size_t ibl_bytes(const ibl *b);

// How many levels of roughness that makes.
int ibl_levels_of(const ibl_need *need);

// Irradiance on a surface of unit normal n, true irradiance: 1 all around
// gives pi.  Never negative.
vec3 ibl_irradiance(const ibl *b, vec3 n);

// Mean radiance about the unit direction d under the lobe of that roughness
// seen head-on.  Exact at roughness 0 and at the prepared levels, linear
// between levels; below the first, from the environment itself to the level by
// the fourth power, as the width of the lobe goes.
vec3 ibl_radiance(const ibl *b, vec3 d, float roughness);

#endif
