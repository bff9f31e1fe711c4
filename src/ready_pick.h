// ready_pick.h — which shining triangle each lane asks.

#ifndef READY_PICK_H
#define READY_PICK_H

#include "ready_work.h"
#include "rng.h"

#include <string.h>

static inline int lane_step(float x) {
  return (int)float_min(x > 0 ? x : 0, LIGHT_GRID - 1);
}

// light_memory_key.
static inline void ready_keys(ready_work *w, const light_memory *m) {
  vec3 lo = m->lo;
  float per_unit = m->per_unit;
  for (int i = 0; i < LANES; i++) {
    vec3 p = lanes_at(&w->v.p, i), n = lanes_at(&w->n, i);
    vec3 at = vec3_scale(vec3_sub(p, lo), per_unit), a = vec3_abs(n);
    int key = (lane_step(at.z) * LIGHT_GRID + lane_step(at.y)) * LIGHT_GRID;
    key += lane_step(at.x);
    int from_y = a.y >= a.z ? 1 : 2, from_x = a.x >= a.z ? 0 : 2;
    float c_y = a.y >= a.z ? n.y : n.z, c_x = a.x >= a.z ? n.x : n.z;
    int axis = a.x >= a.y ? from_x : from_y;
    float c = a.x >= a.y ? c_x : c_y;
    w->cell[i] = (uint32_t)(key * LIGHT_SIDES + 2 * axis + (c < 0));
  }
}

// From keys to cells, which are asked to come nearer.
static inline void ready_fetch(ready_work *w, const light_memory *m) {
  for (int i = 0; i < LANES; i++)
    w->cell[i] = m->cell_of[w->cell[i]];
  for (int i = 0; i < LANES; i++) {
    const light_cell *c = &m->cells[w->cell[i]];
    __builtin_prefetch(c);
    __builtin_prefetch(c->last + LIGHT_PARTS_MOST / 2);
  }
}

// finer of light.c.
static inline double lane_finer(float u, float v, float t) {
  uint32_t a, b, c;
  memcpy(&a, &u, sizeof a);
  memcpy(&b, &v, sizeof b);
  memcpy(&c, &t, sizeof c);
  uint64_t z =
      rng_mix(((uint64_t)a << 32 | b) + c * UINT64_C(0x9e3779b97f4a7c15));
  return (double)u + (double)(z >> 32) * 0x1p-56;
}

// How many parts end before a unit, by halves.
static inline uint32_t lane_part(const light_cell *c, uint16_t unit) {
  uint32_t at = 0;
  for (uint32_t half = LIGHT_PARTS_MOST / 2; half > 0; half /= 2)
    at += half & (0 - (uint32_t)(c->last[at + half - 1] < unit));
  return at + (c->last[at] < unit);
}

static inline float lane_share(const light_cell *c, uint32_t part) {
  uint32_t below = part > 0 ? c->last[part - 1] + 1u : 0;
  return (float)(c->last[part] + 1u - below) / LIGHT_UNITS;
}

// light_memory_pick; false where no light is asked.
static inline bool lane_remember(ready_work *w, int i, const light_memory *m,
                                 double u) {
  const light_cell *c = &m->cells[w->cell[i]];
  float one = float_min((float)u, 0x1.fffffep-1f);
  uint32_t part = lane_part(c, (uint16_t)(one * LIGHT_UNITS));
  if (part >= m->parts.count) return false;
  w->r.part[i] = part;
  w->light.share[i] = lane_share(c, part);
  w->light.emitter[i] = m->parts.of[part].emitter;
  return true;
}

// The triangle of a lane, by choose_near of light.c.
static inline const light_triangle *lane_pick(ready_work *w, int i,
                                              const light_set *l, double u) {
  const light_memory *m = l->memory;
  if (m != NULL) {
    if (!lane_remember(w, i, m, u)) return NULL;
    return &m->parts.of[w->r.part[i]].shape;
  }
  light_place at = light_place_of(lanes_at(&w->v.p, i), lanes_at(&w->n, i));
  if (!light_tree_pick(&l->near, &at, u, &w->light.emitter[i],
                       &w->light.share[i]))
    return NULL;
  return &l->near.emitters[w->light.emitter[i]].shape;
}

static inline void ready_pick(ready_work *w, const light_set *l) {
  double choice[LANES];
  for (int i = 0; i < LANES; i++)
    choice[i] = lane_finer(w->r.u[USE_PICK][i], w->r.u[USE_LIGHT][i],
                           w->r.u[USE_LIGHT + 1][i]);
  ready_light *to = &w->light;
  for (int i = 0; i < LANES; i++) {
    const light_triangle *t = NULL;
    w->r.part[i] = LIGHT_NO_PART;
    if (w->r.matt[i] && choice[i] < 1) t = lane_pick(w, i, l, choice[i]);
    w->r.found[i] = t != NULL;
    if (t == NULL) t = &l->near.emitters[0].shape;
    lanes_set(&to->a, i, t->a);
    lanes_set(&to->ab, i, t->ab);
    lanes_set(&to->ac, i, t->ac);
    lanes_set(&to->n, i, t->n);
    lanes_set(&to->middle, i, t->middle);
    to->area[i] = t->area, to->radius[i] = t->radius;
  }
}

#endif
