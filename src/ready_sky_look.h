// ready_sky_look.h — what is seen of an environment in many directions.

#ifndef READY_SKY_LOOK_H
#define READY_SKY_LOOK_H

#include "ready_keys.h"
#include "ready_pick.h"
#include "ready_sky.h"

// Sixteen looks: direction, and where the map has it; the texels that a lookup
// reads, and the cell of the table.
typedef struct sky_view {
  lanes3 d, radiance;
  int32_t blind[LANES];  // no direction at all
  float u[LANES], v[LANES];
  int32_t left[LANES], top[LANES];
  float x[LANES], y[LANES];
  sky_texels texels;
  sky_cells cell;
  sky_kinds kinds;
  uint32_t known[LANES];  // cell of the memory
  float share[LANES], part[LANES];  // probabilities of the cell and its part
  float pdf[LANES];
} sky_view;

// vec3_unit.
static inline void sky_turn(sky_view *s, const sky_looks *q, size_t from,
                            size_t n) {
  int32_t odd[LANES];
  for (int i = 0; i < LANES; i++) {
    size_t k = from + (size_t)i < n ? from + (size_t)i : n - 1;
    lanes_set(&s->d, i, q->d[k]);
  }
  for (int i = 0; i < LANES; i++) {
    odd[i] = 0;
    vec3 unit = lane_unit(lanes_at(&s->d, i), &odd[i]);
    s->blind[i] = 0;
    if (!odd[i]) lanes_set(&s->d, i, unit);
  }
  for (int i = 0; i < LANES; i++) {
    if (!odd[i]) continue;
    vec3 d = vec3_unit(lanes_at(&s->d, i));
    s->blind[i] = !vec3_finite(d);
    lanes_set(&s->d, i, s->blind[i] ? (vec3){0, 1, 0} : d);
  }
}

// env_uv.
static inline void sky_place(sky_view *s) {
  for (int i = 0; i < LANES; i++) {
    vec3 d = lanes_at(&s->d, i);
    float u = lane_turns(d.x, -d.z) + 0.5f;
    float flat = sqrtf(d.x * d.x + d.z * d.z);
    s->u[i] = u < 1 ? u : u - 1;
    s->v[i] = 2 * lane_turns(flat, d.y);
  }
}

// corners_at of env.c.
static inline void sky_lookup(sky_view *s, const env *e) {
  const float width = (float)e->map.width, height = (float)e->map.height;
  for (int i = 0; i < LANES; i++) {
    float u = s->u[i] + e->rotate;
    float x = (u - lane_floor(u)) * width - 0.5f;
    float y = s->v[i] * height - 0.5f;
    float left = lane_floor(x), top = lane_floor(y);
    s->left[i] = (int)left, s->top[i] = (int)top;
    s->x[i] = x - left, s->y[i] = y - top;
  }
}

// The texels of a lookup, in lane i.
static inline void sky_read(sky_view *s, int i, const env *e) {
  const image *m = &e->map;
  int x0 = s->left[i], y0 = s->top[i], last = m->height - 1;
  int above = y0 < 0 ? 0 : y0 < last ? y0 : last;
  int below = y0 < last ? y0 + 1 : last;
  int left = x0 < 0 ? m->width - 1 : x0 < m->width ? x0 : 0;
  int right = left + 1 < m->width ? left + 1 : 0;
  sky_gather(&s->texels, i, m->pixels + (size_t)above * (size_t)m->width,
             m->pixels + (size_t)below * (size_t)m->width, left, right);
}

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

// Texels of lookups, and probabilities of cells, are asked to come nearer.
static inline void sky_expect_texels(const sky_view *s, const image *m) {
  for (int i = 0; i < LANES; i++) {
    size_t left = s->left[i] < 0 ? 0 : (size_t)s->left[i];
    int top = s->top[i] < 0 ? 0 : s->top[i];
    int below = s->top[i] + 1 < m->height ? s->top[i] + 1 : m->height - 1;
    const vec3 *a = m->pixels + (size_t)top * (size_t)m->width + left;
    const vec3 *b = m->pixels + (size_t)below * (size_t)m->width + left;
    __builtin_prefetch(a);
    __builtin_prefetch(b);
    __builtin_prefetch(&a[1].z);
    __builtin_prefetch(&b[1].z);
  }
}

static inline void sky_expect_cells(const sky_view *s, const light_env *e) {
  for (int i = 0; i < LANES; i++) {
    const pick *columns = &e->columns[s->cell.row[i]];
    __builtin_prefetch(&columns->upto[s->cell.column[i]]);
  }
}

// From where sixteen look: which kinds of light would be asked there, and where
// in the memory that is.
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
  ready_keys(l->memory, &p, &normal, s->known);
  ready_fetch(l->memory, s->known);
}

// Lane i: the probability of the cell, and that its part is asked.
static inline void sky_share(sky_view *s, int i, const light_set *l) {
  const light_env *e = &l->env;
  int column = s->cell.column[i], row = s->cell.row[i];
  float share = pick_share(&e->columns[row], (uint32_t)column);
  s->part[i] = 1;
  if (!sky_known(l)) {
    s->share[i] = share * pick_share(&e->rows, (uint32_t)row);
    return;
  }
  const light_sky *k = &l->sky;
  uint32_t part =
      k->part_of[(row >> k->shift) * k->across + (column >> k->shift)];
  const light_sky_part *p = &k->parts[part];
  s->share[i] = share * p->of_row[row - p->row].each;
  s->part[i] = lane_share(&l->memory->cells[s->known[i]], part);
}

// Whether the texels of lane i's cell are those of its lookup: they are, but
// where rounding divides them.
static inline bool sky_same(const sky_view *s, int i, const image *m) {
  int right = s->left[i] + 1 < m->width ? s->left[i] + 1 : 0;
  return s->cell.column[i] == right && s->cell.row[i] == s->top[i] + 1;
}

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

// The density of a light sample where there could have been one.
static inline void sky_rival(sky_view *s, const light_set *l, sky_looks *q,
                             size_t from, int n) {
  const bool map = env_has_map(l->env.env);
  if (map) s->cell.texels = s->texels;
  for (int i = 0; i < n; i++) {
    if (!q->rival[from + (size_t)i]) continue;
    sky_share(s, i, l);
    sky_rows(&s->cell, i, &l->env);
    if (!map || !sky_same(s, i, &l->env.map)) sky_corners(&s->cell, i, &l->env);
  }
  sky_weigh(&s->cell, &l->env);
  sky_density(&s->cell, &l->env, s->v, s->share, s->pdf);
  for (int i = 0; i < n; i++) {
    size_t k = from + (size_t)i;
    if (!q->rival[k] || s->blind[i]) continue;
    float pdf = s->pdf[i] < INFINITY ? s->pdf[i] : 0;
    q->pdf[k] = s->kinds.sky[i] * pdf * s->part[i];
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
  sky_cell_at(s, &l->env);
  sky_expect_cells(s, &l->env);
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
