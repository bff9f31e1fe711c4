// light_emission.h — what shines in a scene.

#ifndef LIGHT_EMISSION_H
#define LIGHT_EMISSION_H

#include "light_bound.h"
#include "scene.h"

// One number for a colour.
float light_mean(vec3 c);

// The radiance of the front side of a triangle where b and c weigh its corners
// 1 and 2, less where it is only partly opaque.
vec3 light_emission(const scene *s, uint32_t triangle, float b, float c);

// The shining triangles, rising, and the point lights if asked for: an array
// for array_free.
light_emitter *light_emitters(const scene *s, bool points, uint32_t *count);

#endif
