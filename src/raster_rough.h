// raster_rough.h — metallic-roughness by microfacets in the rasteriser: the
// table on the GPU, and the shaders that read it.

#ifndef RASTER_ROUGH_H
#define RASTER_ROUGH_H

#include "dfg.h"
#include "raster_settings.h"

// The table as a texture of its context.
typedef struct raster_rough {
  unsigned texture;
} raster_rough;

raster_rough raster_rough_new(const gl *g, const dfg *table, arena *scratch);
void raster_rough_free(const gl *g, raster_rough *r);

// What raster_settings.metal_rough is to be; r must outlive its use, and the
// settings' model is the table's.
raster_piece raster_rough_piece(const raster_rough *r);

#endif
