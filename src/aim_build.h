// aim_build.h — what to aim at, from light that went the other way.

#ifndef AIM_BUILD_H
#define AIM_BUILD_H

#include "aim.h"
#include "aim_photon.h"

// The map that photons in a box make, in mem; keen is left 0.
void aim_build(aim_map *out, const aim_photons *photons, vec3 lo, vec3 hi,
               arena *mem);

#endif
