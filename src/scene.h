// scene.h — everything a picture depends on, in one place.

#ifndef SCENE_H
#define SCENE_H

#include "camera.h"
#include "env.h"
#include "material.h"
#include "normals.h"
#include "obj.h"

typedef enum light_kind { LIGHT_POINT, LIGHT_DIR } light_kind;

// A point light: position, intensity in W/sr.  A directional light: unit
// direction of travel, irradiance on a facing plane in W/m^2.
typedef struct light {
  light_kind kind;
  vec3 at;     // position, or direction of travel
  vec3 power;  // intensity, or irradiance
} light;

// What a command line may say over a scene file.  Zero is "as the file says".
typedef struct scene_options {
  normals_mode normals;
  float crease_deg;  // 180 by default
  bool no_name_rules;
  bool up_z;                                // the OBJ's up is +Z
  bool skip_textures;                       // for info: check, do not decode
  const char *env;                          // FILE, R,G,B or none
  const float *env_rotate_deg, *env_scale;  // NULL: not given
} scene_options;

typedef struct scene {
  const char *path;
  mesh mesh;            // all meshes of the scene, in world space
  material *materials;  // surfaces in use
  size_t material_count;
  uint32_t *material_of;  // per triangle: into materials
  light *lights;
  size_t light_count;
  camera *cameras;
  size_t camera_count;
  env env;
  int film_width, film_height;  // 0: not given
  float exposure;               // stops
  vec3 lo, hi;                  // bounds of the triangles
  texture_store textures;
  double seconds_load, seconds_textures;
  obj_times times;
} scene;

// Read an .obj (with the .scene of the same stem beside it, when there is one),
// a .scene, or "-" (an OBJ on standard input).
bool scene_load(scene *out, const char *path, const scene_options *options,
                arena *mem, pool *threads, report *r, error *err);

// The camera of that name, or the first when name is NULL; NULL when none.
const camera *scene_camera(const scene *s, const char *name);

// The interpolated texture coordinate of a hit; (0, 0) where there is none.
vec2 scene_uv(const scene *s, const hit *h);

// Write a complete scene file for what is in force to a string in mem.
char *scene_to_text(const scene *s, arena *mem);

#endif
