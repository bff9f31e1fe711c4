// render.h — every pixel of a film, by all threads, the same for any number of
// them.

#ifndef RENDER_H
#define RENDER_H

#include "path_naive.h"
#include "pool.h"
#include "render_guide.h"
#include "render_keep.h"

#include <signal.h>

typedef struct render_progress {
  double done;       // share of the work, 0..1
  double begun;      // of that, before this run
  double seconds;    // since rendering began
  uint64_t samples;  // of this run
  double error;      // estimated relative error of the picture, 0: not known
} render_progress;

typedef struct render_settings {
  int width, height;
  int x0, y0, x1, y1;  // crop, half-open; all of the film when x1 is 0
  int shard, shards;   // only the tiles of that one, 0..shards-1; 0: all
  int spp;             // total
  uint64_t seed;
  const integrator *by;  // NULL: path_naive with that seed
  render_shading shading;
  unsigned aovs;
  double deadline;            // CLOCK_MONOTONIC seconds to stop at; 0: none
  double error;               // stop at this estimated relative error; 0: never
  const render_guide *guide;  // NULL: none
  const render_keep *keep;    // NULL: nobody keeps the sums
  const volatile sig_atomic_t *stop;  // finish the pass when it turns non-zero
  void (*progress)(void *context, const render_progress *p);  // may be NULL
  void *progress_context;
  // When *snapshot turns non-zero, it is set to 0 and the picture so far is
  // handed over after the pass; its images live until on_snapshot returns.
  volatile sig_atomic_t *snapshot;  // may be NULL
  void (*on_snapshot)(void *context, const render_result *so_far);
  void *snapshot_context;
} render_settings;

// Render into images that live in mem.
void render_run(render_result *out, const path_world *world,
                const camera_view *view, const render_settings *settings,
                arena *mem, pool *threads);

#endif
