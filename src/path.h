// path.h — light along random paths that look for it: at every vertex a light
// is sampled as well as a direction, and both are weighted.

#ifndef PATH_H
#define PATH_H

#include "path_tracer.h"

// Unbiased for any max_depth: its mean is that of path_naive.
integrator path_integrator(const path_tracer *p);

#endif
