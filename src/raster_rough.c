// raster_rough.c

#include "raster_rough.h"

#include "gl_make.h"

#include <string.h>

raster_rough raster_rough_new(const gl *g, const dfg *table, arena *scratch) {
  const size_t width = DFG_COLUMNS + 1;
  dfg_pair *texels = ARENA_NEW(scratch, dfg_pair, width * DFG_ROWS);
  for (size_t y = 0; y < DFG_ROWS; y++) {
    memcpy(texels + y * width, table->table + y * DFG_COLUMNS,
           DFG_COLUMNS * sizeof *texels);
    texels[y * width + DFG_COLUMNS] = table->mean[y];
  }
  gl_texture_spec spec = {.width = (int)width,
                          .height = DFG_ROWS,
                          .internal = GL_RG32F,
                          .format = GL_RG,
                          .type = GL_FLOAT,
                          .pixels = texels,
                          .wrap_s = GL_CLAMP_TO_EDGE,
                          .wrap_t = GL_CLAMP_TO_EDGE};
  return (raster_rough){gl_texture_new(g, &spec)};
}

void raster_rough_free(const gl *g, raster_rough *r) {
  gl_functions(g)->DeleteTextures(1, &r->texture);
  r->texture = 0;
}

static void bind_table(const void *context, const gl *g, unsigned program,
                       int unit) {
  const gl_api *f = gl_functions(g);
  f->ActiveTexture(GL_TEXTURE0 + (GLenum)unit);
  f->BindTexture(GL_TEXTURE_2D, ((const raster_rough *)context)->texture);
  f->Uniform1i(f->GetUniformLocation(program, "u_dfg"), unit);
}

raster_piece raster_rough_piece(const raster_rough *r) {
  return (raster_piece){
      .shaders = {"microfacet.glsl", "mirrored.glsl", "rough.glsl"},
      .bind = bind_table,
      .context = r};
}
