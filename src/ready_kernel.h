// ready_kernel.h — vertices made ready, compiled once a level.

#ifndef READY_KERNEL_H
#define READY_KERNEL_H

#include "light_emission.h"
#include "ready_clear.h"
#include "ready_lane.h"
#include "ready_leave.h"
#include "ready_numbers.h"
#include "ready_pick.h"
#include "ready_triangle.h"

// light_emission, which few need to be asked.
static inline vec3 lane_radiance(const ready_work *w, int i,
                                 const light_set *l) {
  const scene *s = l->scene;
  const light_memory *m = l->memory;
  uint32_t source = l->near.emitters[w->light.emitter[i]].source;
  const material *of = &s->materials[s->material_of[source]];
  if (of->map_ke.image == NULL && !of->passes) return of->ke;
  float b = w->view.b[i], c = w->view.c[i];
  if (m == NULL) return light_emission(s, source, b, c);
  const light_part *p = &l->parts.of[w->r.part[i]];
  return light_emission(s, source, p->at.x + b * p->ab.x + c * p->ac.x,
                        p->at.y + b * p->ab.y + c * p->ac.y);
}

// light_sample_at.
static inline void ready_lights(ready_work *w, const light_set *l) {
  ready_pick(w, l);
  ready_see(w);
  ready_angle(w);
  ready_area(w);
  ready_point(w);
  for (int i = 0; i < LANES; i++)
    if (w->r.found[i]) lanes_set(&w->r.radiance, i, lane_radiance(w, i, l));
}

// Those of bits `uses` of all, by samplers s.
static inline void ready_even(ready_work *w, const ready_job *j,
                              const sampler *s, int n, uint32_t uses) {
  for (int i = 0; i < LANES; i++) {
    const sampler *one = &s[i < n ? i : n - 1];
    w->key_lo[i] = (uint32_t)one->key;
    w->key_hi[i] = (uint32_t)(one->key >> 32);
    w->index[i] = one->index;
  }
  ready_numbers(w, s->kind, j->dimension, uses);
}

// sampler_8 of all.
static inline void ready_draw(ready_work *w, const ready_job *j, size_t from,
                              int n) {
  if (j->numbers[from].kind != SAMPLER_RANDOM) {
    uint32_t uses = j->uses != 0 ? j->uses : UINT32_MAX;
    ready_even(w, j, j->numbers + from, n, uses);
    if (j->toward != NULL)
      ready_even(w, j, j->toward + from, n, 3u << USE_DIRECTION);
    return;
  }
  for (int i = 0; i < n; i++) {
    float u[USES];
    path_ready_draw(j, from + (size_t)i, u);
    for (int k = 0; k < USES; k++)
      w->r.u[k][i] = u[k];
  }
}

// Up to LANES of them; lanes beyond n hold the last one again.
static inline void ready_run(ready_work *w, const ready_job *j, size_t from,
                             int n) {
  const light_memory *m = j->lights != NULL ? j->lights->memory : NULL;
  for (int i = 0; i < LANES; i++) {
    size_t k = from + (size_t)(i < n ? i : n - 1);
    lane_gather(&w->v, i, j->scene, &j->hits[k], &j->rays[k]);
    w->triangle[i] = j->hits[k].triangle;
  }
  lanes_find(&w->v);
  ready_frame(w);
  if (m != NULL) ready_keys(m, &w->v.p, &w->r.n, w->cell);
  if (m != NULL) ready_fetch(m, w->cell);
  ready_draw(w, j, from, n);
  ready_from(w);
  w->clear = 0;
  for (int i = 0; i < n; i++)
    if (!lane_plain(w, i, j, from + (size_t)i))
      lane_finish(w, i, j, from + (size_t)i);
  for (int i = n; i < LANES; i++)
    w->r.matt[i] = w->r.plain[i] = 0;
  if (j->lights != NULL) ready_lights(w, j->lights);
  ready_leave(w);
  memcpy(w->sure, w->r.matt, sizeof w->sure);
  memset(w->r.held, 0, sizeof w->r.held);
  if (w->clear) ready_clear_all(w);
  w->r.p = w->v.p;
  for (int i = 0; i < n; i++)
    if (w->r.plain[i] && !w->sure[i]) lane_alone(w, i, j, from + (size_t)i);
}

static void ready_kernel(const ready_job *j, size_t n) {
  ready_work w;
  w.r = (path_ready){.lit = j->lights != NULL};
  for (int i = 0; i < LANES; i++)
    w.r.has_end[i] = 1;
  for (size_t i = 0; i < n; i++)
    lane_expect(j->scene, &j->hits[i]);
  for (size_t i = 0; i < n; i += LANES) {
    ready_run(&w, j, i, n - i < LANES ? (int)(n - i) : LANES);
    j->ready[i / LANES] = w.r;
  }
}

#endif
