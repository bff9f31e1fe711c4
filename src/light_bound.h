// light_bound.h — about how much light a place may get from a small light or
// from a group of them.

#ifndef LIGHT_BOUND_H
#define LIGHT_BOUND_H

#include "light_triangle.h"

#include <stdint.h>

// A shining triangle or a point light, whose triangle is all in one point.
typedef struct light_emitter {
  light_triangle shape;
  bool is_point;
  float power;      // irradiance times distance squared, straight ahead, mean
                    // of R, G, B
  uint32_t source;  // triangle of the mesh, or light of the scene
} light_emitter;

// Emitters in a sphere, whose normals lie in a cone about axis.
typedef struct light_group {
  vec3 middle;
  float radius;
  vec3 axis;
  float cos_cone, sin_cone;  // cos -1: all directions
  float power;
} light_group;

// What a choice of lights depends on: a point, and the normal of what is lit
// there, zero when it is lit from all sides.
typedef struct light_place {
  vec3 p, n;
  bool all_around;
} light_place;

light_place light_place_of(vec3 p, vec3 n);

// Near an upper bound of the irradiance, and 0 only where none can arrive,
// except from less than LIGHT_LEAST_HEIGHT above a shining triangle.
float light_bound_emitter(const light_emitter *e, const light_place *at);
float light_bound_group(const light_group *g, const light_place *at);

#endif
