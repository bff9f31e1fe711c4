// raster.c

#include "raster.h"

#include "clock.h"
#include "raster_once.h"
#include "raster_pass.h"

struct raster {
  raster_stock stock;
  raster_times times;
  raster_counts counts;  // of the last frame, without the passes after it
  double mesh_seconds, map_seconds;  // parts of times.upload
  arena *mem;
};

// What faces without any material look like: as in the path engine.
static const material GREY = {.kd = {0.8f, 0.8f, 0.8f}, .d = 1};

static void copy_materials(raster_stock *r, arena *mem) {
  size_t n = r->scene->material_count;
  r->materials = ARENA_NEW(mem, material, n > 0 ? n : 1);
  r->hidden = ARENA_NEW(mem, bool, n > 0 ? n : 1);
  r->materials[0] = GREY;
  for (size_t i = 0; i < n; i++)
    r->materials[i] = r->scene->materials[i];
}

// What ambient.glsl reads; where another file stands in its place, nobody does.
static void ready_ambient(raster_stock *r) {
  const env *e = &r->scene->env;
  if (e->kind == ENV_NONE || r->set.ambient.shaders[0] != NULL) return;
  r->above = raster_irradiance(e, (vec3){0, 1, 0});
  r->below = raster_irradiance(e, (vec3){0, -1, 0});
}

static void upload_env(raster_stock *r) {
  const env *e = &r->scene->env;
  if (e->kind != ENV_MAP || e->map.pixels == NULL) return;
  r->env_map =
      gl_texture_new(r->g, &(gl_texture_spec){.width = e->map.width,
                                              .height = e->map.height,
                                              .internal = GL_RGB32F,
                                              .format = GL_RGB,
                                              .type = GL_FLOAT,
                                              .pixels = e->map.pixels,
                                              .wrap_s = GL_REPEAT,
                                              .wrap_t = GL_CLAMP_TO_EDGE});
}

static raster_space space_of(const raster_stock *r) {
  vec3 half = vec3_scale(vec3_sub(r->scene->hi, r->scene->lo), 0.5f);
  float radius = vec3_length(half);
  bool reversed = gl_functions(r->g)->ClipControl != NULL;
  return (raster_space){r->mesh.origin, radius > 0 ? radius : 1, reversed};
}

// Shadow maps, when they are wanted and not there yet.
static bool ready_shadows(raster *r, error *err) {
  raster_stock *s = &r->stock;
  bool wanted = s->set.lights && s->set.shadows && s->scene->light_count > 0;
  bool had = s->shadow.layers > 0;
  if (wanted && !had &&
      !raster_shadow_new(&s->shadow, s->g, s->scene, s->space,
                         s->set.shadow_size, r->mem, err))
    return false;
  if (!wanted && had) raster_shadow_free(s->g, &s->shadow);
  if (wanted != had) s->shadows_drawn = false;
  s->programs.shadow_layers = s->shadow.layers;
  return true;
}

// Samples a pixel, as the driver can.
static int samples_of(const raster_stock *s) {
  GLint most = 1;
  gl_functions(s->g)->GetIntegerv(GL_MAX_SAMPLES, &most);
  int samples = s->set.msaa < most ? s->set.msaa : most;
  return samples < 1 ? 1 : samples;
}

// Whether a frame of that kind is drawn by raster_once.h.
static bool draws_once(const raster_stock *s, raster_shading shading) {
  return shading == RASTER_RADIANCE && raster_once_can(s);
}

// The framebuffers for such a frame.
static bool ready_target(raster_stock *s, raster_shading shading, error *err) {
  if (draws_once(s, shading)) return raster_once_ready(s, err);
  raster_window w = raster_window_of(&s->set);
  return s->many.width > 0 || gl_target_new(&s->many, s->g, w.x1 - w.x0,
                                            w.y1 - w.y0, s->set.msaa, err);
}

// A program for each kind of surface, whether the scene has it or not.
static bool ready_kinds(raster_stock *s, bool once, error *err) {
  for (int k = MATERIAL_BLINN_PHONG; k <= MATERIAL_GLASS; k++) {
    GLuint program;
    material m = GREY;
    m.kind = (material_kind)k;
    raster_variant v = raster_variant_of(&s->set, &m, s->set.shading);
    v.once = once;
    if (!raster_program_get(&program, &s->programs, v, err)) return false;
  }
  return true;
}

