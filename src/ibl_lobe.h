// ibl_lobe.h — the weight that light gets by its angle to the axis, and what
// it does to spherical harmonics.

#ifndef IBL_LOBE_H
#define IBL_LOBE_H

#include "microfacet.h"

// A weight that depends on the angle between a light and the axis alone, and
// is 0 from 90 degrees on.
typedef struct lobe {
  pbr_model model;
  float alpha;  // 0: the plain cosine
  float norm;   // 1 over the integral, so that a constant stays; cosine: 1
} lobe;

// The cosine, for irradiance.
lobe lobe_cosine(void);

// D V nl with n = v = axis, roughness > 0, normalised.
lobe lobe_rough(pbr_model model, float roughness);

// The weight of unit direction w about the unit axis.
float lobe_weight(const lobe *l, vec3 axis, vec3 w);

// k[l] for l <= degree: convolution with the lobe multiplies a_lm by it.
// Returns the degree up to which any k counts: above, all are below 3e-7 of
// k[0].
int lobe_spectrum(double *k, int degree, const lobe *l);

#endif
