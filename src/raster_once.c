// raster_once.c — the trick: which triangle a sample sees is found first, as a
// number and nothing else; then whole pictures are shaded, one for each kind of
// program, where the depth test lets through the pixels that want it.

#include "raster_once.h"

#include "raster_pass.h"

// Programs are told apart by depths in steps of 1 / KIND_STEPS, which floats
// and both conventions of depth hold exactly; 0 is for pixels that want none.
enum { KIND_STEPS = 64, KINDS = KIND_STEPS - 2, KIND_NOTHING = KIND_STEPS - 1 };

// The programs of a frame: without textures there are 24 variants.
typedef struct kind_list {
  raster_variant of[KINDS];
  int count;
} kind_list;

// Whether a material looks at a texture that there is, decoded or not.
static bool has_maps(const raster_settings *set, const material *m) {
  unsigned reads = material_reads(m, raster_kind(set, m));
  for (int k = 0; k < RASTER_MAP_COUNT; k++) {
    const texture_map *map = raster_map_of(m, k);
    if ((reads >> k & 1) != 0 && (map->image != NULL || map->found != NULL))
      return true;
  }
  return false;
}

bool raster_once_can(const raster_stock *r) {
  if (r->set.each || r->set.shading != RASTER_RADIANCE) return false;
  for (size_t i = 0; i < r->mesh.part_count; i++) {
    const material *m = &r->materials[i];
    if (r->mesh.parts[i].count == 0) continue;
    if (m->passes || has_maps(&r->set, m)) return false;
  }
  return raster_seen_fits(r->g, r->scene->mesh.triangle_count);
}

bool raster_once_ready(raster_stock *r, error *err) {
  raster_window w = raster_window_of(&r->set);
  int width = w.x1 - w.x0, height = w.y1 - w.y0;
  if (r->once.width == 0 &&
      !gl_target_new(&r->once, r->g, width, height, 1, err))
    return false;
  if (r->seen.framebuffer != 0) return true;
  return raster_seen_new(&r->seen, r->g, &r->mesh, &r->once, err);
}

// The number of a variant's program in the list, counted from 1.
static int kind_number(kind_list *list, raster_variant v) {
  int i = 0;
  while (i < list->count && !raster_variant_same(list->of[i], v))
    i++;
  if (i == list->count) list->of[list->count++] = v;
  return i + 1;
}

static void put_texel(float *texel, vec3 v, float w) {
  texel[0] = v.x, texel[1] = v.y, texel[2] = v.z, texel[3] = w;
}

// One material as rows of the table.
static void put_material(float *texels, const raster_stock *r, size_t which,
                         int kind) {
  const material *m = &r->materials[which];
  raster_gloss_place place = raster_gloss_place_of(&r->set, m);
  put_texel(texels, m->kd, m->roughness);
  put_texel(texels + 4, m->ks, m->ns);
  put_texel(texels + 8, m->ke, m->ni);
  put_texel(texels + 12, m->tf, m->metallic);
  vec3 last = {(float)kind / KIND_STEPS, (float)place.first,
               (float)place.width};
  put_texel(texels + 16, last, 0);
}

// The table of materials, and the programs that they want.
static kind_list fill_table(raster_stock *r) {
  kind_list list = {.count = 0};
  arena scratch = {0};
  const size_t row = (size_t)RASTER_MATERIAL_TEXELS * 4;
  size_t n = r->mesh.part_count;
  float *texels = ARENA_NEW(&scratch, float, n *row);
  for (size_t i = 0; i < n; i++) {
    if (raster_pass_leaves(r, i)) continue;
    raster_variant v =
        raster_variant_of(&r->set, &r->materials[i], RASTER_RADIANCE);
    v.once = true;
    put_material(texels + i * row, r, i, kind_number(&list, v));
  }
  raster_seen_fill(r->g, &r->seen, texels, n);
  arena_free(&scratch);
  return list;
}

