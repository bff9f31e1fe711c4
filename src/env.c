// env.c — the light that comes from everywhere.

#include "env.h"

#include "num.h"
#include "picture.h"

// The built-in sky, linear radiance: blue above, pale at the horizon, dull
// earth below.
static const vec3 SKY_ZENITH = {0.16f, 0.30f, 0.60f};
static const vec3 SKY_HORIZON = {0.62f, 0.68f, 0.74f};
static const vec3 SKY_GROUND = {0.19f, 0.18f, 0.17f};

// Its sun: radiance at the centre, and the unit direction towards it: high, to
// the left and in the back of a camera that looks along -Z, so that it lights
// the sides that the camera sees.
static const vec3 SKY_SUN = {4.6f, 4.2f, 3.5f};
static const vec3 SKY_SUN_AT = {-2.0f / 3, 2.0f / 3, 1.0f / 3};

// x^(2^n).
static float squared_times(float x, int n) {
  for (int i = 0; i < n; i++)
    x *= x;
  return x;
}

// Polynomials in the height d.y and in the cosine to the sun.
static vec3 sky_radiance(vec3 d) {
  float h = float_min(float_max(d.y, -1), 1);
  vec3 far = h >= 0 ? SKY_ZENITH : SKY_GROUND;
  float haze = h >= 0 ? squared_times(1 - h, 2) : squared_times(1 + h, 4);
  float c = float_min(float_max(vec3_dot(d, SKY_SUN_AT), 0), 1);
  return vec3_mad(vec3_lerp(far, SKY_HORIZON, haze), squared_times(c, 4),
                  SKY_SUN);
}

// acos(d.y) loses half of its digits near the poles, where d.y hardly changes;
// the angle of (d.y, |(d.x, d.z)|) is the same and loses none.
vec2 env_uv(vec3 d) {
  float u = num_turns(d.x, -d.z) + 0.5f;
  float flat = sqrtf(d.x * d.x + d.z * d.z);
  return (vec2){u < 1 ? u : u - 1, 2 * num_turns(flat, d.y)};
}

vec3 env_direction(vec2 uv) {
  vec2 around = num_circle(uv.x), down = num_circle(0.5f * uv.y);
  return (vec3){-around.y * down.y, down.x, around.x * down.y};
}

// The four texels around a place, and how far it is from the first.
typedef struct corners {
  const vec3 *above, *below;  // rows
  int left, right;
  float x, y;
} corners;

// Texel centres at (i + 0.5) / n; u of any value wraps.
static corners corners_at(const image *m, float u, float v) {
  float x = (u - float_floor(u)) * (float)m->width - 0.5f;
  float y = v * (float)m->height - 0.5f;
  float left = float_floor(x), top = float_floor(y);
  int x0 = (int)left, y0 = (int)top;
  int above = y0 < 0 ? 0 : y0 < m->height ? y0 : m->height - 1;
  int below = y0 + 1 < m->height ? y0 + 1 : m->height - 1;
  corners c = {.above = m->pixels + (size_t)above * (size_t)m->width,
               .below = m->pixels + (size_t)below * (size_t)m->width,
               .left = x0 < 0          ? m->width - 1
                       : x0 < m->width ? x0
                                       : 0,
               .x = x - left,
               .y = y - top};
  c.right = c.left + 1 < m->width ? c.left + 1 : 0;
  return c;
}

// d turned about +Y so that its u grows by that many turns.
static vec3 turned_about_y(vec3 d, float turns) {
  vec2 cs = num_circle(turns - float_floor(turns));
  return (vec3){d.x * cs.x - d.z * cs.y, d.y, d.z * cs.x + d.x * cs.y};
}

env_place env_expect(const env *e, vec3 d) {
  env_place p = {.d = d};
  if (!env_has_map(e) || !vec3_finite(d)) return p;
  p.uv = env_uv(d);
  corners c = corners_at(&e->map, p.uv.x + e->rotate, p.uv.y);
  __builtin_prefetch(c.above + c.left);
  __builtin_prefetch(c.below + c.left);
  return p;
}

// Bilinear.
static vec3 map_radiance(const env *e, vec2 uv) {
  corners c = corners_at(&e->map, uv.x + e->rotate, uv.y);
  vec3 above = vec3_lerp(c.above[c.left], c.above[c.right], c.x);
  vec3 below = vec3_lerp(c.below[c.left], c.below[c.right], c.x);
  return vec3_scale(vec3_lerp(above, below, c.y), e->scale);
}

vec3 env_radiance_at(const env *e, const env_place *p) {
  vec3 d = p->d;
  if (!vec3_finite(d)) return vec3_all(0);
  switch (e->kind) {
  case ENV_CONSTANT: return vec3_scale(e->constant, e->scale);
  case ENV_SKY:
    if (e->rotate != 0) d = turned_about_y(d, e->rotate);
    return vec3_scale(sky_radiance(d), e->scale);
  case ENV_MAP:
    return e->map.pixels != NULL ? map_radiance(e, p->uv) : vec3_all(0);
  default: return vec3_all(0);
  }
}

vec3 env_radiance(const env *e, vec3 d) {
  env_place p = env_expect(e, d);
  return env_radiance_at(e, &p);
}

bool env_load(env *out, const char *path, arena *mem, report *r, error *err) {
  image map;
  if (!picture_read_linear(&map, path, mem, r, err)) return false;
  *out = (env){.kind = ENV_MAP, .map = map, .scale = 1};
  return true;
}
