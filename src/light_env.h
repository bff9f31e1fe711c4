// light_env.h — directions towards the bright parts of an environment.

#ifndef LIGHT_ENV_H
#define LIGHT_ENV_H

#include "env.h"
#include "pick.h"
#include "pool.h"

// A table over the cells between the texels of a map, in each of which what a
// lookup returns is bilinear.  It holds what is brighter than the mean of the
// map: the even rest is found best by scattered rays.  So a constant
// environment has no table.  Source: Karlik et al. 2019, "MIS Compensation".
typedef struct light_env {
  const env *env;
  int width, height;  // texels of the map, or of the built-in sky as one
  float *values;      // by texel: what is above the mean, 1 at most, times the
                      // sine of its angle to +Y
  pick rows;      // of cells: height + 1, the first and the last half as high
  pick *columns;  // width cells of each row
  float irradiance;  // what the table stands for, on a plane, roughly; 0: none
} light_env;

void light_env_build(light_env *out, const env *e, arena *mem, pool *threads);

// A direction by two uniform numbers and its density per steradian; false when
// there is none.
bool light_env_sample(const light_env *l, float u1, float u2, vec3 *wi,
                      float *pdf);

// The density of light_env_sample at unit wi.
float light_env_pdf(const light_env *l, vec3 wi);

#endif
