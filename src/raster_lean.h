// raster_lean.h — metallic-roughness in the rasteriser with lobes that lean.

#ifndef RASTER_LEAN_H
#define RASTER_LEAN_H

#include "lean.h"
#include "raster_rough.h"

// Both tables as textures of their context.
typedef struct raster_lean {
  unsigned texture;
  const raster_rough *rough;
} raster_lean;

// rough must outlive the result, and be of PBR_GGX.
raster_lean raster_lean_new(const gl *g, const lean *table,
                            const raster_rough *rough);
void raster_lean_free(const gl *g, raster_lean *r);

// What raster_settings.metal_rough is to be, in place of raster_rough_piece; r
// must outlive its use.
raster_piece raster_lean_piece(const raster_lean *r);

#endif
