// raster_env.c

#include "raster_env.h"

#include "gl_make.h"
#include "raster_program.h"

#include <string.h>

// Texels in a row of the texture: IBL_ROW of ibl.glsl.
enum { ENV_ROW = 2048 };

ibl_need raster_env_need(const scene *s, pbr_model model, bool any,
                         const bool *unseen, arena *mem) {
  float *list = ARENA_NEW(mem, float, s->material_count);
  ibl_need need = {.model = model,
                   .diffuse = true,
                   .all = any,
                   .roughness = list,
                   .use_cache = true};
  for (size_t i = 0; i < s->material_count; i++) {
    const material *m = &s->materials[i];
    bool rough = m->kind == MATERIAL_METAL_ROUGH;
    bool phong = m->kind == MATERIAL_BLINN_PHONG && vec3_peak(m->ks) > 0;
    if ((!rough && !phong) || (unseen != NULL && unseen[i])) continue;
    const texture_map *map = rough ? &m->map_pr : &m->map_ns;
    if (map->image != NULL || map->found != NULL) need.all = true;
    float r = raster_roughness(m->kind, m);
    bool known = false;
    for (int k = 0; k < need.count; k++)
      known |= list[k] == r;
    if (!known) list[need.count++] = r;
  }
  return need;
}

// The i-th of the levels and, after them, the irradiance.
static const ibl_level *level_by_place(const ibl *b, int i) {
  return i < b->level_count ? &b->level[i] : &b->irradiance;
}

// The lists that ibl.glsl wants.
static const char *env_defines(const ibl *b, arena *mem) {
  char *roughness = arena_format(mem, "%s(", "float[]");
  char *start = arena_format(mem, "%s(", "int[]"), *width = start;
  size_t at = 0;
  for (int i = 0; i <= b->level_count; i++) {
    const ibl_level *l = level_by_place(b, i);
    const char *end = i < b->level_count ? ", " : ")";
    roughness =
        arena_format(mem, "%s%.9e%s", roughness, (double)l->roughness, end);
    start = arena_format(mem, "%s%zu%s", start, at, end);
    width = arena_format(mem, "%s%d%s", width, l->width, end);
    at += ibl_level_texels(l);
  }
  return arena_format(mem,
                      "#define IBL_LEVELS %d\n#define IBL_ROUGHNESS %s\n"
                      "#define IBL_START %s\n#define IBL_WIDTH %s\n",
                      b->level_count, roughness, start, width);
}

raster_env raster_env_new(const gl *g, const ibl *made, arena *mem) {
  arena once = {0};
  size_t count = 0, at = 0;
  for (int i = 0; i <= made->level_count; i++)
    count += ibl_level_texels(level_by_place(made, i));
  size_t rows = (count + ENV_ROW - 1) / ENV_ROW;
  vec3 *texels = ARENA_NEW(&once, vec3, rows * ENV_ROW);
  for (int i = 0; i <= made->level_count; i++) {
    const ibl_level *l = level_by_place(made, i);
    memcpy(texels + at, l->texels, ibl_level_texels(l) * sizeof *texels);
    at += ibl_level_texels(l);
  }
  gl_texture_spec spec = {.width = ENV_ROW,
                          .height = (int)rows,
                          .internal = GL_RGB32F,
                          .format = GL_RGB,
                          .type = GL_FLOAT,
                          .pixels = texels,
                          .wrap_s = GL_CLAMP_TO_EDGE,
                          .wrap_t = GL_CLAMP_TO_EDGE};
  raster_env r = {.texture = gl_texture_new(g, &spec),
                  .defines = env_defines(made, mem),
                  .level_count = made->level_count};
  for (int i = 0, start = 0; i < made->level_count; i++) {
    const ibl_level *l = &made->level[i];
    r.level[i] = (raster_env_level){l->roughness, start, l->width};
    start += (int)ibl_level_texels(l);
  }
  arena_free(&once);
  return r;
}

void raster_env_free(const gl *g, raster_env *r) {
  gl_functions(g)->DeleteTextures(1, &r->texture);
  r->texture = 0;
}

// The level of exactly that roughness, or the last for all beyond.
static bool level_of(const void *context, float roughness, int place[2]) {
  const raster_env *r = context;
  for (int i = 0; i < r->level_count; i++) {
    const raster_env_level *l = &r->level[i];
    bool last = i + 1 == r->level_count && roughness >= l->roughness;
    if (roughness != l->roughness && !last) continue;
    place[0] = l->start;
    place[1] = l->width;
    return true;
  }
  return false;
}

static void bind_levels(const void *context, const gl *g, unsigned program,
                        int unit) {
  const gl_api *f = gl_functions(g);
  f->ActiveTexture(GL_TEXTURE0 + (GLenum)unit);
  f->BindTexture(GL_TEXTURE_2D, ((const raster_env *)context)->texture);
  f->Uniform1i(f->GetUniformLocation(program, "u_ibl"), unit);
}

raster_piece raster_env_piece(const raster_env *r) {
  return (raster_piece){.shaders = {"ibl.glsl"},
                        .defines = r->defines,
                        .level = level_of,
                        .bind = bind_levels,
                        .context = r};
}
