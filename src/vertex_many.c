// vertex_many.c — which kernel.

#include "vertex_many.h"

#include "vertex_many_levels.h"
#include "wide.h"

vertices_function *vertex_many_by(int level) {
  vertices_function *all[WIDE_LEVELS] = {vertex_many_base, vertex_many_avx2,
                                         vertex_many_avx512};
  return wide_level_at(level) != NULL ? all[level] : NULL;
}

vertices_function *vertex_many_best(void) {
  int level = WIDE_LEVELS - 1;
  while (vertex_many_by(level) == NULL)
    level--;
  return vertex_many_by(level);
}
