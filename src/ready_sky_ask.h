// ready_sky_ask.h — light_sample_at for many where an environment shines.

#ifndef READY_SKY_ASK_H
#define READY_SKY_ASK_H

#include "ready_keys.h"
#include "ready_pick.h"
#include "ready_sky.h"

// Those who ask the environment: which vertex each is, and what it asks.
typedef struct sky_list {
  size_t count;
  uint32_t who[LIGHT_TOGETHER], part[LIGHT_TOGETHER];
  float chosen[LIGHT_TOGETHER];
  vec2 u[LIGHT_TOGETHER];
  light_env_spot spots[LIGHT_TOGETHER];
} sky_list;

static inline void sky_note(sky_list *list, size_t who, uint32_t part,
                            float chosen, vec2 u) {
  size_t k = list->count++;
  list->who[k] = (uint32_t)who;
  list->part[k] = part;
  list->chosen[k] = chosen;
  list->u[k] = u;
}

// One that other lights have answered, or nobody.
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

// Where there are several kinds of light.
static inline void sky_ask_kinds(const light_set *l, path_ready *r, size_t n,
                                 sky_list *list) {
  for (size_t k = 0; k < n; k++) {
    path_ready *of = &r[k / LANES];
    int i = (int)(k % LANES);
    light_sample s;
    if (!of->matt[i]) continue;
    vec3 u = {of->u[USE_PICK][i], of->u[USE_LIGHT][i], of->u[USE_LIGHT + 1][i]};
    light_question q = {lanes_at(&of->p, i), lanes_at(&of->n, i), u};
    if (light_ask_all_but_env(l, &q, &s))
      sky_note(list, k, s.part, s.chosen, (vec2){u.y, u.z});
    else
      sky_answer(of, i, &s);
  }
}

// choose_env: whom each of sixteen asks by memory, and with what probability.
static inline void sky_remember(const light_memory *m, path_ready *r,
                                const uint32_t *cell) {
  for (int i = 0; i < LANES; i++) {
    vec3 u = {r->u[USE_PICK][i], r->u[USE_LIGHT][i], r->u[USE_LIGHT + 1][i]};
    const light_cell *c = &m->cells[cell[i]];
    float one = float_min((float)light_finer(u), FLOAT_BELOW_1);
    uint32_t part = lane_part(c, (uint16_t)(one * LIGHT_UNITS));
    int32_t found = (part < m->count) & r->matt[i];
    part &= 0 - (uint32_t)found;
    r->found[i] = found;
    r->part[i] = part | ((uint32_t)found - 1);
    r->chosen[i] = lane_share(c, part);
  }
}

// Where nothing else shines.
static inline void sky_ask_alone(const light_set *l, path_ready *r, size_t n,
                                 sky_list *list) {
  const light_memory *m = l->memory;
  const size_t groups = (n + LANES - 1) / LANES;
  uint32_t cell[LIGHT_TOGETHER / LANES][LANES];
  for (size_t g = 0; m != NULL && g < groups; g++) {
    ready_keys(m, &r[g].p, &r[g].n, cell[g]);
    ready_fetch(m, cell[g]);
  }
  for (size_t g = 0; g < groups; g++) {
    if (m != NULL) sky_remember(m, &r[g], cell[g]);
    for (int i = 0; i < LANES; i++) {
      vec2 u = {r[g].u[USE_LIGHT][i], r[g].u[USE_LIGHT + 1][i]};
      if (m == NULL && r[g].matt[i])
        sky_note(list, g * LANES + (size_t)i, LIGHT_NO_PART, 1, u);
      if (m != NULL && r[g].found[i])
        sky_note(list, g * LANES + (size_t)i, r[g].part[i], r[g].chosen[i], u);
    }
  }
}

// sample_slope.
static inline float lane_slope(float a, float b, float u) {
  float t = u * (a + b) / (a + sqrtf(a * a * (1 - u) + b * b * u));
  return float_min(t, FLOAT_BELOW_1);
}

// Sixteen directions: from two numbers, places in cells.
typedef struct sky_ways {
  sky_cells cell;
  float u1[LANES], u2[LANES], share[LANES], v[LANES], pdf[LANES];
  lanes3 wi, radiance;
} sky_ways;

