// path_ready.c

#include "path_ready.h"

// Memory of lights is large, and each vertex asks elsewhere: fetch what n of
// them will ask for, all at once.
static void fetch_memory(const light_set *l, const vertex *at, size_t n) {
  const light_memory *m = l != NULL ? l->memory : NULL;
  for (size_t i = 0; m != NULL && i < n; i++)
    light_memory_fetch(m, light_memory_key(m, at[i].at.p, at[i].ns));
}

void path_ready_draw(const ready_job *j, size_t i, float u[USES]) {
  sampler_8(&j->numbers[i], j->dimension, u);
  if (j->toward == NULL) return;
  sampler s = j->toward[i];
  sampler_at(&s, j->dimension + USE_DIRECTION);
  u[USE_DIRECTION] = sampler_1(&s);
  u[USE_DIRECTION + 1] = sampler_1(&s);
}

void path_ready_alone(const ready_job *j, size_t n) {
  for (size_t i = 0; i < n; i++) {
    path_ready *r = &j->ready[i / LANES];
    float u[USES];
    j->at[i] = vertex_at(j->scene, &j->hits[i], j->rays[i].d);
    path_ready_draw(j, i, u);
    for (int k = 0; k < USES; k++)
      r->u[k][i % LANES] = u[k];
    r->matt[i % LANES] = r->plain[i % LANES] = r->held[i % LANES] = 0;
  }
  fetch_memory(j->lights, j->at, n);
}

stop path_ready_stop(vertex *at, const path_ready *r, int lane) {
  stop s = {.at = at, .lane = lane};
  for (int k = 0; k < USES; k++)
    s.u[k] = r->u[k][lane];
  if (!r->matt[lane]) return s;
  s.ready = r;
  s.lit = r->lit;
  return s;
}

static float turned(float u, float by) {
  u += by;
  return u - float_floor(u);
}

// Points by steps of Roberts' sequence, the golden ratio's kin for squares.
// Source: Roberts 2018, "The Unreasonable Effectiveness of Quasirandom
// Sequences".
static void turn(float *choice, float *u, float *v, uint32_t i,
                 uint32_t turns) {
  float n = (float)i;
  *choice = float_min((n + *choice) / (float)turns, FLOAT_BELOW_1);
  *u = turned(*u, 0.7548777f * n);
  *v = turned(*v, 0.5698403f * n);
}

stop path_ready_turn(const stop *s, uint32_t i, uint32_t turns) {
  stop t = *s;
  turn(&t.u[USE_PICK], &t.u[USE_LIGHT], &t.u[USE_LIGHT + 1], i, turns);
  return t;
}

void path_ready_turns(path_ready *to, const path_ready *of, size_t n,
                      uint32_t i, uint32_t turns) {
  for (size_t k = 0; k < n; k++) {
    path_ready *r = &to[k / LANES];
    size_t lane = k % LANES;
    if (lane == 0) *r = of[k / LANES];
    turn(&r->u[USE_PICK][lane], &r->u[USE_LIGHT][lane],
         &r->u[USE_LIGHT + 1][lane], i, turns);
  }
}

light_question path_ready_question(const stop *s) {
  vec3 u = {s->u[USE_PICK], s->u[USE_LIGHT], s->u[USE_LIGHT + 1]};
  return (light_question){s->at->at.p, s->at->n, u};
}

bool path_ready_light(const stop *s, light_sample *l, meeting *m) {
  const path_ready *r = s->ready;
  int i = s->lane;
  *l = (light_sample){.wi = lanes_at(&r->wi, i),
                      .radiance = lanes_at(&r->radiance, i),
                      .pdf = r->pdf[i],
                      .delta = r->delta[i],
                      .has_end = r->has_end[i],
                      .to = lanes_at(&r->to, i),
                      .part = r->part[i],
                      .chosen = r->chosen[i]};
  m->cosine = r->cosine[i];
  m->f = vec3_scale(lanes_at(&r->kd, i), 1 / PI);
  m->pdf = m->cosine / PI;
  return r->found[i] && m->cosine > 0;
}

ray path_ready_shadow(const stop *s) {
  const path_ready *r = s->ready;
  vec3 from = lanes_at(&r->from, s->lane);
  if (!r->has_end[s->lane]) return ray_from(from, lanes_at(&r->wi, s->lane));
  ray to = ray_from(from, vec3_sub(lanes_at(&r->to, s->lane), from));
  to.tmax = SURFACE_SHADOW_END;
  return to;
}

ray path_ready_leave(const stop *s, bsdf_sample *d) {
  const path_ready *r = s->ready;
  d->weight = lanes_at(&r->weight, s->lane);
  d->pdf = r->leave_pdf[s->lane];
  return ray_from(lanes_at(&r->from, s->lane), lanes_at(&r->leave, s->lane));
}

bool path_ready_lights(const light_set *l) {
  return l->near.count > 0 && l->name_count == l->near.count &&
         l->far_count == 0 && !(l->env.irradiance > 0);
}
