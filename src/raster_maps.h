// raster_maps.h — the textures of materials, with mipmaps.

#ifndef RASTER_MAPS_H
#define RASTER_MAPS_H

#include "gl.h"
#include "gl_api.h"
#include "scene.h"

// The texture statements of a material, in the order of u_map_place of
// shaders/matter.glsl, which is that of their texture units too.
enum {
  RASTER_MAP_KD,
  RASTER_MAP_KS,
  RASTER_MAP_KE,
  RASTER_MAP_NS,
  RASTER_MAP_D,
  RASTER_MAP_PR,
  RASTER_MAP_PM,
  RASTER_MAP_BUMP,
  RASTER_MAP_NORM,
  RASTER_MAP_COUNT
};

// Statement k of a material.
const texture_map *raster_map_of(const material *m, int k);

// The letters that name it in defines and uniforms: "kd".
const char *raster_map_name(int k);

// The weights that make a number of a texel.
typedef struct raster_channels {
  float r, g, b, a;
} raster_channels;
raster_channels raster_map_channels(const texture_map *m, int k);

// A texture per material and statement, 0 where there is none; a picture that
// is used twice is uploaded once.  RASTER_MAP_COUNT a material.
GLuint *raster_maps_upload(const gl *g, const scene *s, arena *mem);
void raster_maps_free(const gl *g, GLuint *maps, const scene *s);

#endif
