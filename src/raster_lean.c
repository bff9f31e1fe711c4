// raster_lean.c

#include "raster_lean.h"

#include "gl_make.h"

raster_lean raster_lean_new(const gl *g, const lean *table,
                            const raster_rough *rough) {
  gl_texture_spec spec = {.width = LEAN_COLUMNS,
                          .height = LEAN_ROWS,
                          .internal = GL_RGBA32F,
                          .format = GL_RGBA,
                          .type = GL_FLOAT,
                          .pixels = table->table,
                          .wrap_s = GL_CLAMP_TO_EDGE,
                          .wrap_t = GL_CLAMP_TO_EDGE};
  return (raster_lean){gl_texture_new(g, &spec), rough};
}

void raster_lean_free(const gl *g, raster_lean *r) {
  gl_functions(g)->DeleteTextures(1, &r->texture);
  r->texture = 0;
}

static void bind_both(const void *context, const gl *g, unsigned program,
                      int unit) {
  const raster_lean *r = context;
  const gl_api *f = gl_functions(g);
  raster_piece rough = raster_rough_piece(r->rough);
  rough.bind(rough.context, g, program, unit);
  f->ActiveTexture(GL_TEXTURE0 + (GLenum)(unit + 1));
  f->BindTexture(GL_TEXTURE_2D, r->texture);
  f->Uniform1i(f->GetUniformLocation(program, "u_lean"), unit + 1);
}

raster_piece raster_lean_piece(const raster_lean *r) {
  return (raster_piece){
      .shaders = {"microfacet.glsl", "lean.glsl", "rough.glsl"},
      .bind = bind_both,
      .context = r};
}
