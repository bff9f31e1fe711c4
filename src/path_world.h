// path_world.h — what paths walk through, and who walks them.

#ifndef PATH_WORLD_H
#define PATH_WORLD_H

#include "camera.h"
#include "matter.h"

// What a path walks through.
typedef struct path_world {
  const scene *scene;
  tracer tracer;
  bool lights;     // point and directional lights on
  int max_depth;   // segments: 1 emission seen, 2 direct light; 0 roulette only
  const dfg *dfg;  // matter_table of the scene
  bool lamps_only;  // nothing else shines: no last segment finds light
  bool thorough;    // also do what adds nothing (chapter 13)
} path_world;

// What paths did.
typedef struct path_stats {
  uint64_t rays;      // closest and any
  uint64_t cut;       // paths ended by the limit on their length: lost light
  uint64_t followed;  // paths
  uint64_t asked, shadows;  // light samples, and shadow rays of them
  uint64_t through;         // blocked shadow rays that look for sheets
  uint64_t aimed;           // rays at mirrors and glass
  uint64_t shared;          // rays at what neighbours have found
} path_stats;

// Where a path begins: the camera ray of a sample of a pixel, numbered in the
// full film.
typedef struct path_start {
  ray ray;
  uint64_t pixel;
  uint32_t sample;
} path_start;

// Pixels next to each other, PATH_ROW at most, and the number of a sample of
// each of them.
typedef struct path_row {
  const camera_view *view;
  uint64_t pixel;  // the first, numbered in the full film
  int x, y, count;
  uint32_t sample;
} path_row;

enum { PATH_ROW = 16 };

// One way to find the radiance along camera rays.  All of its answers are
// functions of the scene, its settings, pixel and sample, whatever else is
// asked at the same time.
typedef struct integrator {
  const void *self;
  // Where in its pixel a sample lies, each in [0, 1).
  vec2 (*place)(const void *self, uint64_t pixel, uint32_t sample);
  // Room for one worker's calls of radiance, in mem.
  void *(*room)(const void *self, arena *mem);
  // The radiance that arrives along each of n starts, INTEGRATOR_BATCH at most.
  void (*radiance)(const void *self, const path_start *starts, size_t n,
                   vec3 *out, path_stats *stats, void *room);
  // Where the samples of a row begin, by place and camera_ray; NULL: that is
  // for integrator_begin to do.
  void (*begin)(const void *self, const path_row *row, path_start *out);
} integrator;

static inline void integrator_begin(const integrator *by, const path_row *row,
                                    path_start *out) {
  if (by->begin != NULL) {
    by->begin(by->self, row, out);
    return;
  }
  for (int i = 0; i < row->count; i++) {
    uint64_t pixel = row->pixel + (uint64_t)i;
    vec2 at = by->place(by->self, pixel, row->sample);
    float x = (float)(row->x + i) + at.x, y = (float)row->y + at.y;
    out[i] = (path_start){camera_ray(row->view, x, y), pixel, row->sample};
  }
}

// A batch: enough rays for a tracer to work on several at once, few enough for
// their state to stay in the cache.
enum { INTEGRATOR_BATCH = 1024 };

#endif
