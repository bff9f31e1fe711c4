// raster_env.h — light from the environment in the rasteriser: what a scene
// needs, as a texture, and the shader that reads it.

#ifndef RASTER_ENV_H
#define RASTER_ENV_H

#include "ibl.h"
#include "raster_settings.h"
#include "scene.h"

// Where a level lies in the texture: its first texel, and how many make a row.
typedef struct raster_env_level {
  float roughness;
  int start, width;
} raster_env_level;

// Prepared light in a context.
typedef struct raster_env {
  unsigned texture;
  const char *defines;
  raster_env_level level[IBL_MAX_LEVELS];
  int level_count;
} raster_env;

// What the materials of a scene ask for, those aside that are unseen (NULL:
// none).  Roughness that comes from a texture, or that may change later (any),
// wants the standard levels.  The list lies in mem.
ibl_need raster_env_need(const scene *s, pbr_model model, bool any,
                         const bool *unseen, arena *mem);

// Upload; the irradiance must be there.  defines live in mem.
raster_env raster_env_new(const gl *g, const ibl *made, arena *mem);
void raster_env_free(const gl *g, raster_env *r);

// What raster_settings.ambient is to be; r must outlive its use.
raster_piece raster_env_piece(const raster_env *r);

#endif
