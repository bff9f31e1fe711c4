// path_learn.h — paths walked to learn which lights are seen from where.

#ifndef PATH_LEARN_H
#define PATH_LEARN_H

#include "path.h"
#include "pool.h"

// Where path i of so many starts: they are spread evenly over the pixels, in
// order.
path_start path_learn_start(const path_film *l, const integrator *by,
                            uint64_t i, uint64_t paths);

// Give lights, which by->lights must be, a memory, in mem, if that pays.  It is
// a function of the scene, the lesson and the seed, but not of the number of
// samples: whoever takes more of them, or a share, knows the same.
bool path_learn(light_set *lights, const path_tracer *by,
                const path_film *lesson, arena *mem, pool *threads);

#endif
