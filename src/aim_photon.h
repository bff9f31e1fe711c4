// aim_photon.h — light followed from the lamps by mirrors and glass to where it
// comes down.

#ifndef AIM_PHOTON_H
#define AIM_PHOTON_H

#include "light.h"
#include "path_world.h"
#include "pool.h"

// Light that has come down at x on a surface that faces n, from the point y of
// the last mirror or glass: its radiance, the power that it stands for, and
// the cosine at x.
typedef struct aim_photon {
  vec3 x, n, y;
  float radiance, power, cosine;
} aim_photon;

typedef struct aim_photons {
  aim_photon *of;
  size_t count;
} aim_photons;

// Where light may take that way: mirrors and glass of a scene, by area.
typedef struct aim_mirrors aim_mirrors;

// NULL when there are none, or no light that could be seen in them.
const aim_mirrors *aim_mirrors_of(const path_world *world, const light_set *l,
                                  arena *mem);

// Those of so many tries that come down on what is not black, in mem.
aim_photons aim_photons_of(const aim_mirrors *m, uint64_t seed, size_t tries,
                           arena *mem, pool *threads);

#endif
