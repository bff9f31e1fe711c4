// ready_leave.h — the frame of a matt surface, and how rays leave it.

#ifndef READY_LEAVE_H
#define READY_LEAVE_H

#include "ready_num.h"
#include "ready_work.h"

// vertex_face without bumps, surface_face where nothing needs to be turned, and
// bsdf_basis.
static inline void ready_frame(ready_work *w) {
  for (int i = 0; i < LANES; i++) {
    int front = w->v.front[i];
    vec3 ns = lanes_at(&w->v.ns, i), ng = lanes_at(&w->v.ng, i);
    vec3 n = {front ? ns.x : -ns.x, front ? ns.y : -ns.y, front ? ns.z : -ns.z};
    float sign = copysignf(1, n.z), a = -1 / (sign + n.z), c = n.x * n.y * a;
    w->r.matt[i] = vec3_dot(n, lanes_at(&w->v.wo, i)) > 0;
    lanes_set(&w->r.n, i, n);
    lanes_set(&w->ng, i,
              (vec3){front ? ng.x : -ng.x, front ? ng.y : -ng.y,
                     front ? ng.z : -ng.z});
    lanes_set(&w->t, i,
              (vec3){1 + sign * n.x * n.x * a, sign * c, -sign * n.x});
    lanes_set(&w->b, i, (vec3){c, sign + n.y * n.y * a, -n.y});
  }
}

// Where surface_smooth_ray begins.
static inline void ready_from(ready_work *w) {
  const lane_work *v = &w->v;
  for (int i = 0; i < LANES; i++) {
    vec3 p = lanes_at(&v->p_smooth, i), n = lanes_at(&w->ng, i);
    vec3 lift = vec3_abs(vec3_sub(p, lanes_at(&v->p, i)));
    vec3 bound = vec3_mad(lanes_at(&v->p_error, i), 0x1.00001p-24f, lift);
    float distance = 2 * vec3_dot(vec3_abs(n), bound) * (1 + 0x1p-18f);
    vec3 step = vec3_mad(lanes_at(&v->inward, i), distance, n);
    lanes_set(&w->r.from, i, vec3_add(p, step));
  }
}

// Whether a ray leaves lane i from straight above the front of its facet, and
// climbs.
static inline int lane_climbs(const ready_work *w, int i, vec3 d) {
  vec3 ng = lanes_at(&w->v.ng, i);
  vec3 lift = vec3_sub(lanes_at(&w->v.p_smooth, i), lanes_at(&w->v.p, i));
  float high = vec3_dot(lift, ng);
  int straight = high * high >= RAY_CLIMB * RAY_CLIMB * vec3_dot(lift, lift);
  return w->v.front[i] & straight & ray_climbs(d, ng);
}

// bsdf_sample_wi of a matt surface, and vertex_world.
static inline void ready_leave(ready_work *w) {
  for (int i = 0; i < LANES; i++) {
    float u2 = w->r.u[USE_DIRECTION + 1][i], r = sqrtf(u2);
    vec2 c = lane_circle(w->r.u[USE_DIRECTION][i]);
    vec3 wi = {r * c.x, r * c.y, sqrtf(1 - u2)};
    float pdf = wi.z / PI;
    vec3 f = vec3_scale(lanes_at(&w->r.kd, i), 1 / PI);
    vec3 sum = vec3_scale(lanes_at(&w->t, i), wi.x);
    sum = vec3_mad(sum, wi.y, lanes_at(&w->b, i));
    int32_t odd = !(pdf > 0);
    sum = lane_unit(vec3_mad(sum, wi.z, lanes_at(&w->r.n, i)), &odd);
    w->r.matt[i] &= !odd;
    lanes_set(&w->r.leave, i, sum);
    lanes_set(&w->r.weight, i, vec3_scale(f, wi.z / pdf));
    w->r.leave_pdf[i] = pdf;
    w->r.left[i] = lane_climbs(w, i, sum) ? w->triangle[i] : HIT_NONE;
  }
}

#endif
