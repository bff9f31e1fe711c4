// first_hit.h — what the first surface on a ray looks like by itself.

#ifndef FIRST_HIT_H
#define FIRST_HIT_H

#include "camera.h"
#include "path_world.h"

// What a pixel shows.
typedef enum render_shading {
  RENDER_RADIANCE,
  RENDER_NORMAL,  // (n + 1) / 2 of the shading normal
  RENDER_DEPTH,   // distance along the view axis over that of the farthest
                  // corner of the scene's box; 1 where there is nothing
  RENDER_ALBEDO
} render_shading;

typedef struct first_hit {
  bool found;
  float depth;  // along the view axis
  vec3 normal, albedo;
} first_hit;

first_hit first_hit_of(const path_world *w, const camera_view *v, const ray *r,
                       path_stats *stats);

// The farthest corner of the scene's box along the view axis, so that depth
// means the same in every crop; 1 where nothing lies ahead.
float first_hit_farthest(const scene *s, const camera_view *v);

// What a pixel shows of it where that is not radiance.
vec3 first_hit_shade(const first_hit *f, render_shading of, float farthest);

#endif
