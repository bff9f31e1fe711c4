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
  return fminf(fmaxf(d, 0), 1);
}

vec3 matter_emission(const surface *s) {
  const material *m = material_at(s);
  if (!(vec3_peak(m->ke) > 0)) return vec3_all(0);
  return textured(m->ke, &m->map_ke, s->uv);
}

vec3 matter_albedo(const surface *s) {
  const material *m = material_at(s);
  if (m->kind == MATERIAL_GLASS) return vec3_all(1);
  if (m->kind == MATERIAL_MIRROR) return textured(m->ks, &m->map_ks, s->uv);
  return base_color(s);
}

static matter whole(bsdf b) {
  return (matter){b, vec3_all(1)};
}

// Index of refraction inside over outside; what is no index means none.
static bsdf glass_of(float ni, vec3 tint) {
  float eta = ni > 0 ? ni : 1;
  return (bsdf){.kind = BSDF_GLASS, .kd = tint, .eta = eta};
}

// The first of two layers with probability p, where `first` is its share of
// the light; *u is stretched to be uniform again.
static bool take_first(float p, vec3 first, float *u, vec3 *weight) {
  if (*u < p) {
    *u /= p;
    *weight = vec3_mul(*weight, vec3_scale(first, 1 / p));
    return true;
  }
  *u = (*u - p) / (1 - p);
  vec3 rest = vec3_sub(vec3_all(1), first);
  *weight = vec3_mul(*weight, vec3_scale(rest, 1 / (1 - p)));
  return false;
}

// Above this exponent a highlight is narrower than the rounding of a half
// vector: the surface is a mirror.
#define SMOOTH_EXPONENT 1e8f

// A coat that mirrors by Schlick over a Lambert ground that gets the rest.
static matter smooth_coat(vec3 f0, vec3 kd, float cos_o, float u) {
  vec3 coat = fresnel_schlick(f0, cos_o);
  matter m = {.weight = vec3_all(1)};
  float p = vec3_peak(kd) > 0 ? fminf(vec3_peak(coat), 1) : 1;
  if (take_first(p, coat, &u, &m.weight))
    m.bsdf = (bsdf){.kind = BSDF_MIRROR, .ks = vec3_all(1)};
  else
    m.bsdf = (bsdf){.kind = BSDF_LAMBERT, .kd = kd};
  return m;
}

// Metallic-roughness told in the lobes of this chapter: alpha = r^2, the
// Blinn-Phong exponent of the same width, n = 2 / alpha^2 - 2; specular F0,
// diffuse (1 - m)(1 - F0) c, so that no more than 1 leaves; the share tf is
// smooth glass, stained by the square root of c at each of two crossings.
static matter metal_rough(const surface *s, float cos_o, float u) {
  const material *m = material_at(s);
  vec3 c = base_color(s), weight = vec3_all(1);
  float share = fminf(vec3_peak(m->tf), 1);
  if (share > 0 && take_first(share, m->tf, &u, &weight)) {
    vec3 tint = {sqrtf(c.x), sqrtf(c.y), sqrtf(c.z)};
    return (matter){glass_of(m->ni, tint), weight};
  }
  float rough = textured_number(m->roughness, &m->map_pr, s->uv);
  float metal = textured_number(m->metallic, &m->map_pm, s->uv);
  vec3 f0 = vec3_lerp(vec3_all(0.04f), c, metal);
  vec3 kd = vec3_scale(c, 1 - metal);
  float a2 = rough * rough * rough * rough;
  float ns = 2 / a2 - 2;
  if (!(ns < SMOOTH_EXPONENT)) {
    matter out = smooth_coat(f0, kd, cos_o, u);
    out.weight = vec3_mul(out.weight, weight);
    return out;
  }
  kd = vec3_mul(kd, vec3_sub(vec3_all(1), f0));
  bsdf b = {.kind = BSDF_BLINN_PHONG, .kd = kd, .ks = f0, .ns = fmaxf(ns, 0)};
  return (matter){b, weight};
}

// Files say Kd 0.8 and Ks 0.5 of one surface, which would return 130 % of the
// light: both are scaled down to a sum of at most 1.
static matter blinn_phong(const surface *s) {
  const material *m = material_at(s);
  vec3 kd = base_color(s), ks = textured(m->ks, &m->map_ks, s->uv);
  float down = 1 / fmaxf(1, vec3_peak(vec3_add(kd, ks)));
  bsdf b = {.kind = BSDF_LAMBERT, .kd = vec3_scale(kd, down)};
  if (!(vec3_peak(ks) > 0)) return whole(b);
  b.kind = BSDF_BLINN_PHONG;
  b.ks = vec3_scale(ks, down);
  b.ns = m->ns;
  if (m->map_ns.image != NULL) b.ns *= texture_number(&m->map_ns, s->uv);
  return whole(b);
}

matter matter_choose(const surface *s, float cos_o, float u) {
  const material *m = material_at(s);
  switch (m->kind) {
  case MATERIAL_METAL_ROUGH: return metal_rough(s, cos_o, u);
  case MATERIAL_GLASS: return whole(glass_of(m->ni, vec3_all(1)));
  case MATERIAL_MIRROR:
    return whole(
        (bsdf){.kind = BSDF_MIRROR, .ks = textured(m->ks, &m->map_ks, s->uv)});
  case MATERIAL_BLINN_PHONG: break;
  }
  return blinn_phong(s);
}
