// tonemap.c

#include "tonemap.h"

#include "num.h"

// c / (1 + L) with L the luminance of c: colours keep their ratios, and the
// luminance never reaches 1.  Source: Reinhard et al., "Photographic Tone
// Reproduction for Digital Images", SIGGRAPH 2002, equation 3.
static vec3 reinhard(vec3 c) {
  float luminance = 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z;
  return vec3_scale(c, 1 / (1 + fmaxf(luminance, 0)));
}

// One channel of a fit to the ACES film curve, rising from 0 to 1.  Source:
// Narkowicz, "ACES Filmic Tone Mapping Curve", 2015.
static float aces(float x) {
  x = fminf(fmaxf(x, 0), 1e4f);
  float y = x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f);
  return fminf(y, 1);
}

void tonemap_apply(image *im, float stops, tonemap_curve curve) {
  float gain = num_exp2(stops);
  size_t n = (size_t)im->width * (size_t)im->height;
  for (size_t i = 0; i < n; i++) {
    vec3 c = vec3_scale(im->pixels[i], gain);
    if (curve == TONEMAP_REINHARD) c = reinhard(c);
    if (curve == TONEMAP_ACES) c = (vec3){aces(c.x), aces(c.y), aces(c.z)};
    im->pixels[i] = c;
  }
}
