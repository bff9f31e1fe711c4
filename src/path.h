// path.h — light along random paths that look for it: at every vertex a light
// is sampled as well as a direction, and both are weighted.

#ifndef PATH_H
#define PATH_H

#include "path_aim.h"
#include "path_log.h"
#include "path_ready.h"
#include "path_world.h"

// Unbiased for any max_depth, as path_naive is, of the same transport.  All
// that it points to lives while it is used.
typedef struct path_tracer {
  const path_world *world;
  const light_set *lights;  // of world's scene and lights
  ready_function *ready;    // NULL: one by one
  starts_function *starts;  // NULL: one by one
  sampler_kind sampler;
  uint64_t seed;
  path_log *log;       // NULL: none
  uint32_t questions;  // to lights at every vertex; 0: one
  const aim_map *aim;  // NULL: no ray is aimed
  double *gain;        // of these, by aim_gain, is added; NULL: not
} path_tracer;

integrator path_integrator(const path_tracer *p);

#endif
