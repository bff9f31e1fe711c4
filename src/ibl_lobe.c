// ibl_lobe.c

#include "ibl_lobe.h"

// The weight at the cosine c to the axis; t = (1 - c) / 2 is the squared sine
// of the half vector's angle, given apart for its digits.
static float weight_at(const lobe *l, float c, float t) {
  if (!(c > 0)) return 0;
  if (l->alpha == 0) return c * l->norm;
  float nh = sqrtf(1 - t);
  float v = l->model == PBR_REPORT ? schlick_v(c, 1, l->alpha / 2)
                                   : ggx_v(c, 1, l->alpha);
  return l->norm * ggx_d(t, nh, l->alpha) * v * c;
}

float lobe_weight(const lobe *l, vec3 axis, vec3 w) {
  vec3 apart = vec3_sub(axis, w);
  float t = vec3_dot(apart, apart) * 0.25f;
  return weight_at(l, 1 - 2 * t, fminf(t, 1));
}

lobe lobe_cosine(void) {
  return (lobe){PBR_GGX, 0, 1};
}

// Panels of the integral over the angle, each with four Gauss points.
enum { LOBE_PANELS = 600, LOBE_DEGREES = 512 };

// The integral of weight times P_l over the sphere, for all l <= degree.  The
// angle is width sinh(t), so that points are dense where the lobe is high.
static void lobe_integrals(double *k, int degree, const lobe *l) {
  static const double x[4] = {0.0694318442029737, 0.3300094782075719,
                              0.6699905217924281, 0.9305681557970263};
  static const double w[4] = {0.1739274225687269, 0.3260725774312731,
                              0.3260725774312731, 0.1739274225687269};
  double pi = 3.14159265358979324;
  double width = l->alpha == 0 ? 2 : 2 * (double)l->alpha;
  double range = asinh(pi / 2 / width), step = range / LOBE_PANELS;
  double up[LOBE_DEGREES], down[LOBE_DEGREES];  // of the recurrence of P_l
  for (int i = 0; i <= degree; i++)
    k[i] = 0, up[i] = (2 * i + 1) / (i + 1.0), down[i] = i / (i + 1.0);
  for (int i = 0; i < 4 * LOBE_PANELS; i++) {
    double t = (i / 4 + x[i % 4]) * step, theta = width * sinh(t);
    double half = sin(theta / 2), c = cos(theta);
    double value = (double)weight_at(l, (float)c, (float)(half * half));
    value *= 2 * pi * sin(theta) * width * cosh(t) * step * w[i % 4];
    double p0 = 0, p1 = 1;
    for (int n = 0; n <= degree; n++) {
      k[n] += value * p1;
      double p2 = up[n] * c * p1 - down[n] * p0;
      p0 = p1, p1 = p2;
    }
  }
}

lobe lobe_rough(pbr_model model, float roughness) {
  lobe l = {model, roughness * roughness, 1};
  double all;
  lobe_integrals(&all, 0, &l);
  l.norm = (float)(1 / all);
  return l;
}

int lobe_spectrum(double *k, int degree, const lobe *l) {
  lobe_integrals(k, degree, l);
  double whole = l->alpha == 0 ? 3.14159265358979324 : 1, scale = whole / k[0];
  int last = 0;
  for (int i = 0; i <= degree; i++) {
    k[i] *= scale;
    if (fabs(k[i]) > 3e-7 * whole) last = i;
  }
  return last;
}
