// ready_starts.h — where the samples of a row of pixels begin, all at once.

#ifndef READY_STARTS_H
#define READY_STARTS_H

#include "ready_numbers.h"

// sampler_of each pixel.
static inline void starts_keys(sixteen_keys *k, uint64_t seed,
                               const path_row *row) {
  uint32_t lo[LANES], hi[LANES];
  for (int i = 0; i < LANES; i++) {
    uint64_t key = rng_of(seed, row->pixel + (uint64_t)i, 0).key;
    lo[i] = (uint32_t)key;
    hi[i] = (uint32_t)(key >> 32);
  }
  memcpy(&k->lo, lo, sizeof lo);
  memcpy(&k->hi, hi, sizeof hi);
  k->index = row->sample + (sixteen){0};
  k->bits = row->sample;
  k->kind = SAMPLER_SOBOL;
}

// Where in its pixel each lies, sampler_2 of all, and camera_ray.
static void starts_kernel(uint64_t seed, const path_row *row, path_start *out) {
  const camera_view view = *row->view;
  sixteen_keys k;
  float x[LANES], y[LANES];
  int32_t odd[LANES];
  lanes3 d;
  starts_keys(&k, seed, row);
  sixteen_number(&k, 0, &k.index, x);
  sixteen_number(&k, 1, &k.index, y);
  for (int i = 0; i < LANES; i++) {
    x[i] = (float)(row->x + i) + x[i];
    y[i] = (float)row->y + y[i];
    odd[i] = 0;
    lanes_set(&d, i, lane_unit(camera_way(&view, x[i], y[i]), &odd[i]));
  }
  for (int i = 0; i < row->count; i++) {
    ray r = ray_from(view.eye, lanes_at(&d, i));
    if (odd[i]) r = camera_ray(&view, x[i], y[i]);
    out[i] = (path_start){r, row->pixel + (uint64_t)i, row->sample};
  }
}

_Static_assert((int)PATH_ROW == (int)LANES, "a lane a pixel");

#endif
