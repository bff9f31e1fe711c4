// plan_use.h — the plan put to work: what it takes out of a scene, and what it
// tells the engines.

#ifndef PLAN_USE_H
#define PLAN_USE_H

#include "plan.h"
#include "raster_settings.h"

// Take out of the scene what nothing will look at: lamps that give no light,
// an environment that gives none, texture coordinates.
void plan_prune(const plan *p, scene *s);

// Put into the settings what the plan spares.  It must outlive their use.
void plan_settle(const plan *p, raster_settings *set);

// The same for paths.
void plan_settle_paths(const plan *p, path_world *world);

// Paths that are not followed, for scenes without any light: every radiance is
// 0.  Samples lie where those of *real would, which must outlive it.
integrator plan_dark(const integrator *real);

#endif
