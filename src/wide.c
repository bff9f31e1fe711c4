// wide.c — which kernel.

#include "wide.h"

#include "simd_runs.h"
#include "wide_levels.h"

const wide_level *wide_level_at(int level) {
  const wide_level *all[WIDE_LEVELS] = {&wide_level_base, &wide_level_avx2,
                                        &wide_level_avx512};
  if (all[level]->closest == NULL || !simd_runs(level)) return NULL;
  return all[level];
}

tracer wide_tracer_at(const wide_tree *t, const wide_level *level) {
  return (tracer){t, level->closest, level->any, level->closest_many,
                  level->any_many};
}

const wide_level *wide_level_best(void) {
  int level = WIDE_LEVELS - 1;
  while (wide_level_at(level) == NULL)
    level--;
  return wide_level_at(level);
}

tracer wide_tracer(const wide_tree *t) {
  return wide_tracer_at(t, wide_level_best());
}
