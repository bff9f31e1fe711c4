// render_guide.h — whoever watches a picture grow, and may say where samples
// go.

#ifndef RENDER_GUIDE_H
#define RENDER_GUIDE_H

#include "film.h"
#include "pool.h"
#include "shard.h"

#include <stddef.h>
#include <stdint.h>

// Pixels a side of a tile, the item of work of a thread.
enum { RENDER_TILE = SHARD_TILE };

// Samples (one is one of one pixel) for which there is time.
typedef struct render_budget {
  double pass;  // before somebody wants to see something
  double left;  // before the deadline; INFINITY without one
} render_budget;

// One sample of each pixel of a tile, or of those of one colour, as a
// chessboard has them: (x + y) mod 2, x and y in the window.
enum { RENDER_BOTH_COLORS = 2 };
typedef struct render_turn {
  uint32_t sample;
  int color;  // 0, 1 or RENDER_BOTH_COLORS
} render_turn;

// Members may be NULL: without plan, every pixel gets the same samples; without
// mean, a pixel is the mean of its samples.  Pixels are numbered in the window.
typedef struct render_guide {
  void *self;
  // Plan a pass; how many samples it has, 0 when it is enough.  No other call
  // is under way.
  double (*plan)(void *self, const render_budget *b);
  // The next turn of the tile in this pass; false when the tile is done.  *at
  // is 0 at first and the guide's after that.
  bool (*next)(void *self, size_t tile, uint32_t *at, render_turn *turn);
  // Told before the first sample of the film that gets them all, which then has
  // squares.
  void (*watch)(void *self, const film *all);
  // Told of every sample by the worker that has the tile, before the film gets
  // it.
  void (*add)(void *self, size_t pixel, uint32_t sample, vec3 color);
  // Told after a pass how many rays the tile's paths took.
  void (*spend)(void *self, size_t tile, uint64_t rays);
  // The picture's relative error so far; 0: not known.  No other call is under
  // way.
  double (*error)(void *self, pool *threads);
  vec3 (*mean)(const void *self, size_t pixel);
  vec3 (*variance)(const void *self, size_t pixel);
} render_guide;

#endif
