// ready_sky_way.h — sixteen directions to an environment:
// light_env_sample_cell, step by step.

#ifndef READY_SKY_WAY_H
#define READY_SKY_WAY_H

#include "ready_sky.h"

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
    c->x[i] =
        lane_slope(a00 * (1 - y) + a10 * y, a01 * (1 - y) + a11 * y, w->u1[i]);
  }
  for (int i = 0; i < LANES; i++) {
    float row = (float)c->row[i], top = c->row[i] > 0 ? row - 0.5f : 0;
    float left = (float)c->column[i] - 0.5f;
    float u = (left + c->x[i]) / width - rotate;
    float v = (top + c->high[i] * c->y[i]) / height;
    vec2 around = lane_circle(u - lane_floor(u)), down = lane_circle(0.5f * v);
    w->v[i] = v;
    lanes_set(&w->wi, i, (vec3){-around.y * down.y, down.x, around.x * down.y});
  }
}

// All of sixteen spots.
static inline void sky_find(sky_ways *w, const light_env *l,
                            const light_env_spot *const spots[LANES]) {
  for (int i = 0; i < LANES; i++) {
    const light_env_spot *s = spots[i];
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
  for (int i = 0; i < LANES; i++) {
    float pdf = w->cell.mean[i] > 0 ? w->pdf[i] : 0;
    int found = (pdf > 0) & (pdf < INFINITY);
    w->pdf[i] = found ? pdf : 0;
  }
}

#endif
