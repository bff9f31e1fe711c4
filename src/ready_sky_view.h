// ready_sky_view.h — sixteen directions, and where the map of an environment
// has them.

#ifndef READY_SKY_VIEW_H
#define READY_SKY_VIEW_H

#include "ready_sky.h"
#include "ready_sky_kinds.h"

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
  uint32_t known[LANES], of[LANES];  // cell of the memory, part of the table
  float share[LANES], part[LANES];   // probabilities of the cell and its part
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

// Texels are asked to come nearer.
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

#endif
