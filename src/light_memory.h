// light_memory.h — which lights are seen from where, learned from light
// samples.

#ifndef LIGHT_MEMORY_H
#define LIGHT_MEMORY_H

#include "light_lore.h"
#include "light_part.h"
#include "pool.h"
#include "vec.h"

// What probabilities are counted in.
enum { LIGHT_UNITS = 1 << 16 };

// Whom to ask, in units: part k for numbers after last[k - 1] up to
// last[k], and for those beyond all none.  Two lines of the cache.
typedef struct light_cell {
  uint16_t last[LIGHT_PARTS_MOST];
} light_cell;

// A cell for each place of a grid over the scene and each of six sides that a
// surface may face.
typedef struct light_memory {
  float power[LIGHT_PARTS_MOST];
  float usual[LIGHT_PARTS_MOST];  // of who would be asked without a memory
  uint32_t count;                 // parts
  float rest;  // the irradiance that nobody is asked for, roughly
  vec3 lo;
  float per_unit;     // cells along a unit of length
  uint16_t *cell_of;  // by key
  light_cell *cells;
} light_memory;

// One that has learned nothing: parts, LIGHT_PARTS_MOST at most, by their
// power.  The box is the scene's.  False when it is not such that it could be
// divided.
bool light_memory_new(light_memory *out, const float *power, uint32_t count,
                      vec3 lo, vec3 hi, arena *mem);

// Learn from n records; what was known before is forgotten.  The result is how
// many times as fast memory takes noise away, by what the records say of
// themselves.
double light_memory_learn(light_memory *m, const light_record *records,
                          size_t n, arena *mem, pool *threads);

// The axis that a normal runs along, twice, and 1 more where it runs down.
static inline uint32_t light_side(vec3 n) {
  vec3 a = vec3_abs(n);
  int axis = a.x >= a.y ? (a.x >= a.z ? 0 : 2) : (a.y >= a.z ? 1 : 2);
  return 2 * (uint32_t)axis + (vec3_axis(n, axis) < 0);
}

uint32_t light_memory_key(const light_memory *m, vec3 p, vec3 n);

// Let a cell come nearer, for a question soon; or that of a key.
static inline void light_cell_fetch(const light_cell *c) {
  __builtin_prefetch(c);
  __builtin_prefetch(c->last + LIGHT_PARTS_MOST / 2);
}

static inline void light_memory_fetch(const light_memory *m, uint32_t key) {
  light_cell_fetch(&m->cells[m->cell_of[key]]);
}

// A part by u in [0, 1), with its probability, for a surface at p that faces
// n; false when no light is to be asked.
bool light_memory_pick(const light_memory *m, uint32_t key, float u,
                       uint32_t *part, float *share);

// The probability of a part.
float light_memory_share(const light_memory *m, uint32_t key, uint32_t part);

#endif
