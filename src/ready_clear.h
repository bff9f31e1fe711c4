// ready_clear.h — how rays go on at plain mirrors and glass.

#ifndef READY_CLEAR_H
#define READY_CLEAR_H

#include "ready_work.h"

// Sixteen of them: wo in the frame, the index of refraction as seen from there,
// the cosine behind; the probability of a reflection and whether it is one; the
// next direction, and the normal of the facet on its side.  A lane that takes a
// way that is not here is odd.
typedef struct ready_clear {
  lanes3 wo, wi, side;
  float eta[LANES], cos_t[LANES], reflects[LANES];
  int32_t back[LANES], odd[LANES];
} ready_clear;

// vertex_local; odd where surface_bend or surface_bend_glass have something to
// do.
static inline void clear_enter(const ready_work *w, ready_clear *c) {
  for (int i = 0; i < LANES; i++) {
    vec3 wo = lanes_at(&w->v.wo, i);
    vec3 n = lanes_at(&w->r.n, i), ng = lanes_at(&w->ng, i);
    float eta = w->v.front[i] ? w->eta[i] : 1 / w->eta[i];
    float cos_i = vec3_dot(wo, n), a = vec3_dot(wo, ng), b = vec3_dot(n, ng);
    float clear = float_min(0.5f * a, SURFACE_CLEARANCE);
    float square = (eta - 1) * (eta + 1) + cos_i * cos_i;
    int total = square < 0, inner = eta < 1;
    int crosses = a + b * (sqrtf(square) - cos_i) > 0;
    int straight = 2 * cos_i * b - a - clear >= 0, faces = cos_i > 0;
    c->odd[i] =
        1 ^ (faces & (a > 0) & straight & ((1 ^ inner) | total | crosses));
    c->eta[i] = eta;
    lanes_set(&c->wo, i,
              (vec3){vec3_dot(wo, lanes_at(&w->t, i)),
                     vec3_dot(wo, lanes_at(&w->b, i)), cos_i});
  }
}

// fresnel_dielectric; mirrors reflect all.
static inline void clear_fresnel(const ready_work *w, ready_clear *c) {
  for (int i = 0; i < LANES; i++) {
    double x = (double)float_min(fabsf(c->wo.z[i]), 1), n = (double)c->eta[i];
    double s2 = (n - 1) * (n + 1) + x * x, s = sqrt(s2);
    double across = (x - s) / (x + s);
    double along = (n * n * x - s) / (n * n * x + s);
    float some = (float)(0.5 * (across * across + along * along));
    c->cos_t[i] = s2 > 0 ? (float)(s / n) : 0;
    c->reflects[i] = s2 > 0 ? some : 1;
    c->reflects[i] = w->r.plain[i] == PLAIN_MIRROR ? 2 : c->reflects[i];
  }
}

// bsdf_sample_wi and vertex_world; odd where surface_keep_side has something to
// do.
static inline void clear_direction(const ready_work *w, ready_clear *c) {
  for (int i = 0; i < LANES; i++) {
    vec3 wo = lanes_at(&c->wo, i), ng = lanes_at(&w->ng, i);
    float eta = c->eta[i];
    int32_t back = w->r.u[USE_LOBE][i] < c->reflects[i], odd = 0, far = 0;
    vec3 in = lane_unit((vec3){-wo.x / eta, -wo.y / eta, -c->cos_t[i]}, &far);
    vec3 wi = {back ? -wo.x : in.x, back ? -wo.y : in.y, back ? wo.z : in.z};
    vec3 sum = vec3_scale(lanes_at(&w->t, i), wi.x);
    sum = vec3_mad(sum, wi.y, lanes_at(&w->b, i));
    sum = lane_unit(vec3_mad(sum, wi.z, lanes_at(&w->r.n, i)), &odd);
    ng = (vec3){back ? ng.x : -ng.x, back ? ng.y : -ng.y, back ? ng.z : -ng.z};
    int32_t same = vec3_dot(sum, ng) > 0;
    c->odd[i] |= odd | (far & (1 ^ back)) | (1 ^ same);
    c->back[i] = back;
    lanes_set(&c->side, i, ng);
    lanes_set(&c->wi, i, sum);
  }
}

// v in lane i where yes.
static inline void lanes_choose(lanes3 *to, int i, int yes, vec3 v) {
  float x = to->x[i], y = to->y[i], z = to->z[i];
  to->x[i] = yes ? v.x : x;
  to->y[i] = yes ? v.y : y;
  to->z[i] = yes ? v.z : z;
}

// surface_ray, and what else the path is told.
static inline void clear_leave(ready_work *w, const ready_clear *c) {
  const lane_work *v = &w->v;
  for (int i = 0; i < LANES; i++) {
    vec3 n = lanes_at(&c->side, i), wi = lanes_at(&c->wi, i);
    vec3 bound = lanes_at(&v->p_error, i);
    float distance = 2 * vec3_dot(vec3_abs(n), bound) * (1 + 0x1p-18f);
    vec3 step = vec3_mad(lanes_at(&v->inward, i), distance, n);
    int clear = w->r.plain[i] > PLAIN_MATT;
    lanes_choose(&w->r.from, i, clear, vec3_add(lanes_at(&v->p, i), step));
    lanes_choose(&w->r.leave, i, clear, wi);
    lanes_choose(&w->r.weight, i, clear, lanes_at(&w->r.kd, i));
  }
  for (int i = 0; i < LANES; i++) {
    int kind = w->r.plain[i], clear = kind > PLAIN_MATT;
    int climbs = ray_climbs(lanes_at(&c->wi, i), lanes_at(&v->ng, i));
    uint32_t left = climbs ? w->triangle[i] : HIT_NONE, was = w->r.left[i];
    float pdf = w->r.leave_pdf[i];
    w->r.left[i] = clear ? left : was;
    w->r.leave_pdf[i] = clear ? 0 : pdf;
    w->r.held[i] = (kind == PLAIN_GLASS) & (1 ^ v->front[i]) & c->back[i];
    w->sure[i] = clear ? 1 ^ c->odd[i] : w->r.matt[i];
  }
}

static inline void ready_clear_all(ready_work *w) {
  ready_clear c;
  clear_enter(w, &c);
  clear_fresnel(w, &c);
  clear_direction(w, &c);
  clear_leave(w, &c);
}

#endif
