// path_learn.h — paths walked to learn which lights are seen from where.

#ifndef PATH_LEARN_H
#define PATH_LEARN_H

#include "path.h"
#include "pool.h"

// The film that the paths start from.
typedef struct path_lesson {
  const camera_view *view;
  int width, height;
} path_lesson;

// Where path i of so many starts: they are spread evenly over the pixels, in
// order.
path_start path_lesson_start(const path_lesson *l, const integrator *by,
                             uint64_t i, uint64_t paths);

// Give lights, which by->lights must be, a memory, in mem, if that pays.  It is
// a function of the scene, the lesson and the seed, but not of the number of
// samples: whoever takes more of them, or a share, knows the same.
bool path_learn(light_set *lights, const path_tracer *by,
                const path_lesson *lesson, arena *mem, pool *threads);

#endif
