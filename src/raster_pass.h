// raster_pass.h — the passes that make a frame: what the lights see, the
// surfaces, the sky, the sheets.

#ifndef RASTER_PASS_H
#define RASTER_PASS_H

#include "gl_make.h"
#include "raster_maps.h"
#include "raster_mesh.h"
#include "raster_program.h"
#include "raster_shadow.h"
#include "raster_view.h"

// Texture units beside those of the materials' maps.
enum { RASTER_SHADOW_UNIT = 9, RASTER_ENV_UNIT = 10 };

// All that is in the context, and what it came from.
typedef struct raster_stock {
  gl *g;
  const scene *scene;
  raster_settings set;
  raster_space space;
  raster_mesh mesh;
  GLuint *maps;  // of raster_maps.h
  raster_programs programs;
  raster_shadow shadow;
  bool shadows_drawn;
  GLuint env_map;
  vec3 above, below;    // irradiance of the environment on facing planes
  material *materials;  // as drawn; one grey where the scene has none
  bool *hidden;         // by material
  GLuint no_vertices;   // for the sky, whose vertices are made of nothing
  gl_target target;
  raster_view view;  // of the last frame
} raster_stock;

// The irradiance on a plane of unit normal n, by a sum over directions.
vec3 raster_irradiance(const env *e, vec3 n);

// Fill the shadow maps.
bool raster_pass_shadows(raster_stock *r, error *err);

// Clear the target and draw every surface, the sky and the sheets into it.
// as_mean: the numbers of the AOVs rather than of the shading modes.
bool raster_pass_frame(raster_stock *r, raster_shading shading, bool as_mean,
                       error *err);

#endif
