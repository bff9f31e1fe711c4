// aim_learn.h — rays aimed at lamps seen in mirrors and glass, where that pays.

#ifndef AIM_LEARN_H
#define AIM_LEARN_H

#include "path_learn.h"

// A map for by, in mem; NULL where it would not pay.  It is a function of the
// scene, the lesson and the seed, but not of the number of samples.
const aim_map *aim_learn(const path_tracer *by, const path_film *lesson,
                         arena *mem, pool *threads);

#endif
