// view_paths.h — the path tracer that works while somebody looks: one sample a
// pixel after another, by threads that the caller never waits for.

#ifndef VIEW_PATHS_H
#define VIEW_PATHS_H

#include "path_world.h"
#include "pool.h"
#include "view_state.h"

typedef struct view_paths view_paths;

typedef struct view_paths_settings {
  int width, height;
  uint64_t seed;
  path_world world;  // its tracer is chosen here
} view_paths_settings;

// At rest.  The scene must outlive the result; so must the pool, of at least
// two workers, which nobody else may use while passes run.
view_paths *view_paths_new(const view_paths_settings *set, pool *threads,
                           arena *mem);

// Begin anew with this look.  Returns as soon as every worker has put down
// the tile in its hands.  Fails when the camera is impossible.
bool view_paths_restart(view_paths *p, const view_look *look, error *err);

// Give up what is under way.
void view_paths_stop(view_paths *p);

// The picture so far, in mem, if a pass has ended since the last call; the
// next pass then begins.  Never waits.  After N passes it is the picture of
// `facet render --engine path --spp N`, to the bit.
bool view_paths_poll(view_paths *p, image *out, arena *mem);

// The picture after so many passes, however long it takes.
image view_paths_finish(view_paths *p, int spp, arena *mem);

// Passes in the picture so far.
int view_paths_spp(const view_paths *p);

void view_paths_free(view_paths *p);

#endif
