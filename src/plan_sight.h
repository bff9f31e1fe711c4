// plan_sight.h — which triangles a camera may see, block by block.

#ifndef PLAN_SIGHT_H
#define PLAN_SIGHT_H

#include "raster_block.h"

typedef struct plan_sight {
  size_t triangles, edges;  // that can be drawn at all; left out as no area
  size_t in_view;           // of those that can be drawn
  bool *unseen;             // by material, at least one
  size_t seen;              // materials that are not
} plan_sight;

// For the window of a camera's film from (x0, y0) to (x1, y1), in mem.  all:
// everything counts as in view, and as a triangle.
plan_sight plan_sight_of(const scene *s, const camera_view *v,
                         const int window[4], bool all, arena *mem);

#endif
