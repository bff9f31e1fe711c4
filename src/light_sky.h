// light_sky.h — an environment in parts, so that a place may ask those that it
// sees.

#ifndef LIGHT_SKY_H
#define LIGHT_SKY_H

#include "light_env.h"
#include "light_part.h"

// The cells that a part has in one row: from which unit of the row up to
// which, and the probability of a cell if the part is asked, over that in the
// row.
typedef struct light_sky_row {
  uint32_t first, last;
  float each;
} light_sky_row;

typedef struct light_sky_part {
  int row;  // the first one
  pick rows;
  light_sky_row *of_row;
} light_sky_part;

// A table, cut into rectangles whose corners are those of tiles, squares of
// 2^shift cells.
typedef struct light_sky {
  const light_env *env;
  light_sky_part parts[LIGHT_PARTS_MOST];
  float power[LIGHT_PARTS_MOST];  // all together 1
  uint32_t count;
  uint8_t *part_of;  // by tile, in rows
  int shift, across;
} light_sky;

// No more parts than `most`, which is 1 to LIGHT_PARTS_MOST; the table must
// stay. False where there is none.
bool light_sky_of(light_sky *out, const light_env *of, uint32_t most,
                  arena *mem);

// The shares that its parts have of what another table over the same map holds.
void light_sky_usual(const light_sky *s, const light_env *of, float *power);

// A direction of a part by two uniform numbers, with its density there.
env_sample light_sky_sample(const light_sky *s, uint32_t part, vec2 u);

// The same for n of them, which wait for tables together.
void light_sky_samples(const light_sky *s, const uint32_t *part, const vec2 *u,
                       size_t n, env_sample *out);

// The cells of these, LIGHT_TOGETHER at most.
void light_sky_spots(const light_sky *s, const uint32_t *part, const vec2 *u,
                     size_t n, light_env_spot *out);

// What a part has in the table, over the density of light_sky_sample: the
// same all over it.
float light_sky_worth(const light_sky *s, uint32_t part);

// The part in which the unit direction whose env_uv is uv lies, and the density
// of light_sky_sample there.
float light_sky_density(const light_sky *s, vec2 uv, uint32_t *part);

#endif
