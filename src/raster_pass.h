// raster_pass.h — the passes that make a frame: what the lights see, the
// surfaces, the sky, the sheets.

#ifndef RASTER_PASS_H
#define RASTER_PASS_H

#include "raster_stock.h"

// The irradiance on a plane of unit normal n, by a sum over directions.
vec3 raster_irradiance(const env *e, vec3 n);

// Depth as it is compared here: nearer or as near passes, and is written.
void raster_pass_begin(const raster_stock *r);

// What the camera of the frame sees, for raster_draw_part; NULL where nothing
// is left out.
const raster_frustum *raster_pass_view(const raster_stock *r);

// Whether a material has no part in the frame.
bool raster_pass_leaves(const raster_stock *r, size_t which);

// Whether the sky is to be drawn behind what the framebuffer in force holds.
bool raster_pass_sky(raster_stock *r, bool *wanted, error *err);

// Fill the shadow maps.
bool raster_pass_shadows(raster_stock *r, error *err);

// Clear r->many and draw every surface, the sky and the sheets into it.
// as_mean: the numbers of the AOVs rather than of the shading modes.
bool raster_pass_frame(raster_stock *r, raster_shading shading, bool as_mean,
                       error *err);

#endif
