// ready.c — which kernel.

#include "ready.h"

#include "ready_levels.h"
#include "wide.h"

ready_function *ready_by(int level) {
  ready_function *all[WIDE_LEVELS] = {ready_base, ready_avx2, ready_avx512};
  return wide_level_at(level) != NULL ? all[level] : NULL;
}

starts_function *ready_starts_by(int level) {
  starts_function *all[WIDE_LEVELS] = {starts_base, starts_avx2, starts_avx512};
  return wide_level_at(level) != NULL ? all[level] : NULL;
}

const path_sky *ready_sky_by(int level) {
  const path_sky *all[WIDE_LEVELS] = {&sky_base, &sky_avx2, &sky_avx512};
  return wide_level_at(level) != NULL ? all[level] : NULL;
}

static int best_level(void) {
  int level = WIDE_LEVELS - 1;
  while (ready_by(level) == NULL)
    level--;
  return level;
}

ready_function *ready_best(void) {
  return ready_by(best_level());
}

starts_function *ready_starts_best(void) {
  return ready_starts_by(best_level());
}

const path_sky *ready_sky_best(void) {
  return ready_sky_by(best_level());
}