// The programs that the frame needs, before it is timed.
static bool ready_programs(raster_stock *s, error *err) {
  bool once = draws_once(s, s->set.shading);
  for (size_t i = 0; i < s->mesh.part_count; i++) {
    GLuint program;
    if (raster_pass_leaves(s, i)) continue;
    raster_variant v =
        raster_variant_of(&s->set, &s->materials[i], s->set.shading);
    v.once = once;
    if (!raster_program_get(&program, &s->programs, v, err)) return false;
  }
  return !s->set.thorough || ready_kinds(s, once, err);
}

static bool upload(raster *r, arena *mem, error *err) {
  raster_stock *s = &r->stock;
  double start = clock_seconds();
  raster_mesh_upload(&s->mesh, s->g, s->scene, s->set.spared.edges, mem);
  r->mesh_seconds = clock_seconds() - start;
  s->space = space_of(s);
  s->maps = raster_maps_upload(s->g, s->scene, mem);
  r->map_seconds = clock_seconds() - start - r->mesh_seconds;
  copy_materials(s, mem);
  ready_ambient(s);
  upload_env(s);
  gl_functions(s->g)->GenVertexArrays(1, &s->no_vertices);
  s->programs = (raster_programs){.g = s->g,
                                  .set = &s->set,
                                  .lights = s->scene->light_count,
                                  .env = s->scene->env.kind,
                                  .colors = s->scene->mesh.colors != NULL,
                                  .samples = samples_of(s),
                                  .clip_control = s->space.reversed};
  s->seen.samples = s->programs.samples;
  return ready_target(s, s->set.shading, err);
}

bool raster_new(raster **out, gl *g, const scene *s, const raster_settings *set,
                arena *mem, error *err) {
  if (s->light_count > RASTER_MAX_LIGHTS)
    return fail(err, "OpenGL: %zu lights, expected at most %d", s->light_count,
                RASTER_MAX_LIGHTS);
  double start = clock_seconds();
  raster *r = ARENA_NEW(mem, raster, 1);
  r->mem = mem;
  r->stock = (raster_stock){.g = g, .scene = s, .set = *set};
  bool ok = upload(r, mem, err);
  r->times.upload = clock_seconds() - start;
  ok = ok && ready_shadows(r, err) && ready_programs(&r->stock, err);
  r->times.compile = r->stock.programs.seconds;
  if (ok)
    *out = r;
  else
    raster_free(r);
  return ok;
}

void raster_free(raster *r) {
  raster_stock *s = &r->stock;
  const gl_api *f = gl_functions(s->g);
  raster_mesh_free(s->g, &s->mesh);
  if (s->maps != NULL) raster_maps_free(s->g, s->maps, s->scene);
  if (s->programs.g != NULL) raster_programs_free(&s->programs);
  raster_shadow_free(s->g, &s->shadow);
  gl_target_free(s->g, &s->many);
  gl_target_free(s->g, &s->once);
  raster_seen_free(s->g, &s->seen);
  f->DeleteTextures(1, &s->env_map);
  f->DeleteVertexArrays(1, &s->no_vertices);
}

// Shadow maps, where they have to be drawn again.
static bool draw_shadows(raster *r, error *err) {
  raster_stock *s = &r->stock;
  r->times.shadow = 0;
  if (s->shadow.layers == 0 || s->shadows_drawn) return true;
  double start = clock_seconds();
  if (!raster_pass_shadows(s, err)) return false;
  raster_wait(r);
  s->shadows_drawn = true;
  r->times.shadow = clock_seconds() - start;
  return true;
}

// All commands of one frame; it is done when the driver has carried them out.
static bool draw_frame(raster *r, const camera_view *view, error *err) {
  raster_stock *s = &r->stock;
  double compiled = s->programs.seconds;
  raster_window w = raster_window_of(&s->set);
  s->view = raster_view_of(view, w, s->scene, s->space);
  s->frustum = raster_frustum_of(view, (int[4]){w.x0, w.y0, w.x1, w.y1});
  s->counts = (raster_counts){0};
  raster_shading shading = s->set.shading;
  if (!ready_target(s, shading, err) || !draw_shadows(r, err)) return false;
  if (draws_once(s, shading) ? !raster_once_frame(s, err)
                             : !raster_pass_frame(s, shading, false, err))
    return false;
  r->counts = s->counts;
  r->times.compile += s->programs.seconds - compiled;
  return true;
}

bool raster_draw(raster *r, const camera_view *view, error *err) {
  double start = clock_seconds();
  if (!draw_frame(r, view, err)) return false;
  raster_wait(r);
  r->times.draw = clock_seconds() - start - r->times.shadow;
  return true;
}

