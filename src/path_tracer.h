// path_tracer.h — what a walk that looks for light is given.

#ifndef PATH_TRACER_H
#define PATH_TRACER_H

#include "path_aim.h"
#include "path_log.h"
#include "path_ready.h"
#include "path_share.h"
#include "path_sky.h"
#include "path_world.h"

// All that it points to lives while it is used.
typedef struct path_tracer {
  const path_world *world;
  const light_set *lights;  // of world's scene and lights
  ready_function *ready;    // NULL: one by one
  starts_function *starts;  // NULL: one by one
  const path_sky *sky;      // NULL: one by one
  sampler_kind sampler;
  uint64_t seed;
  path_log *log;          // NULL: none
  uint32_t questions;     // to lights at every vertex; 0: one
  const aim_map *aim;     // NULL: no ray is aimed
  const path_film *film;  // NULL: nothing is shared
  double *gain;           // aim_gain of all aimed rays is added; NULL: not
} path_tracer;

#endif
