// matter.h — from a material with its textures to the one scattering function
// that a path meets.

#ifndef MATTER_H
#define MATTER_H

#include "bsdf.h"
#include "surface.h"

// A scattering function chosen at random among those that a material is made
// of.  weight, the share of the chosen one over its probability, multiplies
// the path.
typedef struct matter {
  bsdf bsdf;
  vec3 weight;
} matter;

// The table that metallic-roughness needs, of one set of formulas; NULL when no
// material of the scene is of that kind.
const dfg *matter_table(const scene *s, pbr_model model, arena *mem,
                        pool *threads);

// The same for materials that stay as they are: no more of it than their
// roughness asks for.
const dfg *matter_table_as_is(const scene *s, pbr_model model, arena *mem,
                              pool *threads);

// Choose by u for a viewer at cosine cos_o to the shading normal.  glass.eta
// is that of a viewer outside.
matter matter_choose(const dfg *table, const surface *s, float cos_o, float u);

// Whether some of it may go straight through; what does not, in [0, 1].
bool matter_passes(const surface *s);
float matter_opacity(const surface *s);

// Radiance emitted on the front side.
vec3 matter_emission(const surface *s);

// Whether it is matt and nothing else, as seen from anywhere.
bool matter_matt(const surface *s);

// The base colour, for the picture of albedo: kd or ks, textured; white for
// glass.
vec3 matter_albedo(const surface *s);

#endif
