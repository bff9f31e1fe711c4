// ready_sky_rival.h — the density with which a light sample would have found
// what sixteen see: light_pdf_env, step by step.

#ifndef READY_SKY_RIVAL_H
#define READY_SKY_RIVAL_H

#include "ready_sky_list.h"
#include "ready_sky_view.h"

// light_env_place_of.
static inline void sky_cell_at(sky_view *s, const light_env *l) {
  const float width = (float)l->map.width, height = (float)l->map.height;
  const float rotate = l->env->rotate;
  const int columns = l->map.width, last = l->map.height;
  for (int i = 0; i < LANES; i++) {
    float u = s->u[i] + rotate;
    float x = (u - lane_floor(u)) * width + 0.5f;
    float y = s->v[i] * height + 0.5f;
    int column = (int)x, row = (int)y;
    row = row < last ? row : last;
    float in_x = x - (float)column, in_y = y - (float)row;
    float below = float_min(2 * in_y, 1);
    in_y = row == 0 ? 2 * in_y - 1 : in_y;
    s->cell.column[i] = column < columns ? column : 0;
    s->cell.row[i] = row;
    s->cell.x[i] = in_x;
    s->cell.y[i] = row == last ? below : in_y;
  }
}

// Probabilities of cells are asked to come nearer.
static inline void sky_expect_cells(const sky_view *s, const light_env *e) {
  for (int i = 0; i < LANES; i++) {
    const pick *columns = &e->columns[s->cell.row[i]];
    __builtin_prefetch(&columns->upto[s->cell.column[i]]);
  }
}

// From where sixteen look: which kinds of light would be asked there, and where
// in the memory that is, of which one part is looked up.
static inline void sky_stand(sky_view *s, const light_set *l,
                             const sky_looks *q, size_t from, size_t n) {
  lanes3 p, normal;
  for (int i = 0; i < LANES; i++) {
    size_t k = from + (size_t)i < n ? from + (size_t)i : n - 1;
    lanes_set(&p, i, q->from[k]);
    lanes_set(&normal, i, q->from_n[k]);
  }
  sky_kinds_at(l, &p, &normal, &s->kinds);
  if (!sky_known(l)) return;
  const light_memory *m = l->memory;
  const light_sky *k = &l->sky;
  ready_keys(m, &p, &normal, s->known);
  for (int i = 0; i < LANES; i++)
    s->of[i] = k->part_of[(s->cell.row[i] >> k->shift) * k->across +
                          (s->cell.column[i] >> k->shift)];
  for (int i = 0; i < LANES; i++) {
    s->known[i] = m->cell_of[s->known[i]];
    __builtin_prefetch(&m->cells[s->known[i]].last[s->of[i]]);
  }
}

// Lane i: the probability of the cell, and that its part is asked.
static inline void sky_share(sky_view *s, int i, const light_set *l) {
  const light_env *e = sky_table(l);
  int column = s->cell.column[i], row = s->cell.row[i];
  float share = pick_share(&e->columns[row], (uint32_t)column);
  s->part[i] = 1;
  if (!sky_known(l)) {
    s->share[i] = share * pick_share(&e->rows, (uint32_t)row);
    return;
  }
  const light_sky_part *p = &l->sky.parts[s->of[i]];
  s->share[i] = share * p->of_row[row - p->row].each;
  s->part[i] = lane_share(&l->memory->cells[s->known[i]], s->of[i]);
}

// Whether the texels of lane i's cell are those of its lookup: they are, but
// where rounding divides them.
static inline bool sky_same(const sky_view *s, int i, const image *m) {
  int right = s->left[i] + 1 < m->width ? s->left[i] + 1 : 0;
  return s->cell.column[i] == right && s->cell.row[i] == s->top[i] + 1;
}

// The density of a light sample where there could have been one.
static inline void sky_rival(sky_view *s, const light_set *l, sky_looks *q,
                             size_t from, int n) {
  const light_env *e = sky_table(l);
  const bool map = env_has_map(e->env);
  if (map) s->cell.texels = s->texels;
  for (int i = 0; i < n; i++) {
    if (!q->rival[from + (size_t)i]) continue;
    sky_share(s, i, l);
    sky_rows(&s->cell, i, e);
    if (!map || !sky_same(s, i, &e->map)) sky_corners(&s->cell, i, e);
  }
  sky_weigh(&s->cell, e);
  sky_density(&s->cell, e, s->v, s->share, s->pdf);
  for (int i = 0; i < n; i++) {
    size_t k = from + (size_t)i;
    if (!q->rival[k] || s->blind[i]) continue;
    float pdf = s->pdf[i] < INFINITY ? s->pdf[i] : 0;
    q->pdf[k] = s->kinds.sky[i] * pdf * s->part[i];
  }
}

#endif
