// ready_lane.h — vertices written down, one by one: what of them is not in
// columns.

#ifndef READY_LANE_H
#define READY_LANE_H

#include "ready_work.h"

// The albedo of a surface that is matt and has no bumps, by matter.c; false
// where it is something else.
static inline bool lane_matt(const surface *s, vec3 *kd) {
  const material *m = s->material;
  if (m == NULL || m->kind != MATERIAL_BLINN_PHONG) return false;
  if (vec3_peak(m->ks) > 0 || m->map_ks.image != NULL) return false;
  if (m->map_bump.image != NULL || m->map_norm.image != NULL) return false;
  vec3 c = m->kd;
  if (m->map_kd.image != NULL) c = vec3_mul(c, texture_rgb(&m->map_kd, s->uv));
  c = vec3_mul(c, s->color);
  float down = 1 / float_max(1, vec3_peak(vec3_add(c, m->ks)));
  *kd = vec3_scale(c, down);
  return true;
}

// Lane i as the vertex of its hit, with its frame.
static inline void lane_finish(ready_work *w, int i, const ready_job *j,
                               size_t at) {
  vertex *v = &j->at[at];
  vec3 kd = {0, 0, 0};
  lane_scatter(&w->v, i, j->scene, &j->hits[at], &j->rays[at], v);
  bool matt = !w->v.odd[i] && w->r.matt[i] && lane_matt(&v->at, &kd);
  lanes_set(&w->r.kd, i, kd);
  w->r.matt[i] = matt;
  v->n = lanes_at(&w->r.n, i);
  v->t = lanes_at(&w->t, i);
  v->b = lanes_at(&w->b, i);
}

// Whether nobody needs to see the vertex of lane i.
static inline bool lane_plain(ready_work *w, int i, const ready_job *j,
                              size_t at) {
  w->r.plain[i] = PLAIN_NOT;
  w->eta[i] = 1;
  if (j->plain == NULL || w->v.odd[i] || !w->r.matt[i]) return false;
  const path_plain *m = &j->plain[j->scene->material_of[j->hits[at].triangle]];
  lanes_set(&w->r.kd, i, m->albedo);
  w->r.plain[i] = (int32_t)m->kind;
  w->eta[i] = m->eta;
  if (m->kind > PLAIN_MATT) w->r.matt[i] = 0, w->clear = 1;
  return m->kind != PLAIN_NOT;
}

// One that was thought to be plain.
static inline void lane_alone(ready_work *w, int i, const ready_job *j,
                              size_t at) {
  w->r.plain[i] = PLAIN_NOT;
  j->at[at] = vertex_at(j->scene, &j->hits[at], j->rays[at].d);
}

#endif
