// env.h — the light that comes from everywhere.

#ifndef ENV_H
#define ENV_H

#include "error.h"
#include "image.h"
#include "report.h"

typedef enum env_kind { ENV_NONE, ENV_CONSTANT, ENV_SKY, ENV_MAP } env_kind;

// Distant radiance by direction.  A map is equirectangular: row 0 is +Y, its
// centre -Z, u grows towards +X; ENV_SKY is a built-in closed form with a broad
// sun.
typedef struct env {
  env_kind kind;
  vec3 constant;
  image map;
  float rotate;  // turns about +Y (1 is a full turn), added to u
  float scale;   // multiplies everything
} env;

// Radiance arriving along -d, that is seen when looking along the unit
// direction d.  Bilinear in the map, u wraps, v is clamped.  Black for a map
// that was not loaded and for a direction that is not finite.
vec3 env_radiance(const env *e, vec3 d);

// Whether there is a map that was loaded.
static inline bool env_has_map(const env *e) {
  return e->kind == ENV_MAP && e->map.pixels != NULL;
}

// A direction, and where a map has it; found once for all who ask.
typedef struct env_place {
  vec3 d;
  vec2 uv;  // before rotation, of maps only
} env_place;

// env_radiance in two steps, so that the texels can come nearer in between.
env_place env_expect(const env *e, vec3 d);
vec3 env_radiance_at(const env *e, const env_place *p);

// The (u, v) in [0, 1) x [0, 1] of a unit direction before rotation, and back.
// u = 0.5 + atan2(d.x, -d.z) / 2 pi, v = acos(d.y) / pi.
vec2 env_uv(vec3 d);
vec3 env_direction(vec2 uv);

// Load an equirectangular picture (HDR, PFM, or an 8/16-bit one as sRGB).
bool env_load(env *out, const char *path, arena *mem, report *r, error *err);

#endif
