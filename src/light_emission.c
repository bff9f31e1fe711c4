// light_emission.c

#include "light_emission.h"

#include "matter.h"

// A triangle with a texture is measured at the middles of this many parts,
// squared.
enum { MEASURE_CUTS = 8 };

float light_mean(vec3 c) {
  return c.x / 3 + c.y / 3 + c.z / 3;
}

static vec3 corner(const mesh *m, uint32_t triangle, int i) {
  return m->positions[m->position_index[3 * (size_t)triangle + (size_t)i]];
}

static const material *material_of(const scene *s, uint32_t triangle) {
  if (s->material_of == NULL || s->materials == NULL) return NULL;
  return &s->materials[s->material_of[triangle]];
}

vec3 light_emission(const scene *s, uint32_t triangle, float b, float c) {
  hit h = {.triangle = triangle, .b1 = b, .b2 = c};
  surface at = {.uv = scene_uv(s, &h), .material = material_of(s, triangle)};
  vec3 glow = matter_emission(&at);
  return matter_passes(&at) ? vec3_scale(glow, matter_opacity(&at)) : glow;
}

// The mean over the triangle.
static float mean_emission(const scene *s, uint32_t triangle) {
  const material *m = material_of(s, triangle);
  if (m->map_ke.image == NULL && m->map_d.image == NULL)
    return light_mean(light_emission(s, triangle, 0, 0));
  float sum = 0;
  const float cut = 1.0f / MEASURE_CUTS;
  for (int i = 0; i < MEASURE_CUTS; i++)
    for (int j = 0; i + j < MEASURE_CUTS; j++) {
      float b = ((float)i + 1.0f / 3) * cut, c = ((float)j + 1.0f / 3) * cut;
      sum += light_mean(light_emission(s, triangle, b, c));
      if (i + j + 2 > MEASURE_CUTS) continue;
      sum += light_mean(light_emission(s, triangle, b + cut / 3, c + cut / 3));
    }
  return sum * cut * cut;
}

static bool shines(const scene *s, uint32_t triangle) {
  const material *m = material_of(s, triangle);
  return m != NULL && vec3_peak(m->ke) > 0;
}

static bool triangle_emitter(light_emitter *out, const scene *s,
                             uint32_t triangle) {
  const mesh *m = &s->mesh;
  *out = (light_emitter){.source = triangle};
  if (!light_triangle_of(&out->shape, corner(m, triangle, 0),
                         corner(m, triangle, 1), corner(m, triangle, 2)))
    return false;
  out->power = mean_emission(s, triangle) * out->shape.area;
  return out->power > 0 && out->power < INFINITY;
}

static bool point_emitter(light_emitter *out, const scene *s, uint32_t i) {
  const light *l = &s->lights[i];
  *out = (light_emitter){.is_point = true, .source = i};
  out->shape.a = out->shape.middle = l->at;
  out->power = light_mean(l->power);
  return l->kind == LIGHT_POINT && vec3_finite(l->at) && out->power > 0 &&
         out->power < INFINITY;
}

// Grows the array by one.
typedef struct emitter_list {
  light_emitter *items;
  size_t room;
  uint32_t count;
} emitter_list;

static void append(emitter_list *l, light_emitter e) {
  l->items = array_grow(l->items, &l->room, (size_t)l->count + 1, sizeof e);
  l->items[l->count++] = e;
}

light_emitter *light_emitters(const scene *s, bool points, uint32_t *count) {
  emitter_list list = {0};
  light_emitter e;
  for (uint32_t i = 0; i < s->mesh.triangle_count; i++)
    if (shines(s, i) && triangle_emitter(&e, s, i)) append(&list, e);
  for (uint32_t i = 0; points && i < s->light_count; i++)
    if (point_emitter(&e, s, i)) append(&list, e);
  *count = list.count;
  return list.items;
}
