// path_sky.h — what paths ask of an environment, many at once.

#ifndef PATH_SKY_H
#define PATH_SKY_H

#include "path_ready.h"

// An environment that is turned about more often is asked one by one.
#define SKY_MOST_TURNS 1024

// Rays that have met nothing, LIGHT_TOGETHER at most: their directions, of any
// length; the surface points and normals where these were sampled, and whether
// a light sample could have found them there.  Then what is seen: the radiance,
// and the density of that light sample, 0 where there is none.
typedef struct sky_looks {
  vec3 d[LIGHT_TOGETHER], from[LIGHT_TOGETHER], from_n[LIGHT_TOGETHER];
  bool rival[LIGHT_TOGETHER];
  vec3 radiance[LIGHT_TOGETHER];
  float pdf[LIGHT_TOGETHER];
} sky_looks;

// env_radiance of the scene and light_pdf_env, of n looks.
typedef void sky_look_function(const light_set *l, sky_looks *q, size_t n);

// light_sample_at for those of n vertices, LIGHT_TOGETHER at most, that are
// matt: they become lit.  Some of l is an environment.
typedef void sky_ask_function(const light_set *l, path_ready *r, size_t n);

typedef struct path_sky {
  sky_look_function *look;
  sky_ask_function *ask;
} path_sky;

#endif
