// light_bound.c — no angle is ever computed.  A light within a sphere of radius
// r at distance d is seen within an angle b of the direction to its middle, sin
// b = r / d; its best cosine, cos(a - b), is taken for cos a + sin b.  That is
// an upper bound while cos a >= 0, and positive exactly where the cosine is.

#include "light_bound.h"

light_place light_place_of(vec3 p, vec3 n) {
  return (light_place){p, n, !(vec3_dot(n, n) > 0)};
}

// A sphere as seen from a place.
typedef struct sphere_view {
  vec3 way;       // to its middle
  float inverse;  // 1 / distance, which counts as no less than the radius
  float sine;     // of its half angle
  float cosine;   // bound of the cosine where the light falls; 0: none
} sphere_view;

static sphere_view sphere_seen(vec3 middle, float radius,
                               const light_place *at) {
  sphere_view v = {.way = vec3_sub(middle, at->p)};
  float distance = float_max(vec3_length(v.way), radius);
  if (!(distance > 0)) return v;
  v.inverse = 1 / distance;
  v.sine = radius * v.inverse;
  v.cosine = 1;
  if (!at->all_around)
    v.cosine = float_min(1, vec3_dot(at->n, v.way) * v.inverse + v.sine);
  return v;
}

static float fall_off(float power, const sphere_view *v) {
  float bound = power * v->cosine * (v->inverse * v->inverse);
  return bound < INFINITY ? bound : 0;
}

float light_bound_emitter(const light_emitter *e, const light_place *at) {
  const light_triangle *t = &e->shape;
  sphere_view v = sphere_seen(t->middle, t->radius, at);
  if (!(v.cosine > 0)) return 0;
  if (e->is_point) return fall_off(e->power, &v);
  float height = light_triangle_height(t, at->p);
  if (!(height > 0)) return 0;
  return float_min(1, height * v.inverse + v.sine) * fall_off(e->power, &v);
}

float light_bound_group(const light_group *g, const light_place *at) {
  sphere_view v = sphere_seen(g->middle, g->radius, at);
  if (!(v.cosine > 0)) return 0;
  float ahead = 1;
  if (g->cos_cone > -1 && v.sine < 1) {
    float c = -vec3_dot(g->axis, v.way) * v.inverse;
    if (c < g->cos_cone)
      ahead = c * g->cos_cone + sqrtf(float_max(1 - c * c, 0)) * g->sin_cone;
    ahead = float_min(1, ahead + v.sine);
    if (!(ahead > 0)) return 0;
  }
  return ahead * fall_off(g->power, &v);
}
