// path_naive.h — light along random paths, by BSDF sampling alone.

#ifndef PATH_NAIVE_H
#define PATH_NAIVE_H

#include "path_world.h"
#include "rng.h"

// One sample of the radiance that arrives along -r.d at r.o.  Unbiased for any
// max_depth; with max_depth 0 for the whole transport.  Emitters are found by
// hitting them, point and directional lights by shadow rays.
vec3 path_naive_radiance(const path_world *w, ray r, rng *random,
                         path_stats *stats);

// The same as an integrator of a seed; both live while it is used.
typedef struct path_naive {
  const path_world *world;
  uint64_t seed;
} path_naive;

integrator path_naive_integrator(const path_naive *p);

#endif
