// bsdf_rough.c

#include "bsdf_rough.h"

#include "num.h"

bsdf_rough bsdf_rough_of(const dfg *table, vec3 c, float metallic,
                         float roughness) {
  bsdf_rough b = {.roughness = roughness, .table = table};
  b.terms.model = table->model;
  b.terms.f0 = metal_rough_f0(c, metallic);
  b.terms.kd = vec3_scale(c, 1 - metallic);
  b.terms.alpha = roughness * roughness;
  b.terms.k = schlick_k_env(roughness);
  dfg_pair mean = dfg_lookup_mean(table, roughness);
  b.terms.e_mean = DIELECTRIC_F0 * mean.c1 + mean.c2;
  return b;
}

bsdf_rough bsdf_rough_under_point(const bsdf_rough *b) {
  bsdf_rough p = *b;
  p.terms.k = schlick_k_point(b->roughness);
  return p;
}

// The specular albedo of a surface of that F0 seen at cosine c.
static float albedo_at(const bsdf_rough *b, float f0, float c) {
  dfg_pair e = dfg_lookup(b->table, c, b->roughness);
  return f0 * e.c1 + e.c2;
}

static bool has_diffuse(const bsdf_rough *b) {
  return vec3_peak(b->terms.kd) > 0;
}

// The probability of the specular lobe: its share of the expected albedo.
static float lobe_share(const bsdf_rough *b, vec3 wo) {
  if (!(b->terms.alpha >= ALPHA_MIN)) return 0;
  if (!has_diffuse(b)) return 1;
  vec3 f0 = b->terms.f0, kd = b->terms.kd;
  float specular = albedo_at(b, (f0.x + f0.y + f0.z) / 3, wo.z);
  float rest = 1 - albedo_at(b, DIELECTRIC_F0, wo.z);
  float diffuse = (kd.x + kd.y + kd.z) / 3 * float_max(rest, 0);
  return specular / (specular + diffuse);
}

static vec3 diffuse_at(const bsdf_rough *b, half_angles a) {
  if (!has_diffuse(b)) return vec3_all(0);
  float e_l = albedo_at(b, DIELECTRIC_F0, a.nl);
  float e_v = albedo_at(b, DIELECTRIC_F0, a.nv);
  return rough_diffuse(&b->terms, a, e_l, e_v);
}

static const vec3 UP = {0, 0, 1};

vec3 bsdf_rough_eval(const bsdf_rough *b, vec3 wo, vec3 wi) {
  if (!(wo.z > 0 && wi.z > 0)) return vec3_all(0);
  half_angles a = half_angles_of(UP, wo, wi);
  return vec3_add(diffuse_at(b, a), rough_specular(&b->terms, a));
}

// The density of wo mirrored in a visible normal.  The wo.h of that normal's
// density and the 4 wo.h by which mirroring stretches solid angle cancel, and
// G1 / wo.z has no division by wo.z.
static float visible_pdf(const rough_terms *s, half_angles a) {
  return ggx_d(a.t, a.nh, s->alpha) * ggx_g1_over_4nv(a.nv, s->alpha);
}

float bsdf_rough_pdf(const bsdf_rough *b, vec3 wo, vec3 wi) {
  if (!(wo.z > 0 && wi.z > 0)) return 0;
  half_angles a = half_angles_of(UP, wo, wi);
  float p = lobe_share(b, wo);
  return p * visible_pdf(&b->terms, a) + (1 - p) * wi.z / PI;
}

// Stretched by 1 / alpha the surface is a hemisphere, whose visible half is a
// disc as seen from wo: half of it in full, half of it foreshortened.
// Source: Heitz 2018, listing 1.
vec3 ggx_visible_normal(vec3 wo, float alpha, float u1, float u2) {
  vec3 v = vec3_unit((vec3){alpha * wo.x, alpha * wo.y, wo.z});
  float side = sqrtf(v.x * v.x + v.y * v.y);
  vec3 t = {1, 0, 0};
  if (side > 0) t = (vec3){-v.y / side, v.x / side, 0};
  vec3 b = vec3_cross(v, t);
  vec2 circle = num_circle(u2);
  float r = sqrtf(u1), x = r * circle.x, share = 0.5f * (1 + v.z);
  float y = (1 - share) * sqrtf(float_max(0, 1 - x * x)) + share * r * circle.y;
  float z = sqrtf(float_max(0, 1 - x * x - y * y));
  vec3 n = vec3_mad(vec3_mad(vec3_scale(t, x), y, b), z, v);
  return vec3_unit((vec3){alpha * n.x, alpha * n.y, float_max(n.z, 0)});
}

// f wi.z / pdf.  D, the one factor that may be huge and inexact, is in both
// parts of the quotient: for the specular lobe alone it is F V wi.z 4 wo.z /
// G1, at most 1.
static vec3 weight_of(const bsdf_rough *b, half_angles a, float share) {
  float d = visible_pdf(&b->terms, a);
  float pdf = share * d + (1 - share) * a.nl / PI;
  if (!(pdf > 0)) return vec3_all(0);
  float g1 = ggx_g1_over_4nv(a.nv, b->terms.alpha);
  vec3 f = fresnel_schlick(b->terms.f0, a.oh);
  vec3 specular = vec3_scale(f, rough_v(&b->terms, a) * a.nl / g1);
  if (share >= 1) return specular;
  vec3 diffuse = vec3_scale(diffuse_at(b, a), a.nl / pdf);
  return vec3_mad(diffuse, d / pdf, specular);
}

bool bsdf_rough_sample(const bsdf_rough *b, vec3 wo, const float u[3], vec3 *wi,
                       vec3 *weight) {
  if (!(wo.z > 0)) return false;
  float share = lobe_share(b, wo);
  if (u[0] < share) {
    vec3 h = ggx_visible_normal(wo, b->terms.alpha, u[1], u[2]);
    *wi = vec3_sub(vec3_scale(h, 2 * vec3_dot(wo, h)), wo);
  } else {
    vec2 c = num_circle(u[1]);
    float r = sqrtf(u[2]);
    *wi = (vec3){r * c.x, r * c.y, sqrtf(1 - u[2])};
  }
  if (!(wi->z > 0)) return false;
  *weight = weight_of(b, half_angles_of(UP, wo, *wi), share);
  return vec3_peak(*weight) > 0;
}
