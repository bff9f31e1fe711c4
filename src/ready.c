// ready.c — which kernel.

#include "ready.h"

#include "ready_levels.h"
#include "wide.h"

ready_function *ready_by(int level) {
  ready_function *all[WIDE_LEVELS] = {ready_base, ready_avx2, ready_avx512};
  return wide_level_at(level) != NULL ? all[level] : NULL;
}

ready_function *ready_best(void) {
  int level = WIDE_LEVELS - 1;
  while (ready_by(level) == NULL)
    level--;
  return ready_by(level);
}
