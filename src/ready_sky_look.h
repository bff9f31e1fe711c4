// ready_sky_look.h — what is seen of an environment in many directions.

#ifndef READY_SKY_LOOK_H
#define READY_SKY_LOOK_H

#include "ready_sky_rival.h"

// What is seen.
static inline void sky_show(sky_view *s, const env *e, sky_looks *q,
                            size_t from, int n) {
  const bool map = env_has_map(e);
  for (int i = 0; i < LANES && map; i++)
    sky_read(s, i, e);
  if (map) sky_blend(&s->texels, s->x, s->y, e->scale, &s->radiance);
  for (int i = 0; i < n; i++) {
    vec3 *to = &q->radiance[from + (size_t)i];
    *to = map ? lanes_at(&s->radiance, i) : env_radiance(e, lanes_at(&s->d, i));
    if (s->blind[i]) *to = vec3_all(0);
  }
}

// Find where sixteen look, and ask for all that is there.
static inline void sky_aim(sky_view *s, const light_set *l, const sky_looks *q,
                           size_t from, size_t n, bool table) {
  const env *e = &l->scene->env;
  sky_turn(s, q, from, n);
  sky_place(s);
  if (env_has_map(e)) sky_lookup(s, e);
  if (env_has_map(e)) sky_expect_texels(s, &e->map);
  if (!table) return;
  sky_cell_at(s, sky_table(l));
  sky_expect_cells(s, sky_table(l));
  sky_stand(s, l, q, from, n);
}

static void sky_look_kernel(const light_set *l, sky_looks *q, size_t n) {
  sky_view views[LIGHT_TOGETHER / LANES];
  bool any = false;
  for (size_t k = 0; k < n; k++) {
    any |= q->rival[k];
    q->pdf[k] = 0;
  }
  const bool table = any && l->env.irradiance > 0;
  for (size_t from = 0; from < n; from += LANES)
    sky_aim(&views[from / LANES], l, q, from, n, table);
  for (size_t from = 0; from < n; from += LANES) {
    int some = n - from < LANES ? (int)(n - from) : LANES;
    sky_show(&views[from / LANES], &l->scene->env, q, from, some);
    if (table) sky_rival(&views[from / LANES], l, q, from, some);
  }
}

#endif
