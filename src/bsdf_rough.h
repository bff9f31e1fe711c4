// bsdf_rough.h — metallic-roughness as a triple: eval, pdf and sample.
//
// Local frame: +z is the normal, all directions unit and pointing away from
// the surface.  Zero where wo or wi is below it.

#ifndef BSDF_ROUGH_H
#define BSDF_ROUGH_H

#include "dfg.h"
#include "microfacet.h"

// Its textures already looked up.
typedef struct bsdf_rough {
  rough_terms terms;
  float roughness;
  const dfg *table;
} bsdf_rough;

// A surface of colour c by the set of formulas of the table.  Below the
// roughness whose alpha is ALPHA_MIN only the diffuse part is left: the mirror
// above it has no density.
bsdf_rough bsdf_rough_of(const dfg *table, vec3 c, float metallic,
                         float roughness);

// The same under light from a point, for which PBR_REPORT has another k.
bsdf_rough bsdf_rough_under_point(const bsdf_rough *b);

// f(wo, wi), without the cosine.
vec3 bsdf_rough_eval(const bsdf_rough *b, vec3 wo, vec3 wi);

// The density of bsdf_rough_sample over wi, per steradian.
float bsdf_rough_pdf(const bsdf_rough *b, vec3 wo, vec3 wi);

// A direction from three uniform numbers, and weight = f wi.z / pdf.  False
// where nothing is scattered.
bool bsdf_rough_sample(const bsdf_rough *b, vec3 wo, const float u[3], vec3 *wi,
                       vec3 *weight);

// A facet normal that wo sees, of density G1 D max(0, wo.h) / wo.z.
vec3 ggx_visible_normal(vec3 wo, float alpha, float u1, float u2);

#endif
