// skies.h — environments that are hard to sample, in one way each.

#ifndef SKIES_H
#define SKIES_H

#include "arena.h"
#include "env.h"
#include "rng.h"

// Every texel by chance; one texel of 10^6 among equal ones, or among others;
// every fourth row; one color; none; the sky that is no map.
typedef enum sky_look {
  SKY_NOISE,
  SKY_HOT,
  SKY_SUN,
  SKY_STRIPES,
  SKY_EVEN,
  SKY_DARK,
  SKY_BUILT_IN
} sky_look;

typedef struct sky_plan {
  sky_look look;
  int width, height;
  int hot;  // the bright texel
  float rotate;
} sky_plan;

static inline vec3 sky_texel(const sky_plan *p, int i, float x) {
  switch (p->look) {
  case SKY_NOISE: return (vec3){10 * x * x * x, x, x};
  case SKY_HOT: return vec3_all(i == p->hot ? 1e6f : 0.5f);
  case SKY_SUN: return vec3_all(i == p->hot ? 1e6f : x);
  case SKY_STRIPES: return vec3_all(i / p->width % 4 == 0 ? x : 0);
  case SKY_EVEN: return (vec3){1, 2, 3};
  default: return vec3_all(0);
  }
}

static inline env sky_env(const sky_plan *p, arena *mem) {
  bool is_map = p->look != SKY_BUILT_IN;
  env e = {.kind = is_map ? ENV_MAP : ENV_SKY, .scale = 1.5f};
  e.rotate = p->rotate;
  e.map = image_new(mem, p->width, p->height);
  rng r = rng_of(1, (uint64_t)p->look, (uint32_t)p->width);
  for (int i = 0; i < p->width * p->height; i++)
    e.map.pixels[i] = sky_texel(p, i, rng_next(&r));
  return e;
}

#endif
