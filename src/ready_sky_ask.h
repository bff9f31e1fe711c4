// ready_sky_ask.h — light_sample_at for many where an environment shines.

#ifndef READY_SKY_ASK_H
#define READY_SKY_ASK_H

#include "ready_sky_list.h"
#include "ready_sky_way.h"

// Sixteen of them from number `first` on get their answers.
static inline void sky_tell(const light_set *l, const sky_list *list,
                            size_t first, path_ready *r) {
  const light_env_spot *spots[LANES];
  const env *e = l->env.env;
  sky_ways w;
  for (size_t i = 0; i < LANES; i++)
    spots[i] = &list->spots[first + i < list->count ? first + i : first];
  sky_find(&w, sky_table(l), spots);
  for (size_t i = 0; i < LANES && first + i < list->count; i++) {
    size_t k = first + i, who = list->who[k];
    light_sample s = {.part = list->part[k], .chosen = list->chosen[k]};
    s.pdf = w.pdf[i] * s.chosen;
    s.wi = lanes_at(&w.wi, (int)i);
    s.radiance = lanes_at(&w.radiance, (int)i);
    if (e->kind != ENV_MAP) s.radiance = env_radiance(e, s.wi);
    sky_answer(&r[who / LANES], (int)(who % LANES), &s);
  }
}

static void sky_ask_kernel(const light_set *l, path_ready *r, size_t n) {
  sky_list list = {.count = 0};
  sky_choice choice[LIGHT_TOGETHER / LANES];
  for (size_t k = 0; k < n; k += LANES) {
    sky_choice *c = &choice[k / LANES];
    path_ready *of = &r[k / LANES];
    of->lit = true;
    if (sky_known(l)) ready_keys(l->memory, &of->p, &of->n, c->cell);
    if (sky_known(l)) ready_fetch(l->memory, c->cell);
    sky_kinds_at(l, &of->p, &of->n, &c->kinds);
  }
  for (size_t k = 0; k < n; k += LANES)
    sky_choose(l, &r[k / LANES], k, &choice[k / LANES], &list);
  if (sky_known(l))
    light_sky_spots(&l->sky, list.part, list.u, list.count, list.spots);
  else
    light_env_spots(&l->env, list.u, list.count, list.spots);
  for (size_t k = 0; k < list.count; k += LANES)
    sky_tell(l, &list, k, r);
}

#endif
