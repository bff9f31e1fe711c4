// surface_ray.c — how a ray leaves a surface: from a float on the right side
// of the facet, a few errors of the point away from it and from its edges.

#include "surface.h"

// p moved inwards, and along unit n until it is on n's side of the facet.
// Twice the bound: once for the error of p, once for the rounding of the sum;
// and a little for that of n.
static vec3 displaced(vec3 p, vec3 bound, vec3 inward, vec3 n) {
  float distance = 2 * vec3_dot(vec3_abs(n), bound) * (1 + 0x1p-18f);
  return vec3_add(p, vec3_mad(inward, distance, n));
}

// ng or its opposite: the one on w's side.
static vec3 side_of(const surface *s, vec3 w) {
  return vec3_dot(s->ng, w) >= 0 ? s->ng : vec3_neg(s->ng);
}

// The one on the side that the ray came from.
static vec3 near_side(const surface *s) {
  return s->front ? s->ng : vec3_neg(s->ng);
}

ray surface_ray(const surface *s, vec3 w) {
  return ray_from(displaced(s->p, s->p_error, s->inward, side_of(s, w)), w);
}

// The error of p_smooth: it may be larger than p, and so its last digit.
static vec3 smooth_error(const surface *s) {
  return vec3_mad(s->p_error, 0x1.00001p-24f,
                  vec3_abs(vec3_sub(s->p_smooth, s->p)));
}

ray surface_smooth_ray(const surface *s, vec3 w) {
  vec3 o = displaced(s->p_smooth, smooth_error(s), s->inward, near_side(s));
  return ray_from(o, w);
}

ray surface_ray_to(const surface *s, vec3 q, bool smooth) {
  vec3 o = smooth ? surface_smooth_ray(s, s->ng).o
                  : surface_ray(s, vec3_sub(q, s->p)).o;
  ray r = ray_from(o, vec3_sub(q, o));
  r.tmax = SURFACE_SHADOW_END;
  return r;
}

// A direction is kept this far, as a cosine, from the plane of the facet when
// it was on the wrong side.
#define KEEP_MIN 0x1p-20f

vec3 surface_keep_side(const surface *s, vec3 w, bool transmitted) {
  vec3 n = s->front == transmitted ? vec3_neg(s->ng) : s->ng;
  float c = vec3_dot(w, n);
  if (c > 0) return w;
  return vec3_unit(vec3_mad(w, KEEP_MIN - c, n));
}
