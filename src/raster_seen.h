// raster_seen.h — which triangle each sample sees, and what shaders need to
// find out the rest.  Source: Burns and Hunt 2013, "The Visibility Buffer".

#ifndef RASTER_SEEN_H
#define RASTER_SEEN_H

#include "gl_make.h"
#include "raster_mesh.h"

// Texels of a material in the table: see matter.glsl.
enum { RASTER_MATERIAL_TEXELS = 5 };

typedef struct raster_seen {
  int samples;
  GLenum target;       // GL_TEXTURE_2D, or that of several samples
  GLuint framebuffer;  // 0: there is none yet
  GLuint numbers;      // a texture: 0, or a triangle's number and 1
  GLuint depth;
  GLuint vertices;          // the buffer of the mesh as a texture
  GLuint materials, table;  // a texture, and its buffer
} raster_seen;

// Whether a mesh is not too large for it.
bool raster_seen_fits(const gl *g, size_t triangles);

// Samples as the driver can; fails when there is no room.
bool raster_seen_new(raster_seen *out, const gl *g, const raster_mesh *m,
                     const gl_target *like, error *err);
void raster_seen_free(const gl *g, raster_seen *s);

// Fill the table: RASTER_MATERIAL_TEXELS times RGBA a material.
void raster_seen_fill(const gl *g, const raster_seen *s, const float *texels,
                      size_t materials);

// Bind the textures to three units and tell the program.
void raster_seen_bind(const gl *g, const raster_seen *s, GLuint program,
                      int first_unit);

#endif