bool raster_draw_next(raster *r, const camera_view *view, error *err) {
  if (!draw_frame(r, view, err)) return false;
  gl_functions(r->stock.g)->Flush();
  return true;
}

void raster_wait(const raster *r) {
  gl_functions(r->stock.g)->Finish();
}

double raster_resolve_seconds(const raster *r) {
  raster_wait(r);
  double start = clock_seconds();
  gl_target_resolve(r->stock.g, r->stock.shown);
  raster_wait(r);
  return clock_seconds() - start;
}

image raster_read(raster *r, arena *mem) {
  double start = clock_seconds();
  image out = gl_target_image(r->stock.g, r->stock.shown, NULL, mem);
  r->times.read = clock_seconds() - start;
  return out;
}

// A pixel's mean over those samples that see something is the mean over all
// divided by their share, which lies in alpha; depth alone counts so.
bool raster_read_aov(image *out, raster *r, raster_shading which, arena *mem,
                     error *err) {
  raster_stock *s = &r->stock;
  if (!ready_target(s, which, err) || !raster_pass_frame(s, which, true, err))
    return false;
  arena scratch = {0};
  size_t n = (size_t)s->many.width * (size_t)s->many.height;
  float *alpha = ARENA_NEW(&scratch, float, n);
  image it = gl_target_image(s->g, &s->many, alpha, mem);
  for (size_t i = 0; i < n && which == RASTER_DEPTH; i++)
    if (alpha[i] > 0) it.pixels[i] = vec3_scale(it.pixels[i], 1 / alpha[i]);
  arena_free(&scratch);
  *out = it;
  return true;
}

bool raster_change(raster *r, const raster_settings *set, error *err) {
  raster_stock *s = &r->stock;
  raster_settings now = *set, old = s->set;
  now.width = old.width, now.height = old.height, now.msaa = old.msaa;
  now.x0 = old.x0, now.y0 = old.y0, now.x1 = old.x1, now.y1 = old.y1;
  raster_programs_free(&s->programs);
  s->set = now;
  ready_ambient(s);
  return ready_shadows(r, err) && ready_programs(s, err);
}

material *raster_materials(raster *r, size_t *count) {
  *count = r->stock.mesh.part_count;
  return r->stock.materials;
}

void raster_hide(raster *r, size_t which, bool hidden) {
  if (r->stock.hidden[which] == hidden) return;
  r->stock.hidden[which] = hidden;
  r->stock.shadows_drawn = false;
}

raster_frame raster_last_frame(const raster *r) {
  const raster_stock *s = &r->stock;
  const gl_target *t = s->shown != NULL ? s->shown : &s->many;
  return (raster_frame){t->read, t->resolved, t->width, t->height,
                        s->programs.samples};
}

// Distinct textures, and the bytes of their pictures.
static void count_maps(raster_counts *c, const raster_stock *s) {
  size_t n = s->scene->material_count * RASTER_MAP_COUNT;
  for (size_t i = 0; i < n; i++) {
    size_t before = 0;
    while (before < i && s->maps[before] != s->maps[i])
      before++;
    if (s->maps[i] == 0 || before < i) continue;
    const texture *t = raster_map_of(&s->scene->materials[i / RASTER_MAP_COUNT],
                                     (int)(i % RASTER_MAP_COUNT))
                           ->image;
    size_t texel = t->bytes != NULL ? 4 : 16;
    c->map_bytes += texel * (size_t)t->width * (size_t)t->height;
    c->maps++;
  }
}

raster_counts raster_last_counts(const raster *r) {
  const raster_stock *s = &r->stock;
  raster_counts c = r->counts;
  unsigned kinds = 0;
  for (size_t i = 0; i < s->programs.count; i++) {
    raster_variant v = s->programs.entries[i].variant;
    if (v.stage == RASTER_STAGE_SURFACE) kinds |= 1u << v.kind;
  }
  for (; kinds != 0; kinds &= kinds - 1)
    c.kinds++;
  c.programs = s->programs.count;
  c.bytes = s->mesh.bytes;
  c.seconds = r->mesh_seconds;
  c.map_seconds = r->map_seconds;
  c.lamps = s->set.lights ? s->programs.lights : 0;
  c.shadow_bytes = s->shadow.layers * sizeof(float) * (size_t)s->shadow.size *
                   (size_t)s->shadow.size;
  for (size_t i = 0; i < s->mesh.part_count; i++)
    c.uploaded += (size_t)s->mesh.parts[i].count / 3;
  count_maps(&c, s);
  return c;
}

raster_times raster_last_times(const raster *r) {
  return r->times;
}
