// path_learn.h — paths walked to learn which lights are seen from where.

#ifndef PATH_LEARN_H
#define PATH_LEARN_H

#include "path.h"
#include "pool.h"

// The film that the paths start from, and how many there are.
typedef struct path_lesson {
  const camera_view *view;
  int width, height;
  size_t paths;
} path_lesson;

// Give lights, which by->lights must be, a memory; in mem.  It is a function
// of the scene, the lesson and the seed.  False, and nothing done, where the
// lights cannot be remembered.
bool path_learn(light_set *lights, const path_tracer *by,
                const path_lesson *lesson, arena *mem, pool *threads);

#endif
