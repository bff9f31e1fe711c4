// scene_digest.c

#include "scene_digest.h"

#include "digest.h"

// n objects without padding.
#define ADD(d, objects, n) \
  ((d) = digest_add((d), (objects), (n) * sizeof *(objects)))

// An array that may not be there.
static uint64_t add_optional(uint64_t d, const void *array, size_t bytes) {
  return array == NULL ? digest_add(d, "", 1) : digest_add(d, array, bytes);
}

static uint64_t digest_geometry(const scene *s) {
  const mesh *m = &s->mesh;
  size_t corners = 3 * m->triangle_count;
  uint64_t d = DIGEST_START;
  ADD(d, m->positions, m->position_count);
  d = add_optional(d, m->colors, m->position_count * sizeof *m->colors);
  d = add_optional(d, m->normals, m->normal_count * sizeof *m->normals);
  d = add_optional(d, m->texcoords, m->texcoord_count * sizeof *m->texcoords);
  ADD(d, m->position_index, corners);
  d = add_optional(d, m->normal_index, corners * sizeof *m->normal_index);
  d = add_optional(d, m->texcoord_index, corners * sizeof *m->texcoord_index);
  return ADD(d, s->material_of, m->triangle_count);
}

// The textures of a material.
static void maps_of(const material *m, const texture_map *out[MATERIAL_MAPS]) {
  const texture_map *all[MATERIAL_MAPS] = {
      &m->map_kd, &m->map_ks, &m->map_ke,   &m->map_ns,  &m->map_d,
      &m->map_pr, &m->map_pm, &m->map_bump, &m->map_norm};
  for (int i = 0; i < MATERIAL_MAPS; i++)
    out[i] = all[i];
}

// How a texture is looked up.
static uint64_t add_map(uint64_t d, const texture_map *t) {
  const mtl_map *o = &t->options;
  int flags[4] = {t->image != NULL, t->is_color, o->clamp, o->channel};
  float numbers[7] = {o->scale.x,  o->scale.y,  o->scale.z, o->offset.x,
                      o->offset.y, o->offset.z, o->bump};
  if (t->image == NULL) return ADD(d, flags, 1);
  ADD(d, flags, 4);
  return ADD(d, numbers, 7);
}

static uint64_t add_material(uint64_t d, const material *m) {
  const texture_map *maps[MATERIAL_MAPS];
  int flags[2] = {(int)m->kind, m->passes};
  vec3 colors[4] = {m->kd, m->ks, m->ke, m->tf};
  float numbers[5] = {m->ns, m->ni, m->d, m->roughness, m->metallic};
  ADD(d, flags, 2);
  ADD(d, colors, 4);
  ADD(d, numbers, 5);
  maps_of(m, maps);
  for (int i = 0; i < MATERIAL_MAPS; i++)
    d = add_map(d, maps[i]);
  return d;
}

static uint64_t digest_texture(const texture *t) {
  size_t n = (size_t)t->width * (size_t)t->height * (size_t)t->channels;
  int facts[4] = {t->width, t->height, t->channels, t->is_linear};
  uint64_t d = digest_add(DIGEST_START, facts, sizeof facts);
  d = add_optional(d, t->bytes, n);
  return add_optional(d, t->floats, n * sizeof *t->floats);
}

// Each picture by its texels, in the order in which materials use them: where
// a file lies, and in which order files were read, does not matter.
static uint64_t digest_textures(const scene *s) {
  arena scratch = {0};
  const texture_store *store = &s->textures;
  uint64_t d = DIGEST_START,
           *each = ARENA_NEW(&scratch, uint64_t, store->count);
  for (size_t i = 0; i < store->count; i++)
    if (store->textures[i]->problem == NULL)
      each[i] = digest_texture(store->textures[i]);
  for (size_t i = 0; i < s->material_count; i++) {
    const texture_map *maps[MATERIAL_MAPS];
    maps_of(&s->materials[i], maps);
    for (int k = 0; k < MATERIAL_MAPS; k++)
      for (size_t t = 0; t < store->count; t++)
        if (maps[k]->image == store->textures[t]) ADD(d, &each[t], 1);
  }
  arena_free(&scratch);
  return d;
}

static uint64_t digest_lights(const scene *s) {
  uint64_t d = DIGEST_START;
  for (size_t i = 0; i < s->light_count; i++) {
    int kind = (int)s->lights[i].kind;
    vec3 numbers[2] = {s->lights[i].at, s->lights[i].power};
    ADD(d, &kind, 1);
    ADD(d, numbers, 2);
  }
  return d;
}

static uint64_t digest_environment(const env *e) {
  int facts[3] = {(int)e->kind, e->map.width, e->map.height};
  float numbers[5] = {e->constant.x, e->constant.y, e->constant.z, e->rotate,
                      e->scale};
  uint64_t d = digest_add(DIGEST_START, facts, sizeof facts);
  ADD(d, numbers, 5);
  size_t texels = (size_t)e->map.width * (size_t)e->map.height;
  return add_optional(d, e->map.pixels, texels * sizeof *e->map.pixels);
}

static uint64_t digest_camera(const camera_view *v) {
  vec3 all[5] = {v->eye, v->corner, v->right, v->down, v->forward};
  return digest_add(DIGEST_START, all, sizeof all);
}

scene_digest scene_digest_of(const scene *s, const camera_view *view) {
  uint64_t materials = DIGEST_START;
  for (size_t i = 0; i < s->material_count; i++)
    materials = add_material(materials, &s->materials[i]);
  return (scene_digest){.geometry = digest_geometry(s),
                        .materials = materials,
                        .textures = digest_textures(s),
                        .lights = digest_lights(s),
                        .environment = digest_environment(&s->env),
                        .camera = digest_camera(view)};
}
