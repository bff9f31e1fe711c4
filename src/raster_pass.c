// raster_pass.c

#include "raster_pass.h"

#include "num.h"

// Rows of directions over a half turn in the sum for the irradiance.
enum { IRRADIANCE_ROWS = 64 };

vec3 raster_irradiance(const env *e, vec3 n) {
  const int rows = IRRADIANCE_ROWS;
  double sum[3] = {0, 0, 0};
  for (int i = 0; i < 2 * rows * rows; i++) {
    float v = ((float)(i / (2 * rows)) + 0.5f) / (float)rows;
    float u = ((float)(i % (2 * rows)) + 0.5f) / (float)(2 * rows);
    vec3 d = env_direction((vec2){u, v}), l = env_radiance(e, d);
    double sine = (double)num_circle(0.5f * v).y;
    double cosine = (double)vec3_dot(n, d);
    if (!(cosine > 0)) continue;
    sum[0] += sine * cosine * (double)l.x;
    sum[1] += sine * cosine * (double)l.y;
    sum[2] += sine * cosine * (double)l.z;
  }
  // A cell is pi / rows on either side.
  double cell = (double)PI / rows * ((double)PI / rows);
  return (vec3){(float)(sum[0] * cell), (float)(sum[1] * cell),
                (float)(sum[2] * cell)};
}

static void bind_texture(const gl_api *f, int unit, GLenum target,
                         GLuint name) {
  f->ActiveTexture(GL_TEXTURE0 + (GLenum)unit);
  f->BindTexture(target, name);
}

static void set_lights(const raster_stock *r, GLuint program) {
  const gl_api *f = gl_functions(r->g);
  float at[RASTER_MAX_LIGHTS][4], power[RASTER_MAX_LIGHTS][3];
  GLsizei n = (GLsizei)r->scene->light_count;
  for (GLsizei i = 0; i < n; i++) {
    const light *l = &r->scene->lights[i];
    bool point = l->kind == LIGHT_POINT;
    vec3 p =
        point ? vec3_sub(l->at, r->space.origin) : vec3_unit(vec3_neg(l->at));
    at[i][0] = p.x, at[i][1] = p.y, at[i][2] = p.z;
    at[i][3] = point ? 1 : 0;
    power[i][0] = l->power.x, power[i][1] = l->power.y;
    power[i][2] = l->power.z;
  }
  if (n == 0) return;
  f->Uniform4fv(f->GetUniformLocation(program, "u_light_at"), n, at[0]);
  f->Uniform3fv(f->GetUniformLocation(program, "u_light_power"), n, power[0]);
}

static void set_shadows(const raster_stock *r, GLuint program) {
  const gl_api *f = gl_functions(r->g);
  const raster_shadow *s = &r->shadow;
  if (s->layers == 0) return;
  f->UniformMatrix4fv(f->GetUniformLocation(program, "u_shadow_of"),
                      (GLsizei)s->layers, GL_FALSE, s->clip->m);
  GLint by_light = f->GetUniformLocation(program, "u_shadow_light");
  f->Uniform2fv(by_light, (GLsizei)s->lights, &s->by_light->first);
  raster_set_unit(r->g, program, "u_shadow", RASTER_SHADOW_UNIT);
  bind_texture(f, RASTER_SHADOW_UNIT, GL_TEXTURE_2D_ARRAY, s->texture);
}

static void set_env(const raster_stock *r, GLuint program) {
  const env *e = &r->scene->env;
  vec3 scale = vec3_all(e->scale);
  if (e->kind == ENV_CONSTANT) scale = vec3_scale(e->constant, e->scale);
  raster_set3(r->g, program, "u_env_scale", scale);
  raster_set1(r->g, program, "u_env_rotate", e->rotate);
  raster_set3(r->g, program, "u_ambient_above", r->above);
  raster_set3(r->g, program, "u_ambient_below", r->below);
  raster_set_unit(r->g, program, "u_env_map", RASTER_ENV_UNIT);
  bind_texture(gl_functions(r->g), RASTER_ENV_UNIT, GL_TEXTURE_2D, r->env_map);
}

static void set_view(const raster_stock *r, GLuint program) {
  const gl_api *f = gl_functions(r->g);
  const raster_view *v = &r->view;
  f->UniformMatrix4fv(f->GetUniformLocation(program, "u_clip"), 1, GL_FALSE,
                      v->clip.m);
  raster_set3(r->g, program, "u_eye", v->eye);
  raster_set3(r->g, program, "u_forward", v->forward);
  raster_set3(r->g, program, "u_sky_corner", v->corner);
  raster_set3(r->g, program, "u_sky_right", v->right);
  raster_set3(r->g, program, "u_sky_up", v->up);
}

