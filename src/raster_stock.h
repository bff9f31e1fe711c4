// raster_stock.h — all that the engine keeps in the context, and how programs
// are told of it.

#ifndef RASTER_STOCK_H
#define RASTER_STOCK_H

#include "gl_make.h"
#include "raster_maps.h"
#include "raster_mesh.h"
#include "raster_program.h"
#include "raster_seen.h"
#include "raster_shadow.h"
#include "raster_view.h"

// Texture units beside those of the materials' maps.
enum {
  RASTER_SHADOW_UNIT = 9,
  RASTER_ENV_UNIT = 10,
  RASTER_SEEN_UNIT = 0  // and two more: where those have none
};

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
  gl_target many;  // every triangle shaded; no framebuffer before it is used
  gl_target once;  // every pixel shaded
  const gl_target *shown;  // the one of the last frame
  raster_seen seen;        // no framebuffer before it is used
  raster_view view;        // of the last frame
  raster_frustum frustum;  // of the same
  raster_counts counts;
} raster_stock;

// Draw those vertices of a material that may lie in view, NULL: all; says how
// many triangles that are.  With number >= 0 that uniform of the program gets
// the first of each call.
size_t raster_draw_part(const raster_stock *r, size_t of,
                        const raster_frustum *view, GLint number);

// Set uniforms of a program in use, and bind its textures.
void raster_set_view(const raster_stock *r, GLuint program);
void raster_set_env(const raster_stock *r, GLuint program);
void raster_set_material(const raster_stock *r, GLuint program, size_t which);

// Environment, lights, shadows and pieces: all that lights a kind of surface.
void raster_set_light(const raster_stock *r, GLuint program,
                      material_kind kind);

#endif
