// scene.h — everything a picture depends on, in one place.

#ifndef SCENE_H
#define SCENE_H

#include "camera.h"
#include "env.h"
#include "material.h"
#include "normals.h"
#include "obj.h"
#include "scene_file.h"

// What a command line may say over a scene file.  Zero is "as the file says".
typedef struct scene_options {
  normals_mode normals;
  float crease_deg;  // 0: 180
  bool no_name_rules;
  bool up_z;                                // the OBJ's up is +Z
  bool skip_textures;                       // check, do not decode
  bool allow_outside;                       // names may leave the folder
  const char *env;                          // FILE, R,G,B, sky or none
  const float *env_rotate_deg, *env_scale;  // NULL: not given
} scene_options;

typedef struct scene {
  const char *path;
  scene_file file;      // what the scene file says, paths as found
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
  vec3 lo, hi;  // bounds of the triangles; lo > hi when there are none
  texture_store textures;
  double seconds_load;      // without the pictures
  double seconds_textures;  // to decode all pictures,
  double seconds_env;       // and of that the environment's
  obj_times times;
} scene;

// Order of force: options, scene file, MTL, default.  Read an .obj (with the
// .scene of the same stem beside it, when there is one), a .scene (whose mesh
// is the .obj of the same stem unless it names one), or "-" (an OBJ on standard
// input).  Missing libraries and textures are warnings; a missing mesh or
// environment is an error.  What the files name must lie in the folder of path
// or below, all links followed, unless the options allow more; what is outside
// counts as missing.
bool scene_load(scene *out, const char *path, const scene_options *options,
                arena *mem, pool *threads, report *r, error *err);

// Decode what a load with skip_textures has only checked: of the textures of
// material i those whose bits are set in wanted[i] (see material_reads), or all
// where wanted is NULL, and the map of the environment.  A damaged texture is a
// warning, a damaged environment an error.
bool scene_decode(scene *s, const unsigned *wanted, bool environment,
                  arena *mem, report *r, error *err);

// The camera of that name, or the first when name is NULL; NULL when none.
const camera *scene_camera(const scene *s, const char *name);

// The interpolated texture coordinate of a hit; (0, 0) where there is none.
vec2 scene_uv(const scene *s, const hit *h);

// Whether the triangles of a material (an index into materials) enclose a
// solid, as glass must to have an inside.
bool scene_material_closed(const scene *s, uint32_t which);

// A complete scene file for what is in force, as a string in mem: paths are
// absolute, and the decision of each material is in a comment.
char *scene_to_text(const scene *s, arena *mem);

#endif
