// ready_keys.h — where in the memory of lights each lane is.

#ifndef READY_KEYS_H
#define READY_KEYS_H

#include "ready_work.h"

static inline int lane_step(float x) {
  return (int)float_min(x > 0 ? x : 0, LIGHT_GRID - 1);
}

// light_memory_key.
static inline void ready_keys(const light_memory *m, const lanes3 *from,
                              const lanes3 *normal, uint32_t *key) {
  vec3 lo = m->lo;
  float per_unit = m->per_unit;
  for (int i = 0; i < LANES; i++) {
    vec3 p = lanes_at(from, i), n = lanes_at(normal, i);
    vec3 at = vec3_scale(vec3_sub(p, lo), per_unit), a = vec3_abs(n);
    int place = (lane_step(at.z) * LIGHT_GRID + lane_step(at.y)) * LIGHT_GRID;
    place += lane_step(at.x);
    int from_y = a.y >= a.z ? 1 : 2, from_x = a.x >= a.z ? 0 : 2;
    float c_y = a.y >= a.z ? n.y : n.z, c_x = a.x >= a.z ? n.x : n.z;
    int axis = a.x >= a.y ? from_x : from_y;
    float c = a.x >= a.y ? c_x : c_y;
    key[i] = (uint32_t)(place * LIGHT_SIDES + 2 * axis + (c < 0));
  }
}

// From keys to cells, which are asked to come nearer.
static inline void ready_fetch(const light_memory *m, uint32_t *key) {
  for (int i = 0; i < LANES; i++)
    key[i] = m->cell_of[key[i]];
  for (int i = 0; i < LANES; i++)
    light_cell_fetch(&m->cells[key[i]]);
}

#endif
