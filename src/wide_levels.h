// wide_levels.h — one kernel a level.

#ifndef WIDE_LEVELS_H
#define WIDE_LEVELS_H

#include "wide_tree.h"

extern const wide_level wide_level_base, wide_level_avx2, wide_level_avx512;

#endif
