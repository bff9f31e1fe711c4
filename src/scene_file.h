// scene_file.h — a scene file as written, before anything it names is read.
//
// Statements, one a line, in the tokens of OBJ and MTL:
//   mesh PATH [scale S] [up Y|Z]
//   camera NAME, then eye X Y Z, target X Y Z, up X Y Z, fov DEG
//   env PATH|constant R G B|sky|none [rotate DEG] [scale S]
//   light point X Y Z intensity R G B
//   light dir X Y Z irradiance R G B
//   newmtl NAME, then MTL statements
//   assign NAME object|material PATTERN
//   film W H, exposure STOPS

#ifndef SCENE_FILE_H
#define SCENE_FILE_H

#include "camera.h"
#include "env.h"
#include "mtl.h"

// What one scene file may hold: far more than people write, few enough that
// nobody waits for what a machine wrote.  A larger film is for the command line
// to ask for.
enum {
  SCENE_MAX_MESHES = 4096,
  SCENE_MAX_CAMERAS = 4096,
  SCENE_MAX_MATERIALS = 4096,
  SCENE_MAX_ASSIGNS = 512,
  SCENE_MAX_LIGHTS = 65536,
  SCENE_MAX_FILM = 1 << 26  // pixels
};

typedef enum light_kind { LIGHT_POINT, LIGHT_DIR } light_kind;

// A point light: position, intensity in W/sr.  A directional light: unit
// direction of travel, irradiance on a facing plane in W/m^2.
typedef struct light {
  light_kind kind;
  vec3 at;     // position, or direction of travel
  vec3 power;  // intensity, or irradiance
} light;

// A mesh statement.
typedef struct scene_source {
  const char *path;   // as written
  float scale;        // > 0
  bool up_z;          // its up is +Z
  const char *place;  // "file:line", NULL when implied
} scene_source;

// An env statement.
typedef struct scene_env {
  env_kind kind;
  vec3 constant;
  const char *path;   // as written, ENV_MAP only
  const char *place;  // "file:line", NULL when it comes from elsewhere
  float rotate_deg, scale;
} scene_env;

// An assign statement: faces whose object or group (else material) name
// matches the pattern, as fnmatch understands it, get the material NAME.  The
// first that matches wins.
typedef struct scene_assign {
  const char *name, *pattern;
  bool by_object;
  const char *place;
} scene_assign;

typedef struct scene_file {
  const char *path;    // NULL when there is no scene file
  const char *folder;  // what paths in it are relative to
  scene_source *meshes;
  size_t mesh_count;
  camera *cameras;
  size_t camera_count;
  light *lights;
  size_t light_count;
  scene_assign *assigns;
  size_t assign_count;
  mtl_material *materials;
  size_t material_count;
  scene_env env;
  int film_width, film_height;  // 0: not given
  float exposure;               // stops
} scene_file;

// What holds where no file says anything: the built-in sky.
scene_file scene_file_default(const char *folder);

// Read the scene file at path.  Anything unknown or malformed is an error with
// file:line and what was expected.
bool scene_file_read(scene_file *out, const char *path, arena *mem, report *r,
                     error *err);

// The same for the text of a scene file; path is for messages and for finding
// what it names.
bool scene_file_read_text(scene_file *out, span text, const char *path,
                          arena *mem, report *r, error *err);

// The environment that a command line names: FILE, R,G,B, sky or none.
scene_env scene_env_of_text(const char *text, arena *mem);

#endif
