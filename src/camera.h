// camera.h — a pinhole: which ray belongs to which point of the picture.

#ifndef CAMERA_H
#define CAMERA_H

#include "error.h"
#include "ray.h"

// As a scene file states it.
typedef struct camera {
  const char *name;  // NULL for the one framed from the bounding box
  vec3 eye, target, up;
  float fov_deg;  // vertical, 0 < fov < 180
} camera;

// Ready to make rays for a film of width x height square pixels.
typedef struct camera_view {
  vec3 eye;
  vec3 corner;       // from eye to the upper left corner of the film plane
  vec3 right, down;  // one pixel to the right and down on that plane
  vec3 forward;      // unit
} camera_view;

// Fails when eye and target coincide, up is along the view, a number is not
// finite, or fov is out of range.
bool camera_view_of(camera_view *out, const camera *c, int width, int height,
                    error *err);

// From the eye to the point (x, y) of the film plane; see camera_ray.
static inline vec3 camera_way(const camera_view *v, float x, float y) {
  return vec3_mad(vec3_mad(v->corner, x, v->right), y, v->down);
}

// The ray through the point (x, y) of the film in pixels, (0, 0) the upper
// left corner of the upper left pixel; unit direction.
ray camera_ray(const camera_view *v, float x, float y);

// A camera that sees the whole box lo..hi from the front, right and above,
// for the given aspect (width / height).  Works for flat, point-sized and
// empty boxes too.
camera camera_framing(vec3 lo, vec3 hi, float aspect);

#endif
