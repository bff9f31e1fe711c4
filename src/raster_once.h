// raster_once.h — a frame in which every pixel is shaded once for each triangle
// that its samples see, and no triangle that they do not.

#ifndef RASTER_ONCE_H
#define RASTER_ONCE_H

#include "raster_stock.h"

// Whether the frame can be drawn so: nothing has textures or lets light
// through, and radiance is wanted.
bool raster_once_can(const raster_stock *r);

// Framebuffers for it, when they are not there yet.
bool raster_once_ready(raster_stock *r, error *err);

// Clear r->once and draw the frame into it.
bool raster_once_frame(raster_stock *r, error *err);

#endif