static void set_maps(const raster_stock *r, GLuint program, size_t which) {
  const gl_api *f = gl_functions(r->g);
  const material *m = &r->materials[which];
  float place[RASTER_MAP_COUNT][4] = {{0}}, channel[RASTER_MAP_COUNT][4];
  for (int k = 0; k < RASTER_MAP_COUNT; k++) {
    const texture_map *map = raster_map_of(m, k);
    raster_channels c = raster_map_channels(map, k);
    place[k][0] = map->options.scale.x, place[k][1] = map->options.scale.y;
    place[k][2] = map->options.offset.x, place[k][3] = map->options.offset.y;
    channel[k][0] = c.r, channel[k][1] = c.g;
    channel[k][2] = c.b, channel[k][3] = c.a;
    if (map->image == NULL) continue;
    char name[16] = "u_map_";
    for (size_t i = 0; raster_map_name(k)[i] != '\0'; i++)
      name[6 + i] = raster_map_name(k)[i];
    raster_set_unit(r->g, program, name, k);
    bind_texture(f, k, GL_TEXTURE_2D,
                 r->maps[which * RASTER_MAP_COUNT + (size_t)k]);
  }
  f->Uniform4fv(f->GetUniformLocation(program, "u_map_place"), RASTER_MAP_COUNT,
                place[0]);
  f->Uniform4fv(f->GetUniformLocation(program, "u_map_channel"),
                RASTER_MAP_COUNT, channel[0]);
  raster_set1(r->g, program, "u_bump", m->map_bump.options.bump);
}

// Where the environment lies that the material sees.
static void set_gloss(const raster_stock *r, GLuint program, size_t which) {
  const gl_api *f = gl_functions(r->g);
  const raster_piece *from = &r->set.ambient;
  const material *m = &r->materials[which];
  int place[2] = {0, 0};
  if (from->level == NULL) return;
  float roughness = raster_roughness(raster_kind(&r->set, m), m);
  from->level(from->context, roughness, place);
  f->Uniform2i(f->GetUniformLocation(program, "u_gloss"), place[0], place[1]);
}

static void set_material(const raster_stock *r, GLuint program, size_t which) {
  const material *m = &r->materials[which];
  raster_set3(r->g, program, "u_kd", m->kd);
  raster_set3(r->g, program, "u_ks", m->ks);
  raster_set3(r->g, program, "u_ke", m->ke);
  raster_set3(r->g, program, "u_tf", m->tf);
  raster_set1(r->g, program, "u_ns", m->ns);
  raster_set1(r->g, program, "u_ni", m->ni);
  raster_set1(r->g, program, "u_d", m->passes ? m->d : 1);
  raster_set1(r->g, program, "u_roughness", m->roughness);
  raster_set1(r->g, program, "u_metallic", m->metallic);
  set_gloss(r, program, which);
  set_maps(r, program, which);
}

static void bind_piece(const raster_stock *r, GLuint program,
                       const raster_piece *piece, int unit) {
  if (piece->bind != NULL) piece->bind(piece->context, r->g, program, unit);
}

// The scale of what first.frag writes, and what is added.
static vec2 first_scale(const raster_stock *r, raster_shading shading,
                        bool as_mean) {
  if (as_mean || shading == RASTER_ALBEDO) return (vec2){1, 0};
  if (shading == RASTER_NORMAL) return (vec2){0.5f, 0.5f};
  return (vec2){1 / r->view.farthest, 0};
}

// Make the program of material `which` current, with all its uniforms.
static bool use_material(raster_stock *r, size_t which, raster_shading shading,
                         bool as_mean, error *err) {
  GLuint program;
  const material *m = &r->materials[which];
  raster_variant v = raster_variant_of(&r->set, m, shading);
  if (!raster_program_get(&program, &r->programs, v, err)) return false;
  gl_functions(r->g)->UseProgram(program);
  set_view(r, program);
  set_material(r, program, which);
  if (shading != RASTER_RADIANCE) {
    raster_set2(r->g, program, "u_first", first_scale(r, shading, as_mean));
    return true;
  }
  set_env(r, program);
  if (r->set.lights) set_lights(r, program);
  if (r->set.lights) set_shadows(r, program);
  bind_piece(r, program, &r->set.ambient, RASTER_AMBIENT_UNIT);
  if (v.kind == MATERIAL_METAL_ROUGH)
    bind_piece(r, program, &r->set.metal_rough, RASTER_METAL_ROUGH_UNIT);
  return true;
}

// Whether light goes straight through a material in this kind of picture.
static bool is_sheet(const raster_stock *r, size_t which,
                     raster_shading shading) {
  return shading == RASTER_RADIANCE && r->materials[which].passes;
}

