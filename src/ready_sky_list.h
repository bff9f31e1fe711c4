// ready_sky_list.h — who of many asks the environment, and which part of it.

#ifndef READY_SKY_LIST_H
#define READY_SKY_LIST_H

#include "ready_keys.h"
#include "ready_pick.h"
#include "ready_sky_kinds.h"

// Those who ask the environment: which vertex each is, and what it asks.
typedef struct sky_list {
  size_t count;
  uint32_t who[LIGHT_TOGETHER], part[LIGHT_TOGETHER];
  float chosen[LIGHT_TOGETHER];
  vec2 u[LIGHT_TOGETHER];
  light_env_spot spots[LIGHT_TOGETHER];
} sky_list;

// What sixteen vertices know before they choose: the kinds of light, and their
// cells of the memory.
typedef struct sky_choice {
  sky_kinds kinds;
  uint32_t cell[LANES];
} sky_choice;

// Whether memory knows parts of the environment.
static inline bool sky_known(const light_set *l) {
  return l->memory != NULL && l->sky.count > 0;
}

// The table that is asked.
static inline const light_env *sky_table(const light_set *l) {
  return sky_known(l) ? l->sky.env : &l->env;
}

static inline void sky_answer(path_ready *r, int i, const light_sample *s) {
  r->found[i] = s->pdf > 0;
  r->delta[i] = s->delta;
  r->has_end[i] = s->has_end;
  r->part[i] = s->part;
  lanes_set(&r->wi, i, s->wi);
  lanes_set(&r->to, i, s->to);
  lanes_set(&r->radiance, i, s->radiance);
  r->pdf[i] = s->pdf, r->chosen[i] = s->chosen;
  r->cosine[i] = vec3_dot(s->wi, lanes_at(&r->n, i));
}

static inline vec3 sky_numbers(const path_ready *r, int i) {
  return (vec3){r->u[USE_PICK][i], r->u[USE_LIGHT][i], r->u[USE_LIGHT + 1][i]};
}

// choose_env: false where nobody is asked.
static inline bool sky_remember(const light_memory *m, uint32_t cell, double u,
                                uint32_t *part, float *share) {
  const light_cell *c = &m->cells[cell];
  float one = float_min((float)u, FLOAT_BELOW_1);
  *part = lane_part(c, (uint16_t)(one * LIGHT_UNITS));
  if (*part >= m->count) return false;
  *share = lane_share(c, *part);
  return true;
}

// light_ask_all_but_env: who of sixteen asks the environment goes on the list.
static inline void sky_choose(const light_set *l, path_ready *r, size_t first,
                              const sky_choice *c, sky_list *list) {
  for (int i = 0; i < LANES; i++) {
    vec3 u = sky_numbers(r, i);
    if (!r->matt[i]) continue;
    double near = (double)c->kinds.near[i], far = (double)c->kinds.far[i];
    double rest = light_finer(u) - near - far;
    light_sample s = {.part = LIGHT_NO_PART};
    float sky = c->kinds.sky[i], share = 1;
    uint32_t part = LIGHT_NO_PART;
    if (rest < 0) {
      light_question q = {lanes_at(&r->p, i), lanes_at(&r->n, i), u};
      light_ask_all_but_env(l, &q, &s);
    } else if (sky > 0 && (!sky_known(l) ||
                           sky_remember(l->memory, c->cell[i],
                                        rest / (double)sky, &part, &share))) {
      size_t k = list->count++;
      list->who[k] = (uint32_t)first + (uint32_t)i;
      list->part[k] = part;
      list->chosen[k] = share * sky;
      list->u[k] = (vec2){u.y, u.z};
      continue;
    }
    sky_answer(r, i, &s);
  }
}

#endif
