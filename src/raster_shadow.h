// raster_shadow.h — what each light sees, as depth: six views a point light,
// one a directional light, each a layer of one texture.

#ifndef RASTER_SHADOW_H
#define RASTER_SHADOW_H

#include "gl.h"
#include "gl_api.h"
#include "scene.h"

// A column-major matrix, as OpenGL wants it.
typedef struct raster_matrix {
  float m[16];
} raster_matrix;

// The layers of one light: the first, and the side of a texel in world units,
// of a point light at distance 1.
typedef struct raster_shadow_light {
  float first, texel;
} raster_shadow_light;

typedef struct raster_shadow {
  GLuint texture, framebuffer;
  int size;  // texels a side
  size_t layers, lights;
  raster_matrix *clip;  // by layer: world to clip space
  raster_shadow_light *by_light;
} raster_shadow;

// What shadows are cast in: positions are less `origin` and within `radius`
// of it; reversed: depth is 1 near and 0 far.
typedef struct raster_space {
  vec3 origin;
  float radius;
  bool reversed;
} raster_space;

// How many layers the lights of a scene take.
size_t raster_shadow_layers(const scene *s);

// The texture and the views; size 0 chooses one.  Fails when there is no room.
bool raster_shadow_new(raster_shadow *out, const gl *g, const scene *s,
                       raster_space space, int size, arena *mem, error *err);
void raster_shadow_free(const gl *g, raster_shadow *s);

// Begin to draw into a layer: bound, cleared, viewport set.
void raster_shadow_begin(const gl *g, const raster_shadow *s, size_t layer,
                         bool reversed);

#endif
