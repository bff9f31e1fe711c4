// raster_stock.c

#include "raster_stock.h"

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

void raster_set_env(const raster_stock *r, GLuint program) {
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

void raster_set_view(const raster_stock *r, GLuint program) {
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

void raster_set_material(const raster_stock *r, GLuint program, size_t which) {
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
  raster_gloss_place place = raster_gloss_place_of(&r->set, m);
  const gl_api *f = gl_functions(r->g);
  f->Uniform2i(f->GetUniformLocation(program, "u_gloss"), place.first,
               place.width);
  set_maps(r, program, which);
}

size_t raster_draw_part(const raster_stock *r, size_t of,
                        const raster_frustum *view, GLint number) {
  const gl_api *f = gl_functions(r->g);
  arena once = {0};
  size_t calls, vertices = 0;
  const raster_part *part = raster_mesh_in(&r->mesh, of, view, &once, &calls);
  for (size_t i = 0; i < calls; i++) {
    if (number >= 0) f->Uniform1i(number, part[i].first / 3);
    f->DrawArrays(GL_TRIANGLES, part[i].first, part[i].count);
    vertices += (size_t)part[i].count;
  }
  arena_free(&once);
  return vertices / 3;
}

static void bind_piece(const raster_stock *r, GLuint program,
                       const raster_piece *piece, int unit) {
  if (piece->bind != NULL) piece->bind(piece->context, r->g, program, unit);
}

void raster_set_light(const raster_stock *r, GLuint program,
                      material_kind kind) {
  raster_set_env(r, program);
  if (r->set.lights) set_lights(r, program);
  if (r->set.lights) set_shadows(r, program);
  bind_piece(r, program, &r->set.ambient, RASTER_AMBIENT_UNIT);
  if (kind == MATERIAL_METAL_ROUGH)
    bind_piece(r, program, &r->set.metal_rough, RASTER_METAL_ROUGH_UNIT);
}
