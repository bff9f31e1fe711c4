// matter.c

#include "matter.h"

static vec3 textured(vec3 factor, const texture_map *map, vec2 uv) {
  return map->image == NULL ? factor : vec3_mul(factor, texture_rgb(map, uv));
}

// A texture of numbers stands in for the number.
static float textured_number(float number, const texture_map *map, vec2 uv) {
  return map->image == NULL ? number : texture_number(map, uv);
}

// A surface without any material is grey.
static const material *material_at(const surface *s) {
  static const material grey = {.kd = {0.8f, 0.8f, 0.8f}, .d = 1};
  return s->material == NULL ? &grey : s->material;
}

static vec3 base_color(const surface *s) {
  const material *m = material_at(s);
  return vec3_mul(textured(m->kd, &m->map_kd, s->uv), s->color);
}

bool matter_passes(const surface *s) {
  return material_at(s)->passes;
}

float matter_opacity(const surface *s) {
  const material *m = material_at(s);
  float d = m->d;
  if (m->map_d.image != NULL) d *= texture_alpha(&m->map_d, s->uv);
  return float_min(float_max(d, 0), 1);
}

vec3 matter_emission(const surface *s) {
  const material *m = material_at(s);
  if (!(vec3_peak(m->ke) > 0)) return vec3_all(0);
  return textured(m->ke, &m->map_ke, s->uv);
}

bool matter_matt(const surface *s) {
  const material *m = material_at(s);
  return m->kind == MATERIAL_BLINN_PHONG && !(vec3_peak(m->ks) > 0) &&
         m->map_ks.image == NULL;
}

vec3 matter_albedo(const surface *s) {
  const material *m = material_at(s);
  if (m->kind == MATERIAL_GLASS) return vec3_all(1);
  if (m->kind == MATERIAL_MIRROR) return textured(m->ks, &m->map_ks, s->uv);
  return base_color(s);
}

const dfg *matter_table(const scene *s, pbr_model model, arena *mem,
                        pool *threads) {
  for (size_t i = 0; i < s->material_count; i++) {
    if (s->materials[i].kind != MATERIAL_METAL_ROUGH) continue;
    dfg *table = ARENA_NEW(mem, dfg, 1);
    dfg_build(table, model, mem, threads);
    return table;
  }
  return NULL;
}

const dfg *matter_table_as_is(const scene *s, pbr_model model, arena *mem,
                              pool *threads) {
  arena scratch = {0};
  float *list = ARENA_NEW(&scratch, float, s->material_count);
  dfg_need need = {model, list, 0};
  bool textured = false;
  for (size_t i = 0; i < s->material_count; i++) {
    const material *m = &s->materials[i];
    if (m->kind != MATERIAL_METAL_ROUGH) continue;
    list[need.count++] = m->roughness;
    textured |= m->map_pr.image != NULL;
  }
  dfg *table = NULL;
  if (need.count > 0) table = ARENA_NEW(mem, dfg, 1);
  if (textured)
    dfg_build(table, model, mem, threads);
  else if (need.count > 0)
    dfg_build_for(table, need, mem, threads);
  arena_free(&scratch);
  return table;
}

static matter whole(bsdf b) {
  return (matter){b, vec3_all(1)};
}

// Index of refraction inside over outside; what is no index means none.
static bsdf glass_of(float ni, vec3 tint) {
  float eta = ni > 0 ? ni : 1;
  return (bsdf){.kind = BSDF_GLASS, .kd = tint, .eta = eta};
}

// Two layers: what each does with the light, and the probability of the first.
typedef struct layers {
  vec3 first, second;
  float p;
} layers;

// Choose one.  *u is stretched to be uniform again, and *weight grows by the
// chosen layer's share over its probability.
static bool take_first(const layers *l, float *u, vec3 *weight) {
  bool first = *u < l->p;
  float p = first ? l->p : 1 - l->p;
  *u = first ? *u / p : (*u - l->p) / p;
  *weight = vec3_mul(*weight, vec3_scale(first ? l->first : l->second, 1 / p));
  return first;
}

// Metallic-roughness.  The share tf is smooth glass, stained by the square
// root of c at each of two crossings.  A smooth surface is a mirror over the
// diffuse part, which knows itself what the mirror leaves it.
static matter metal_rough(const dfg *table, const surface *s, float cos_o,
                          float u) {
  const material *m = material_at(s);
  vec3 c = base_color(s), weight = vec3_all(1);
  layers glass = {m->tf, vec3_sub(vec3_all(1), m->tf), 0};
  glass.p = float_min(vec3_peak(m->tf), 1);
  if (glass.p > 0 && take_first(&glass, &u, &weight)) {
    vec3 tint = {sqrtf(c.x), sqrtf(c.y), sqrtf(c.z)};
    return (matter){glass_of(m->ni, tint), weight};
  }
  float rough = textured_number(m->roughness, &m->map_pr, s->uv);
  float metal = textured_number(m->metallic, &m->map_pm, s->uv);
  bsdf b = {.kind = BSDF_ROUGH};
  b.rough = bsdf_rough_of(table, c, metal, rough);
  if (b.rough.terms.alpha >= ALPHA_MIN) return (matter){b, weight};
  vec3 coat = fresnel_schlick(b.rough.terms.f0, cos_o);
  bool ground = vec3_peak(b.rough.terms.kd) > 0;
  layers smooth = {coat, vec3_all(1),
                   ground ? float_min(vec3_peak(coat), 1) : 1};
  if (take_first(&smooth, &u, &weight))
    b = (bsdf){.kind = BSDF_MIRROR, .ks = vec3_all(1)};
  return (matter){b, weight};
}

// Files say Kd 0.8 and Ks 0.5 of one surface, which would return 130 % of the
// light: both are scaled down to a sum of at most 1.
static matter blinn_phong(const surface *s) {
  const material *m = material_at(s);
  vec3 kd = base_color(s), ks = textured(m->ks, &m->map_ks, s->uv);
  float down = 1 / float_max(1, vec3_peak(vec3_add(kd, ks)));
  bsdf b = {.kind = BSDF_LAMBERT, .kd = vec3_scale(kd, down)};
  if (!(vec3_peak(ks) > 0)) return whole(b);
  b.kind = BSDF_BLINN_PHONG;
  b.ks = vec3_scale(ks, down);
  b.ns = m->ns;
  if (m->map_ns.image != NULL) b.ns *= texture_number(&m->map_ns, s->uv);
  return whole(b);
}

matter matter_choose(const dfg *table, const surface *s, float cos_o, float u) {
  const material *m = material_at(s);
  switch (m->kind) {
  case MATERIAL_METAL_ROUGH: return metal_rough(table, s, cos_o, u);
  case MATERIAL_GLASS: return whole(glass_of(m->ni, vec3_all(1)));
  case MATERIAL_MIRROR:
    return whole(
        (bsdf){.kind = BSDF_MIRROR, .ks = textured(m->ks, &m->map_ks, s->uv)});
  case MATERIAL_BLINN_PHONG: break;
  }
  return blinn_phong(s);
}