// light_env_sample_cell, as far as wi.
static inline void sky_direct(sky_ways *w, const light_env *l) {
  sky_cells *c = &w->cell;
  const float width = (float)l->map.width, height = (float)l->map.height;
  const float rotate = l->env->rotate;
  for (int i = 0; i < LANES; i++) {
    float a00 = c->a[0][i], a01 = c->a[1][i], a10 = c->a[2][i];
    float a11 = c->a[3][i];
    float y = lane_slope(a00 + a01, a10 + a11, w->u2[i]);
    c->y[i] = y;
    c->x[i] = lane_slope(a00 * (1 - y) + a10 * y, a01 * (1 - y) + a11 * y,
                         w->u1[i]);
  }
  for (int i = 0; i < LANES; i++) {
    float row = (float)c->row[i], top = c->row[i] > 0 ? row - 0.5f : 0;
    float left = (float)c->column[i] - 0.5f;
    float u = (left + c->x[i]) / width - rotate;
    float v = (top + c->high[i] * c->y[i]) / height;
    vec2 around = lane_circle(u - lane_floor(u)), down = lane_circle(0.5f * v);
    w->v[i] = v;
    lanes_set(&w->wi, i,
              (vec3){-around.y * down.y, down.x, around.x * down.y});
  }
}

// light_env_sample_cell of sixteen spots from number `first` on; lanes beyond
// the last one hold it again.
static inline void sky_find(sky_ways *w, const light_env *l,
                            const sky_list *list, size_t first) {
  for (int i = 0; i < LANES; i++) {
    size_t k = first + (size_t)i;
    const light_env_spot *s = &list->spots[k < list->count ? k : first];
    w->cell.column[i] = s->column, w->cell.row[i] = s->row;
    w->u1[i] = s->u.x, w->u2[i] = s->u.y;
    w->share[i] = s->share;
    sky_rows(&w->cell, i, l);
    sky_corners(&w->cell, i, l);
  }
  sky_weigh(&w->cell, l);
  sky_direct(w, l);
  sky_density(&w->cell, l, w->v, w->share, w->pdf);
  sky_blend(&w->cell.texels, w->cell.x, w->cell.y, l->env->scale, &w->radiance);
}

// One of them to the vertex that asked.
static inline void sky_tell(const sky_ways *w, const light_env *l,
                            const sky_list *list, size_t first, int i,
                            path_ready *r) {
  size_t k = first + (size_t)i;
  path_ready *of = &r[list->who[k] / LANES];
  int to = (int)(list->who[k] % LANES);
  float pdf = w->cell.mean[i] > 0 ? w->pdf[i] : 0;
  light_sample s = {.part = list->part[k], .chosen = list->chosen[k]};
  if (pdf > 0 && pdf < INFINITY) {
    s.wi = lanes_at(&w->wi, i);
    s.radiance = lanes_at(&w->radiance, i);
    if (l->env->kind != ENV_MAP) s.radiance = env_radiance(l->env, s.wi);
    s.pdf = pdf * s.chosen;
  }
  sky_answer(of, to, &s);
}

static void sky_ask_kernel(const light_set *l, path_ready *r, size_t n) {
  sky_list list = {.count = 0};
  sky_ways w;
  for (size_t g = 0; g < (n + LANES - 1) / LANES; g++) {
    r[g].lit = true;
    memset(r[g].found, 0, sizeof r[g].found);
  }
  if (l->near.count == 0 && l->far_count == 0)
    sky_ask_alone(l, r, n, &list);
  else
    sky_ask_kinds(l, r, n, &list);
  if (l->memory != NULL && l->sky.count > 0)
    light_sky_spots(&l->sky, list.part, list.u, list.count, list.spots);
  else
    light_env_spots(&l->env, list.u, list.count, list.spots);
  for (size_t first = 0; first < list.count; first += LANES) {
    size_t left = list.count - first;
    sky_find(&w, &l->env, &list, first);
    for (int i = 0; i < LANES && (size_t)i < left; i++)
      sky_tell(&w, &l->env, &list, first, i, r);
  }
}

#endif
