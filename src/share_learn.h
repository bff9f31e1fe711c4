// share_learn.h — whether it pays to share what paths find.

#ifndef SHARE_LEARN_H
#define SHARE_LEARN_H

#include "path.h"
#include "pool.h"

// Whether the paths of a film have so much less variance when groups share that
// it is worth its rays; by->film does not matter.  It is a function of the
// scene, the film and the seed, as path_learn is.
bool share_learn(const path_tracer *by, const path_film *film, pool *threads);

#endif
