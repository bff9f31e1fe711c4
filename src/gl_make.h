// gl_make.h — textures and framebuffers, made in one call each.

#ifndef GL_MAKE_H
#define GL_MAKE_H

#include "gl.h"
#include "gl_api.h"
#include "image.h"

// How a two-dimensional texture is stored and read.
typedef struct gl_texture_spec {
  int width, height;
  GLenum internal;     // GL_RGBA32F
  GLenum format;       // of the data: GL_RGB
  GLenum type;         // GL_FLOAT
  const void *pixels;  // NULL: not filled
  GLenum wrap_s, wrap_t;
  bool mipmaps;  // trilinear; else bilinear
} gl_texture_spec;

// Rows of the data follow each other without padding; the first is at t = 0.
GLuint gl_texture_new(const gl *g, const gl_texture_spec *spec);

// Colour and depth to draw into.  With samples > 1 the picture is drawn into
// `draw` and its mean per pixel lies in `read` after gl_target_resolve; else
// they are the same.
typedef struct gl_target {
  int width, height, samples;
  GLuint draw, read;              // framebuffers
  GLuint color, depth, resolved;  // renderbuffers; the last a texture
} gl_target;

// RGBA as 32-bit floats, depth as 32-bit float.  The samples are as many as
// the driver can up to what is asked for; fails when there is no room.
bool gl_target_new(gl_target *out, const gl *g, int width, int height,
                   int samples, error *err);
void gl_target_resolve(const gl *g, const gl_target *t);
void gl_target_free(const gl *g, gl_target *t);

// The resolved pixels, row 0 on top.  Where alpha is given, it gets the fourth
// channel (width x height floats).
image gl_target_image(const gl *g, const gl_target *t, float *alpha,
                      arena *mem);

#endif
