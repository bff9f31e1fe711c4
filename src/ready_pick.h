// ready_pick.h — which shining triangle each lane asks.

#ifndef READY_PICK_H
#define READY_PICK_H

#include "ready_keys.h"
#include "ready_leaf.h"

// How many parts end before a unit, by halves.
static inline uint32_t lane_part(const light_cell *c, uint16_t unit) {
  uint32_t at = 0;
  for (uint32_t half = LIGHT_PARTS_MOST / 2; half > 0; half /= 2)
    at += half & (0 - (uint32_t)(c->last[at + half - 1] < unit));
  return at + (c->last[at] < unit);
}

static inline float lane_share(const light_cell *c, uint32_t part) {
  uint32_t before = c->last[part > 0 ? part - 1 : 0];
  uint32_t below = part > 0 ? before + 1 : 0;
  return (float)(c->last[part] + 1u - below) / LIGHT_UNITS;
}

// A lane's triangle; any where there is none.
static inline void lane_ask(ready_light *to, int i, const light_triangle *t) {
  lanes_set(&to->a, i, t->a);
  lanes_set(&to->ab, i, t->ab);
  lanes_set(&to->ac, i, t->ac);
  lanes_set(&to->n, i, t->n);
  lanes_set(&to->middle, i, t->middle);
  to->area[i] = t->area, to->radius[i] = t->radius;
}

// light_memory_pick.  Whether there is a light to be asked is anybody's guess,
// and a processor's: there is no branch.
static inline void lane_remember(ready_work *w, int i, const light_set *l,
                                 double u) {
  const light_memory *m = l->memory;
  const light_cell *c = &m->cells[w->cell[i]];
  float one = float_min((float)u, FLOAT_BELOW_1);
  uint32_t part = lane_part(c, (uint16_t)(one * LIGHT_UNITS));
  int32_t found = (part < m->count) & (u < 1) & w->r.matt[i];
  part &= 0 - (uint32_t)found;
  w->r.found[i] = found;
  w->r.part[i] = part | ((uint32_t)found - 1);
  w->light.share[i] = lane_share(c, part);
  w->light.emitter[i] = l->parts.of[part].emitter;
  lane_ask(&w->light, i, &l->parts.of[part].shape);
}

// light_tree_pick.
static inline void lane_weigh(ready_work *w, int i, const light_tree *t,
                              double u) {
  uint32_t emitter = 0;
  bool found = w->r.matt[i] && u < 1;
  if (found) {
    light_place at = light_place_of(lanes_at(&w->v.p, i), lanes_at(&w->r.n, i));
    found = light_tree_pick(t, &at, u, &emitter, &w->light.share[i]);
  }
  if (!found) emitter = 0;
  w->r.found[i] = found;
  w->r.part[i] = LIGHT_NO_PART;
  w->light.emitter[i] = emitter;
  lane_ask(&w->light, i, &t->emitters[emitter].shape);
}

// choose_near of light.c.
static inline void ready_pick(ready_work *w, const light_set *l) {
  double choice[LANES];
  for (int i = 0; i < LANES; i++)
    choice[i] = light_finer((vec3){w->r.u[USE_PICK][i], w->r.u[USE_LIGHT][i],
                                   w->r.u[USE_LIGHT + 1][i]});
  for (int i = 0; i < LANES && l->memory != NULL; i++)
    lane_remember(w, i, l, choice[i]);
  if (l->memory != NULL) return;
  const light_tree *t = &l->near;
  if (t->nodes[0].count == 0) {
    for (int i = 0; i < LANES; i++)
      lane_weigh(w, i, t, choice[i]);
    return;
  }
  ready_leaf(w, t, choice);
  for (int i = 0; i < LANES; i++)
    lane_ask(&w->light, i, &t->emitters[w->light.emitter[i]].shape);
}

#endif
