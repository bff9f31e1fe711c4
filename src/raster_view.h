// raster_view.h — a camera as OpenGL wants it.

#ifndef RASTER_VIEW_H
#define RASTER_VIEW_H

#include "camera.h"
#include "raster_settings.h"
#include "raster_shadow.h"

// Positions are less the origin of the scene's vertices.
typedef struct raster_view {
  raster_matrix clip;  // world to clip space
  vec3 eye, forward;
  vec3 corner, right, up;  // directions: to the lower left corner of the
                           // picture, and from there along its sides
  float farthest;          // of the scene's box along the view axis
} raster_view;

// The window of the film that is drawn, half-open.
typedef struct raster_window {
  int x0, y0, x1, y1;
} raster_window;
raster_window raster_window_of(const raster_settings *set);

raster_view raster_view_of(const camera_view *v, raster_window w,
                           const scene *s, raster_space space);

#endif