static bool draw_solids(raster_stock *r, raster_shading shading, bool as_mean,
                        error *err) {
  const gl_api *f = gl_functions(r->g);
  f->BindVertexArray(r->mesh.vertices);
  for (size_t i = 0; i < r->mesh.part_count; i++) {
    const raster_part *part = &r->mesh.parts[i];
    if (part->count == 0 || r->hidden[i] || is_sheet(r, i, shading)) continue;
    if (!use_material(r, i, shading, as_mean, err)) return false;
    f->DrawArrays(GL_TRIANGLES, part->first, part->count);
  }
  return true;
}

// From far to near, each over what is there already; runs of one material in
// one call.  They leave no depth.
static bool draw_sheets(raster_stock *r, error *err) {
  const gl_api *f = gl_functions(r->g);
  const raster_mesh *m = &r->mesh;
  if (m->sheet_count == 0) return true;
  raster_mesh_sort(&r->mesh, r->g, r->view.eye, r->view.forward);
  f->Enable(GL_BLEND);
  f->BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  f->DepthMask(GL_FALSE);
  bool ok = true;
  for (size_t i = 0, end; i < m->sheet_count && ok; i = end) {
    uint32_t of = m->sheets[i].material;
    for (end = i; end < m->sheet_count && m->sheets[end].material == of;)
      end++;
    if (r->hidden[of]) continue;
    ok = use_material(r, of, RASTER_RADIANCE, false, err);
    if (ok)
      f->DrawElements(GL_TRIANGLES, (GLsizei)(3 * (end - i)), GL_UNSIGNED_INT,
                      (const void *)(uintptr_t)(3 * i * sizeof(uint32_t)));
  }
  f->Disable(GL_BLEND);
  f->DepthMask(GL_TRUE);
  return ok;
}

static bool draw_sky(raster_stock *r, error *err) {
  const gl_api *f = gl_functions(r->g);
  GLuint program;
  raster_variant v = {.stage = RASTER_STAGE_SKY};
  if (!raster_program_get(&program, &r->programs, v, err)) return false;
  f->UseProgram(program);
  set_view(r, program);
  set_env(r, program);
  f->BindVertexArray(r->no_vertices);
  f->DrawArrays(GL_TRIANGLES, 0, 3);
  return true;
}

// Solid parts into the layer whose view is in force.
static bool draw_casters(raster_stock *r, const raster_matrix *clip,
                         error *err) {
  const gl_api *f = gl_functions(r->g);
  for (size_t i = 0; i < r->mesh.part_count; i++) {
    const raster_part *part = &r->mesh.parts[i];
    if (part->count == 0 || r->hidden[i]) continue;
    bool sheet = r->materials[i].passes;
    raster_variant v = {.stage = RASTER_STAGE_SHADOW};
    if (sheet) {
      v = raster_variant_of(&r->set, &r->materials[i], RASTER_RADIANCE);
      v.stage = RASTER_STAGE_SHADOW_SHEET;
    }
    GLuint program;
    if (!raster_program_get(&program, &r->programs, v, err)) return false;
    f->UseProgram(program);
    f->UniformMatrix4fv(f->GetUniformLocation(program, "u_clip"), 1, GL_FALSE,
                        clip->m);
    if (sheet) set_material(r, program, i);
    f->DrawArrays(GL_TRIANGLES, part->first, part->count);
  }
  return true;
}

static void begin_depth(const raster_stock *r) {
  const gl_api *f = gl_functions(r->g);
  if (r->space.reversed) f->ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  f->Enable(GL_DEPTH_TEST);
  f->DepthFunc(r->space.reversed ? GL_GEQUAL : GL_LEQUAL);
  f->DepthMask(GL_TRUE);
}

bool raster_pass_shadows(raster_stock *r, error *err) {
  const gl_api *f = gl_functions(r->g);
  begin_depth(r);
  f->BindVertexArray(r->mesh.vertices);
  for (size_t layer = 0; layer < r->shadow.layers; layer++) {
    raster_shadow_begin(r->g, &r->shadow, layer, r->space.reversed);
    if (!draw_casters(r, &r->shadow.clip[layer], err)) return false;
  }
  return true;
}

bool raster_pass_frame(raster_stock *r, raster_shading shading, bool as_mean,
                       error *err) {
  const gl_api *f = gl_functions(r->g);
  float empty = shading == RASTER_DEPTH && !as_mean ? 1 : 0;
  begin_depth(r);
  f->BindFramebuffer(GL_FRAMEBUFFER, r->target.draw);
  f->Viewport(0, 0, r->target.width, r->target.height);
  f->ClearColor(empty, empty, empty, 0);
  f->ClearDepth(r->space.reversed ? 0 : 1);
  f->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  bool ok = draw_solids(r, shading, as_mean, err);
  if (ok && shading == RASTER_RADIANCE) {
    if (r->set.sky && r->scene->env.kind != ENV_NONE) ok = draw_sky(r, err);
    ok = ok && draw_sheets(r, err);
  }
  gl_target_resolve(r->g, &r->target);
  return ok;
}