// The number of the triangle that each sample sees.
static bool find_seen(raster_stock *r, error *err) {
  const gl_api *f = gl_functions(r->g);
  GLuint program;
  raster_variant v = {.stage = RASTER_STAGE_SEEN};
  if (!raster_program_get(&program, &r->programs, v, err)) return false;
  const GLuint nothing[4] = {0};
  f->BindFramebuffer(GL_FRAMEBUFFER, r->seen.framebuffer);
  f->Viewport(0, 0, r->once.width, r->once.height);
  f->ClearDepth(r->space.reversed ? 0 : 1);
  f->Clear(GL_DEPTH_BUFFER_BIT);
  f->ClearBufferuiv(GL_COLOR, 0, nothing);
  f->UseProgram(program);
  raster_set_view(r, program);
  f->BindVertexArray(r->mesh.vertices);
  GLint number = f->GetUniformLocation(program, "u_first");
  for (size_t i = 0; i < r->mesh.part_count; i++)
    if (!raster_pass_leaves(r, i))
      r->counts.drawn += raster_draw_part(r, i, raster_pass_view(r), number);
  return true;
}

// Cover the picture with a program at a depth, for one sample of each pixel.
static bool cover(raster_stock *r, raster_variant v, int depth, int sample,
                  error *err) {
  const gl_api *f = gl_functions(r->g);
  GLuint program;
  if (!raster_program_get(&program, &r->programs, v, err)) return false;
  f->UseProgram(program);
  raster_set_view(r, program);
  if (v.stage == RASTER_STAGE_SKY) raster_set_env(r, program);
  if (v.stage == RASTER_STAGE_SURFACE) raster_set_light(r, program, v.kind);
  raster_seen_bind(r->g, &r->seen, program, RASTER_SEEN_UNIT);
  raster_set2(r->g, program, "u_film",
              (vec2){(float)r->once.width, (float)r->once.height});
  raster_set1(r->g, program, "u_depth", (float)depth / KIND_STEPS);
  raster_set1(r->g, program, "u_nothing", (float)KIND_NOTHING / KIND_STEPS);
  f->Uniform1i(f->GetUniformLocation(program, "u_sample"), sample);
  f->DrawArrays(GL_TRIANGLES, 0, 3);
  return true;
}

// Write which program a sample of each pixel wants.
static bool find_kinds(raster_stock *r, int sample, error *err) {
  const gl_api *f = gl_functions(r->g);
  f->DepthFunc(GL_ALWAYS);
  f->DepthMask(GL_TRUE);
  f->ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  raster_variant v = {.stage = RASTER_STAGE_KIND};
  bool ok = cover(r, v, 0, sample, err);
  f->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  f->DepthFunc(GL_EQUAL);
  f->DepthMask(GL_FALSE);
  return ok;
}

// Add the share of one sample of each pixel, and of those like it.
static bool add_sample(raster_stock *r, const kind_list *list, int sample,
                       bool with_sky, error *err) {
  if (!find_kinds(r, sample, err)) return false;
  for (int i = 0; i < list->count; i++)
    if (!cover(r, list->of[i], i + 1, sample, err)) return false;
  if (!with_sky) return true;
  raster_variant sky = {.stage = RASTER_STAGE_SKY, .once = true};
  return cover(r, sky, KIND_NOTHING, sample, err);
}

bool raster_once_frame(raster_stock *r, error *err) {
  const gl_api *f = gl_functions(r->g);
  kind_list list = fill_table(r);
  raster_pass_begin(r);
  bool sky;
  if (!find_seen(r, err) || !raster_pass_sky(r, &sky, err)) return false;
  r->counts.skies += sky;
  r->counts.once++;
  f->BindFramebuffer(GL_FRAMEBUFFER, r->once.draw);
  f->ClearColor(0, 0, 0, 0);
  f->Clear(GL_COLOR_BUFFER_BIT);
  f->BindVertexArray(r->no_vertices);
  f->Enable(GL_BLEND);
  f->BlendFunc(GL_ONE, GL_ONE);
  bool ok = true;
  for (int k = 0; k < r->seen.samples && ok; k++)
    ok = add_sample(r, &list, k, sky, err);
  f->Disable(GL_BLEND);
  f->DepthMask(GL_TRUE);
  r->shown = &r->once;
  return ok;
}
