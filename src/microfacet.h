// microfacet.h — the terms of a rough surface made of tiny mirrors, for both
// sets of formulas.  shaders/microfacet.glsl has the same functions by the
// same names.
//
// nl, nv, nh: cosines of light, viewer and half vector to the normal; oh: of
// viewer (or light) to the half vector.

#ifndef MICROFACET_H
#define MICROFACET_H

#include "vec.h"

// PBR_GGX: Smith's exact shadowing, and a diffuse part that gets what the
// specular one leaves.  PBR_REPORT: the formulas of the course report that
// facet grew from.
typedef enum pbr_model { PBR_GGX, PBR_REPORT } pbr_model;

// Below this alpha, roughness 0.001, a surface is a mirror: its lobe is no
// wider than the rounding of a few coordinates of unit vectors, 6e-8 each.
#define ALPHA_MIN 1e-6f

// What a half vector knows about a pair of directions.
typedef struct half_angles {
  float nl, nv, nh, oh;
  float t;  // |n x h|^2, the squared sine: keeps its digits where nh is near 1
} half_angles;

// For unit n, wo and wi.  Opposite directions, which have no half vector, get
// that of n.
half_angles half_angles_of(vec3 n, vec3 wo, vec3 wi);

// The density of facet normals: D nh integrates to 1 over the hemisphere.
// alpha = roughness^2; 0 below ALPHA_MIN.  Source: Trowbridge and Reitz 1975;
// Walter et al. 2007, eq. 33.
float ggx_d(float t, float nh, float alpha);

// Shadowing and masking over 4 nl nv.  Source: Heitz 2014, eq. 99.
float ggx_v(float nl, float nv, float alpha);

// Smith's masking of the viewer alone, over 4 nv.
float ggx_g1_over_4nv(float nv, float alpha);

// The report's shadowing and masking over 4 nl nv, and its k for light from a
// point and from all around.  Source: Karis 2013.
float schlick_v(float nl, float nv, float k);
float schlick_k_point(float roughness);
float schlick_k_env(float roughness);

// Reflectance of a facet; Schlick's approximation of Fresnel's equations.
vec3 fresnel_schlick(vec3 f0, float oh);

// Reflectance at normal incidence of what is no metal, index 1.5.
#define DIELECTRIC_F0 0.04f

// F0 of colour c: from DIELECTRIC_F0 to c as metallic goes from 0 to 1.
vec3 metal_rough_f0(vec3 c, float metallic);

// A surface at one point.
typedef struct rough_terms {
  pbr_model model;
  vec3 f0;       // specular reflectance at normal incidence
  vec3 kd;       // (1 - metallic) c
  float alpha;   // roughness^2
  float k;       // PBR_REPORT: schlick_k_point or schlick_k_env
  float e_mean;  // PBR_GGX: mean over the hemisphere, by the cosine, of the
                 // specular albedo of a dielectric
} rough_terms;

// Shadowing and masking over 4 nl nv by the set of formulas in force.
float rough_v(const rough_terms *s, half_angles a);

// The two parts of f(wo, wi), without the cosine.  e_l, e_v: specular albedo
// of a dielectric of this roughness seen from nl and nv (PBR_GGX alone).
// Neither is negative or infinite for cosines in [0, 1].
vec3 rough_specular(const rough_terms *s, half_angles a);
vec3 rough_diffuse(const rough_terms *s, half_angles a, float e_l, float e_v);

#endif
