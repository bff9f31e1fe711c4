// microfacet.c

#include "microfacet.h"

half_angles half_angles_of(vec3 n, vec3 wo, vec3 wi) {
  vec3 sum = vec3_add(wo, wi), h = vec3_unit(sum);
  half_angles a = {.nl = vec3_dot(n, wi), .nv = vec3_dot(n, wo)};
  if (!(vec3_length(h) > 0.5f)) h = n;
  vec3 across = vec3_cross(n, h);
  a.nh = vec3_dot(n, h);
  a.t = vec3_dot(across, across);
  a.oh = float_min(0.5f * vec3_length(sum), 1);
  return a;
}

// The usual form, nh^2 (alpha^2 - 1) + 1 in place of t + alpha^2 nh^2, is a
// difference of two numbers near 1.
float ggx_d(float t, float nh, float alpha) {
  if (!(alpha >= ALPHA_MIN)) return 0;
  float a = alpha * nh;
  float s = alpha / (t + a * a);
  return s * s / PI;
}

// The square root in Smith's formula: cos^2 + alpha^2 sin^2, as a sum of
// positive terms.
static float smith_root(float c, float alpha) {
  return sqrtf(c * c * (1 - alpha) * (1 + alpha) + alpha * alpha);
}

// A denominator of V below this belongs to two directions at grazing incidence
// at once, and to a mirror: V would be infinite, and no light arrives.
#define V_DENOMINATOR_MIN 1e-20f

float ggx_v(float nl, float nv, float alpha) {
  float sum = nl * smith_root(nv, alpha) + nv * smith_root(nl, alpha);
  return 0.5f / float_max(sum, V_DENOMINATOR_MIN);
}

float ggx_g1_over_4nv(float nv, float alpha) {
  return 0.5f / float_max(nv + smith_root(nv, alpha), V_DENOMINATOR_MIN);
}

float schlick_v(float nl, float nv, float k) {
  float product = (nl * (1 - k) + k) * (nv * (1 - k) + k);
  return 0.25f / float_max(product, V_DENOMINATOR_MIN);
}

float schlick_k_point(float roughness) {
  return (roughness + 1) * (roughness + 1) * 0.125f;
}

float schlick_k_env(float roughness) {
  return roughness * roughness * 0.5f;
}

vec3 fresnel_schlick(vec3 f0, float oh) {
  float m = 1 - oh, m2 = m * m;
  return vec3_lerp(f0, vec3_all(1), m2 * m2 * m);
}

vec3 metal_rough_f0(vec3 c, float metallic) {
  return vec3_lerp(vec3_all(DIELECTRIC_F0), c, metallic);
}

float rough_v(const rough_terms *s, half_angles a) {
  if (s->model == PBR_GGX) return ggx_v(a.nl, a.nv, s->alpha);
  return schlick_v(a.nl, a.nv, s->k);
}

vec3 rough_specular(const rough_terms *s, half_angles a) {
  float dv = ggx_d(a.t, a.nh, s->alpha) * rough_v(s, a);
  return vec3_scale(fresnel_schlick(s->f0, a.oh), dv);
}

// PBR_GGX: the share that passes the coat on its way in, times that on its way
// out, over the mean of it, so that light which is not reflected by the coat
// comes back by the ground.  Source: Kelemen and Szirmay-Kalos 2001.
vec3 rough_diffuse(const rough_terms *s, half_angles a, float e_l, float e_v) {
  if (s->model == PBR_GGX) {
    float share = (1 - e_l) * (1 - e_v) / (1 - s->e_mean);
    return vec3_scale(s->kd, share / PI);
  }
  vec3 passed = vec3_sub(vec3_all(1), fresnel_schlick(s->f0, a.oh));
  return vec3_scale(vec3_mul(s->kd, passed), 1 / PI);
}
