// camera.c — a pinhole: the film plane stands at distance 1 from the eye.

#include "camera.h"

#include "num.h"

#include <stddef.h>

// Beyond this |sine| between the view and up the picture's upright is noise.
#define CAMERA_MIN_SINE 1e-6f

// tan(fov / 2) for a vertical angle in degrees.
static float half_height(float fov_deg) {
  vec2 cs = num_circle(fov_deg / 720);
  return cs.y / cs.x;
}

bool camera_view_of(camera_view *out, const camera *c, int width, int height,
                    error *err) {
  const char *gap = c->name == NULL ? "" : " ";
  const char *name = c->name == NULL ? "" : c->name;
  if (!vec3_finite(c->eye) || !vec3_finite(c->target) || !vec3_finite(c->up))
    return fail(err, "camera%s%s: eye, target and up must be finite", gap,
                name);
  if (!(c->fov_deg > 0 && c->fov_deg < 180))
    return fail(err, "camera%s%s: fov %g, expected 0 < fov < 180 degrees", gap,
                name, (double)c->fov_deg);
  vec3 forward = vec3_unit(vec3_sub(c->target, c->eye));
  if (!(fabsf(vec3_length(forward) - 1) < 0.01f))
    return fail(err, "camera%s%s: eye and target are the same point", gap,
                name);
  vec3 side = vec3_cross(forward, vec3_unit(c->up));
  if (!(vec3_length(side) > CAMERA_MIN_SINE))
    return fail(err, "camera%s%s: up is 0 or along the view", gap, name);
  side = vec3_unit(side);
  vec3 upright = vec3_cross(side, forward);
  float pixel = 2 * half_height(c->fov_deg) / (float)height;
  vec3 corner = vec3_mad(forward, -0.5f * (float)width * pixel, side);
  *out = (camera_view){
      .eye = c->eye,
      .corner = vec3_mad(corner, 0.5f * (float)height * pixel, upright),
      .right = vec3_scale(side, pixel),
      .down = vec3_scale(upright, -pixel),
      .forward = forward,
  };
  return true;
}

ray camera_ray(const camera_view *v, float x, float y) {
  return ray_from(v->eye, vec3_unit(camera_way(v, x, y)));
}

// The distance from which a corner at q from the target is just within the
// picture: |q.side| and |q.upright| over the tangents, less how far q lies
// away from the eye already.
static float distance_for(vec3 q, vec3 back, vec3 side, vec2 tangents) {
  vec3 upright = vec3_cross(back, side);
  float x = fabsf(vec3_dot(q, side)) / tangents.x;
  float y = fabsf(vec3_dot(q, upright)) / tangents.y;
  return fmaxf(x, y) + vec3_dot(q, back);
}

camera camera_framing(vec3 lo, vec3 hi, float aspect) {
  const float fov_deg = 40, margin = 1.05f;
  const vec3 up = {0, 1, 0}, back = vec3_unit((vec3){0.5f, 0.4f, 1});
  vec3 half = vec3_sub(vec3_scale(hi, 0.5f), vec3_scale(lo, 0.5f));
  vec3 center = vec3_add(lo, half);
  if (!vec3_finite(half) || !vec3_finite(center)) half = center = vec3_all(0);
  vec3 side = vec3_unit(vec3_cross(up, back));
  float t = half_height(fov_deg);
  vec2 tangents = {t * aspect, t};
  float distance = 0;
  for (int i = 0; i < 8; i++) {
    vec3 q = {i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y,
              i & 4 ? half.z : -half.z};
    distance = fmaxf(distance, distance_for(q, back, side, tangents));
  }
  distance *= margin;
  // Eye and target must differ as floats, and a point be seen at all.
  distance = fmaxf(distance, 1e-5f * vec3_peak(vec3_abs(center)));
  if (!(distance > 0)) distance = 1;
  return (camera){NULL, vec3_mad(center, distance, back), center, up, fov_deg};
}
