// aim_photon.h — light followed from the lamps by mirrors and glass to where it
// comes down.

#ifndef AIM_PHOTON_H
#define AIM_PHOTON_H

#include "light.h"
#include "path_world.h"
#include "pool.h"

// Light that has come down at x on a surface that faces n, from the point y of
// the last mirror or glass: its radiance, the power that it would stand for if
// it had been the only try, the cosine at x, and where it began: the stretch,
// and whether behind the triangle.
typedef struct aim_photon {
  vec3 x, n, y;
  float radiance, power, cosine;
  uint32_t stretch;
  bool behind;
} aim_photon;

typedef struct aim_photons {
  aim_photon *of;
  size_t count;
  double tries;  // so many, over all mirrors and glass, would bring as much
} aim_photons;

// Where light may take that way: mirrors and glass of a scene, by area, which
// in the order of triangles is cut into so many equal stretches.
enum { AIM_STRETCHES = 128 };
typedef struct aim_mirrors aim_mirrors;

// NULL when there are none, or no light that could be seen in them.
const aim_mirrors *aim_mirrors_of(const path_world *world, const light_set *l,
                                  arena *mem);

// Those of so many tries, numbered, that come down on what is not black, in
// mem.
typedef struct aim_tries {
  uint64_t seed;
  size_t from, to;
} aim_tries;

aim_photons aim_photons_of(const aim_mirrors *m, const aim_tries *t, arena *mem,
                           pool *threads);

// The first, and more: the tries are cut down to the stretches in or near which
// some of the first began, and to the sides on which they did.
aim_photons aim_photons_more(const aim_mirrors *m, const aim_photons *first,
                             const aim_tries *t, arena *mem, pool *threads);

#endif
