// ready_triangle.h — light_triangle_sample, step by step.

#ifndef READY_TRIANGLE_H
#define READY_TRIANGLE_H

#include "ready_num.h"
#include "ready_work.h"

// light_triangle_height and view_of.
static inline void ready_see(ready_work *w) {
  const ready_light *t = &w->light;
  ready_view *v = &w->view;
  for (int i = 0; i < LANES; i++) {
    vec3 p = lanes_at(&w->v.p, i), a = vec3_sub(lanes_at(&t->a, i), p);
    vec3 b = vec3_add(a, lanes_at(&t->ab, i));
    vec3 c = vec3_add(a, lanes_at(&t->ac, i));
    vec3 down = vec3_sub(p, lanes_at(&t->a, i));
    float height = vec3_dot(lanes_at(&t->n, i), down);
    height = height > LIGHT_LEAST_HEIGHT * t->radius[i] ? height : 0;
    float far_a = vec3_length(a), far_b = vec3_length(b);
    float far_c = vec3_length(c);
    a = vec3_scale(a, 1 / far_a);
    b = vec3_scale(b, 1 / far_b);
    c = vec3_scale(c, 1 / far_c);
    float volume = 2 * t->area[i] * height / (far_a * far_b * far_c);
    float pairs = vec3_dot(a, c) + vec3_dot(b, c);
    float one_pair = 1 + vec3_dot(a, b);
    v->height[i] = height;
    v->far[0][i] = far_a, v->far[1][i] = far_b, v->far[2][i] = far_c;
    v->volume[i] = volume, v->pairs[i] = pairs, v->one_pair[i] = one_pair;
    v->angle[i] = 4 * PI * lane_turns(volume, pairs + one_pair);
    lanes_set(&v->to[0], i, a);
    lanes_set(&v->to[1], i, b);
    lanes_set(&v->to[2], i, c);
  }
}

// sample_angle.
static inline void ready_angle(ready_work *w) {
  ready_view *v = &w->view;
  for (int i = 0; i < LANES; i++) {
    float u1 = w->r.u[USE_LIGHT][i], u2 = w->r.u[USE_LIGHT + 1][i];
    vec3 a = lanes_at(&v->to[0], i), b = lanes_at(&v->to[1], i);
    vec3 c = lanes_at(&v->to[2], i);
    vec2 half = lane_circle(0.25f / PI * v->angle[i] * u1);
    float ka = v->volume[i] * half.x - v->pairs[i] * half.y;
    float kc = v->one_pair[i] * half.y;
    vec3 way = vec3_mad(vec3_scale(a, ka), kc, c);
    float turn = 2 * vec3_dot(a, way) / vec3_dot(way, way);
    ka = turn * ka - 1;
    kc = turn * kc;
    vec3 moved = vec3_mad(vec3_scale(a, ka), kc, c);
    vec3 step = vec3_sub(b, moved);
    float drop = 0.5f * vec3_dot(step, step);
    float low = u2 * drop;
    float share = sqrtf(u2 * (2 - low) / float_max(2 - drop, 1e-6f));
    float k0 = share * ka, k1 = 1 - low - share * (1 - drop), k2 = share * kc;
    v->k[0][i] = float_max(k0, 0) / v->far[0][i];
    v->k[1][i] = float_max(k1, 0) / v->far[1][i];
    v->k[2][i] = float_max(k2, 0) / v->far[2][i];
  }
}

// sample_area where the triangle is far, and the weights of the corners.
static inline void ready_area(ready_work *w) {
  const ready_light *t = &w->light;
  ready_view *v = &w->view;
  for (int i = 0; i < LANES; i++) {
    vec3 d = vec3_sub(lanes_at(&t->middle, i), lanes_at(&w->v.p, i));
    float radius = t->radius[i];
    int far =
        vec3_dot(d, d) > LIGHT_FAR_RADII * LIGHT_FAR_RADII * radius * radius;
    float u1 = w->r.u[USE_LIGHT][i], u2 = w->r.u[USE_LIGHT + 1][i];
    int upper = u2 > u1;
    float less = (upper ? u1 : u2) * 0.5f;
    float more = upper ? u2 - less : u1 - less;
    float a1 = upper ? less : more, a2 = upper ? more : less;
    float k0 = far ? 1 - a1 - a2 : v->k[0][i];
    float k1 = far ? a1 : v->k[1][i], k2 = far ? a2 : v->k[2][i];
    float sum = k0 + k1 + k2;
    v->angle[i] = far ? 0 : v->angle[i];
    v->b[i] = k1 / sum, v->c[i] = k2 / sum;
  }
}

// The point, the direction to it and its density.
static inline void ready_point(ready_work *w) {
  const ready_light *t = &w->light;
  const ready_view *v = &w->view;
  for (int i = 0; i < LANES; i++) {
    vec3 at = vec3_mad(lanes_at(&t->a, i), v->b[i], lanes_at(&t->ab, i));
    at = vec3_mad(at, v->c[i], lanes_at(&t->ac, i));
    vec3 d = vec3_sub(at, lanes_at(&w->v.p, i));
    float d2 = vec3_dot(d, d);
    float by_area = d2 * sqrtf(d2) / (t->area[i] * v->height[i]);
    float pdf = v->angle[i] > 0 ? 1 / v->angle[i] : by_area;
    int32_t odd = 0;
    vec3 wi = lane_unit(d, &odd);
    float density = t->share[i] * pdf;
    int32_t found = w->r.found[i];
    found &= v->height[i] > 0;
    found &= pdf < INFINITY;
    found &= density > 0;
    found &= fabsf(at.x) < INFINITY;
    found &= fabsf(at.y) < INFINITY;
    found &= fabsf(at.z) < INFINITY;
    w->r.found[i] = found;
    w->r.matt[i] &= 1 ^ (odd & found);
    lanes_set(&w->r.to, i, at);
    lanes_set(&w->r.wi, i, wi);
    w->r.pdf[i] = density;
    w->r.chosen[i] = t->share[i];
    w->r.cosine[i] = vec3_dot(wi, lanes_at(&w->r.n, i));
  }
}

#endif
