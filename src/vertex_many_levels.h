// vertex_many_levels.h — one kernel a level.

#ifndef VERTEX_MANY_LEVELS_H
#define VERTEX_MANY_LEVELS_H

#include "vertex.h"

extern vertices_function *const vertex_many_base, *const vertex_many_avx2,
                                                      *const vertex_many_avx512;

#endif
