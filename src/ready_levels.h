// ready_levels.h — one kernel a level.

#ifndef READY_LEVELS_H
#define READY_LEVELS_H

#include "path_sky.h"

extern ready_function *const ready_base, *const ready_avx2, *const ready_avx512;
extern starts_function *const starts_base, *const starts_avx2,
                                               *const starts_avx512;
extern const path_sky sky_base, sky_avx2, sky_avx512;

#endif
