// ready_sky.h — sixteen cells of the table of an environment.
//
// The arithmetic is that of light_env.c, step by step.  Compiled once a level,
// as wide_kernel.h is.

#ifndef READY_SKY_H
#define READY_SKY_H

#include "path_sky.h"
#include "ready_num.h"

// Four texels around each of sixteen places: above left and right, below left
// and right.
typedef struct sky_texels {
  lanes3 at[4];
} sky_texels;

// Cells, where in each of them a place is, and what the table holds of its
// texels and of all of them together.
typedef struct sky_cells {
  int32_t column[LANES], row[LANES];
  float x[LANES], y[LANES];
  sky_texels texels;
  float above[LANES], below[LANES];  // scale of the rows
  float a[4][LANES], mean[LANES];
  float high[LANES];  // of the cell, over that of most
} sky_cells;

static inline void sky_gather(sky_texels *t, int i, const vec3 *above,
                              const vec3 *below, int left, int right) {
  lanes_set(&t->at[0], i, above[left]);
  lanes_set(&t->at[1], i, above[right]);
  lanes_set(&t->at[2], i, below[left]);
  lanes_set(&t->at[3], i, below[right]);
}

// The rows of texels above and below lane i, and their scale.
static inline int row_above(const sky_cells *c, int i) {
  return c->row[i] > 0 ? c->row[i] - 1 : 0;
}

static inline int row_below(const sky_cells *c, int i, const light_env *l) {
  int last = l->map.height - 1;
  return c->row[i] < last ? c->row[i] : last;
}

static inline void sky_rows(sky_cells *c, int i, const light_env *l) {
  c->above[i] = l->scale[row_above(c, i)];
  c->below[i] = l->scale[row_below(c, i, l)];
}

// And its texels: corners_of.
static inline void sky_corners(sky_cells *c, int i, const light_env *l) {
  const image *m = &l->map;
  size_t above = (size_t)row_above(c, i), below = (size_t)row_below(c, i, l);
  int column = c->column[i], left = column > 0 ? column - 1 : m->width - 1;
  size_t width = (size_t)m->width;
  sky_gather(&c->texels, i, m->pixels + above * width,
             m->pixels + below * width, left, column);
}

// cell_of, cell_mean and cell_height.
static inline void sky_weigh(sky_cells *c, const light_env *l) {
  const float less = l->less, third = 1.0f / 3;
  const int last = l->map.height;
  for (int k = 0; k < 4; k++) {
    const float *scale = k < 2 ? c->above : c->below;
    for (int i = 0; i < LANES; i++) {
      vec3 t = lanes_at(&c->texels.at[k], i);
      float bright = t.x * third + t.y * third + t.z * third;
      c->a[k][i] = float_max(bright - less, 0) * scale[i];
    }
  }
  for (int i = 0; i < LANES; i++) {
    int edge = (c->row[i] == 0) | (c->row[i] == last);
    c->mean[i] = 0.25f * (c->a[0][i] + c->a[1][i] + c->a[2][i] + c->a[3][i]);
    c->high[i] = edge ? 0.5f : 1;
  }
}

// cell_pdf and per_steradian, at v; share is that of the cell.
static inline void sky_density(const sky_cells *c, const light_env *l,
                               const float *v, const float *share, float *pdf) {
  const float cells = (float)l->map.width * (float)l->map.height;
  for (int i = 0; i < LANES; i++) {
    float x = c->x[i], y = c->y[i], part = share[i] / c->high[i];
    float top = c->a[0][i] * (1 - x) + c->a[1][i] * x;
    float low = c->a[2][i] * (1 - x) + c->a[3][i] * x;
    float value = top * (1 - y) + low * y, mean = c->mean[i];
    float flat = part * cells * value / mean;
    float sine = lane_circle(0.5f * v[i]).y;
    flat = mean > 0 ? flat : 0;
    pdf[i] = sine > 0 ? flat / (2 * PI * PI * sine) : 0;
  }
}

// Bilinear, at x and y.
static inline void sky_blend(const sky_texels *t, const float *x,
                             const float *y, float scale, lanes3 *out) {
  for (int i = 0; i < LANES; i++) {
    vec3 above =
        vec3_lerp(lanes_at(&t->at[0], i), lanes_at(&t->at[1], i), x[i]);
    vec3 below =
        vec3_lerp(lanes_at(&t->at[2], i), lanes_at(&t->at[3], i), x[i]);
    lanes_set(out, i, vec3_scale(vec3_lerp(above, below, y[i]), scale));
  }
}

#endif
