// bsdf.h — how a surface scatters light: eval, pdf and sample, a triple that
// belongs together.
//
// Local frame: +z is the shading normal, all directions unit and pointing away
// from the surface, wo towards the viewer, wi towards the light.

#ifndef BSDF_H
#define BSDF_H

#include "bsdf_rough.h"

typedef enum bsdf_kind {
  BSDF_LAMBERT,
  BSDF_BLINN_PHONG,
  BSDF_ROUGH,  // metallic-roughness
  BSDF_MIRROR,
  BSDF_GLASS
} bsdf_kind;

// A scattering function with its textures already looked up.
typedef struct bsdf {
  bsdf_kind kind;
  vec3 kd, ks;   // diffuse albedo (glass: share that passes); specular colour
  float ns;      // Blinn-Phong exponent
  float eta;     // glass: index of refraction inside over outside
  bool schlick;  // mirror: ks is F0 and rises towards grazing by Schlick
  bsdf_rough rough;
} bsdf;

// One sampled direction.  weight = f(wo, wi) |cos wi| / pdf, so a path just
// multiplies; pdf is per steradian; delta for mirror and glass, where the pdf
// is a probability.
typedef struct bsdf_sample {
  vec3 wi, weight;
  float pdf;
  bool delta;
  bool transmitted;  // wi is on the other side
} bsdf_sample;

// f(wo, wi), without the cosine; 0 for deltas and across the surface.
vec3 bsdf_eval(const bsdf *b, vec3 wo, vec3 wi);

// The same for light from a point or a direction, which metallic-roughness may
// see by another formula.
vec3 bsdf_eval_point(const bsdf *b, vec3 wo, vec3 wi);

// The density of bsdf_sample over wi, per steradian.
float bsdf_pdf(const bsdf *b, vec3 wo, vec3 wi);

// One direction from three uniform numbers.  False when nothing is scattered.
// wo.z may be negative for glass: then the viewer is inside.
bool bsdf_sample_wi(const bsdf *b, vec3 wo, float u, float u1, float u2,
                    bsdf_sample *out);

// Whether all of it is delta: light sampling is of no use.
bool bsdf_is_delta(const bsdf *b);

// Exact unpolarised Fresnel reflectance of a dielectric.  cos_i in [0, 1] on
// the incoming side, eta = index on the far side over this side; *cos_t is
// the refracted cosine, 0 at total reflection (result 1).
float fresnel_dielectric(float cos_i, float eta, float *cos_t);

// The normalisation of Blinn-Phong in this project: f = kd/pi + ks (n + 2)(n +
// 4) / (8 pi (2^(-n/2) + n)) (n.h)^n.  Source: Akenine-Moller et al., Real-Time
// Rendering 3rd ed., eq. 7.48 and its references (Giesen 2009).
float blinn_phong_norm(float n);

// An orthonormal basis around unit n.  Source: Duff et al., "Building an
// Orthonormal Basis, Revisited", JCGT 6(1), 2017.
void bsdf_basis(vec3 n, vec3 *t, vec3 *b);

#endif
