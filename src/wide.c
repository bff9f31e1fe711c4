// wide.c — which kernel.

#include "wide.h"

#include "wide_levels.h"

// Whether this processor, and the system on it, have what a level needs.
static bool level_runs(int level) {
#if defined(__x86_64__)
  __builtin_cpu_init();
  bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
              __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  if (level == 1) return avx2;
  if (level == 2)
    return avx2 && __builtin_cpu_supports("avx512f") &&
           __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512bw");
#endif
  return level == 0;
}

const wide_level *wide_level_at(int level) {
  const wide_level *all[WIDE_LEVELS] = {&wide_level_base, &wide_level_avx2,
                                        &wide_level_avx512};
  if (all[level]->closest == NULL || !level_runs(level)) return NULL;
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
