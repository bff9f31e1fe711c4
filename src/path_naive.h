// path_naive.h — light along random paths, by BSDF sampling alone.

#ifndef PATH_NAIVE_H
#define PATH_NAIVE_H

#include "matter.h"
#include "rng.h"

// What a path walks through.
typedef struct path_world {
  const scene *scene;
  tracer tracer;
  bool lights;     // point and directional lights on
  int max_depth;   // segments: 1 emission seen, 2 direct light; 0 roulette only
  const dfg *dfg;  // matter_table of the scene
} path_world;

// What one path did.
typedef struct path_stats {
  uint64_t rays;  // closest and any
  uint64_t cut;   // paths ended by the limit on their length: lost light
} path_stats;

// One sample of the radiance that arrives along -r.d at r.o.  Unbiased for any
// max_depth; with max_depth 0 for the whole transport.  Emitters are found by
// hitting them, point and directional lights by shadow rays.
vec3 path_naive_radiance(const path_world *w, ray r, rng *random,
                         path_stats *stats);

#endif
