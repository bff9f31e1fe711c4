// scene_file.c — one function a statement, and a table of them.

#include "scene_file.h"

#include "path_find.h"
#include "statement.h"

#include <stddef.h>
#include <string.h>

// Which block statements like eye and Kd belong to: the last camera, or the
// last material.
typedef enum scene_block {
  BLOCK_NONE,
  BLOCK_CAMERA,
  BLOCK_MATERIAL
} scene_block;

// A walk over a scene file.
typedef struct scene_reader {
  scene_file *out;
  scene_block block;
  uint32_t line;
  report *r;
} scene_reader;

// Room for one more element behind `count` of them: the array itself, or a
// copy twice as long whenever count is a power of two.
static void *one_more(arena *mem, void *old, size_t count, size_t size) {
  if ((count & (count - 1)) != 0) return old;
  void *array = arena_alloc(mem, count == 0 ? 1 : 2 * count, size);
  if (count > 0) memcpy(array, old, count * size);
  return array;
}

// Whether there may be one more.
static bool has_room(statement *st, size_t count, size_t most) {
  return count < most || fail(st->err, "%s: more than %zu %s statements",
                              st->place, most, st->key);
}

// A name that is all that is left of a line.
static bool last_name(statement *st, const char **out) {
  static const char *const no_stops[] = {NULL};
  return statement_name(st, no_stops, out) &&
         statement_done(st, "nothing after the name");
}

// mesh PATH [scale S] [up Y|Z]
static bool state_mesh(scene_reader *s, statement *st) {
  static const char *const stops[] = {"scale", "up", NULL};
  scene_source m = {.scale = 1, .place = st->place};
  if (!statement_name(st, stops, &m.path)) return false;
  for (;;) {
    if (statement_takes(st, "scale")) {
      if (!statement_positive(st, &m.scale)) return false;
    } else if (statement_takes(st, "up")) {
      m.up_z = statement_takes(st, "Z");
      if (!m.up_z && !statement_takes(st, "Y"))
        return statement_refuse(st, "Y or Z");
    } else {
      break;
    }
  }
  scene_file *f = s->out;
  if (!has_room(st, f->mesh_count, SCENE_MAX_MESHES)) return false;
  f->meshes = one_more(st->mem, f->meshes, f->mesh_count, sizeof m);
  f->meshes[f->mesh_count++] = m;
  return statement_done(st, "scale S or up Y|Z");
}

// camera NAME.  Eye and target are NaN until stated.
static bool state_camera(scene_reader *s, statement *st) {
  camera c = {.eye = vec3_all(NAN),
              .target = vec3_all(NAN),
              .up = {0, 1, 0},
              .fov_deg = 40};
  if (!last_name(st, &c.name)) return false;
  scene_file *f = s->out;
  if (!has_room(st, f->camera_count, SCENE_MAX_CAMERAS)) return false;
  for (size_t i = 0; i < f->camera_count; i++)
    if (strcmp(f->cameras[i].name, c.name) == 0)
      return fail(st->err, "%s: a second camera \"%s\"", st->place, c.name);
  f->cameras = one_more(st->mem, f->cameras, f->camera_count, sizeof c);
  f->cameras[f->camera_count++] = c;
  s->block = BLOCK_CAMERA;
  return true;
}

// eye X Y Z, target X Y Z, up X Y Z, fov DEG: all of the open camera.
static bool state_in_camera(scene_reader *s, statement *st) {
  if (s->block != BLOCK_CAMERA)
    return fail(st->err, "%s: %s outside a camera, expected camera NAME first",
                st->place, st->key);
  camera *c = &s->out->cameras[s->out->camera_count - 1];
  if (st->key[0] == 'f') {
    if (!statement_positive(st, &c->fov_deg)) return false;
    if (!(c->fov_deg < 180))
      return fail(st->err, "%s: fov: %g is not below 180 degrees", st->place,
                  (double)c->fov_deg);
    return statement_done(st, "one number");
  }
  vec3 *to = st->key[0] == 'e'   ? &c->eye
             : st->key[0] == 't' ? &c->target
                                 : &c->up;
  return statement_vec3(st, -INFINITY, to) &&
         statement_done(st, "three numbers");
}

// env PATH|constant R G B|sky|none [rotate DEG] [scale S]
static bool state_env(scene_reader *s, statement *st) {
  static const char *const stops[] = {"rotate", "scale", NULL};
  scene_env e = {.kind = ENV_MAP, .scale = 1, .place = st->place};
  if (statement_takes(st, "none")) {
    e.kind = ENV_NONE;
  } else if (statement_takes(st, "sky")) {
    e.kind = ENV_SKY;
  } else if (statement_takes(st, "constant")) {
    e.kind = ENV_CONSTANT;
    if (!statement_vec3(st, 0, &e.constant)) return false;
  } else if (!statement_name(st, stops, &e.path)) {
    return false;
  }
  for (;;) {
    if (statement_takes(st, "rotate")) {
      if (!statement_numbers(st, 1, -INFINITY, &e.rotate_deg)) return false;
    } else if (statement_takes(st, "scale")) {
      if (!statement_numbers(st, 1, 0, &e.scale)) return false;
    } else {
      break;
    }
  }
  s->out->env = e;
  return statement_done(st, "rotate DEG or scale S");
}

// light point X Y Z intensity R G B, light dir X Y Z irradiance R G B
static bool state_light(scene_reader *s, statement *st) {
  light l = {.kind = LIGHT_POINT};
  if (statement_takes(st, "dir"))
    l.kind = LIGHT_DIR;
  else if (!statement_takes(st, "point"))
    return statement_refuse(st, "point or dir");
  if (!statement_vec3(st, -INFINITY, &l.at)) return false;
  const char *power = l.kind == LIGHT_DIR ? "irradiance" : "intensity";
  if (!statement_takes(st, power)) return statement_refuse(st, power);
  if (!statement_vec3(st, 0, &l.power)) return false;
  if (l.kind == LIGHT_DIR) {
    if (!(vec3_peak(vec3_abs(l.at)) > 0))
      return fail(st->err, "%s: light: a direction of length 0", st->place);
    l.at = vec3_unit(l.at);
  }
  scene_file *f = s->out;
  if (!has_room(st, f->light_count, SCENE_MAX_LIGHTS)) return false;
  f->lights = one_more(st->mem, f->lights, f->light_count, sizeof l);
  f->lights[f->light_count++] = l;
  return statement_done(st, "nothing after the three numbers");
}

// newmtl NAME
static bool state_newmtl(scene_reader *s, statement *st) {
  const char *name;
  if (!last_name(st, &name)) return false;
  scene_file *f = s->out;
  if (!has_room(st, f->material_count, SCENE_MAX_MATERIALS)) return false;
  for (size_t i = 0; i < f->material_count; i++)
    if (strcmp(f->materials[i].name, name) == 0)
      return fail(st->err, "%s: a second newmtl \"%s\"", st->place, name);
  mtl_material m = mtl_default(name);
  m.file = f->path;
  m.folder = f->folder;
  m.newmtl_line = s->line;
  f->materials = one_more(st->mem, f->materials, f->material_count, sizeof m);
  f->materials[f->material_count++] = m;
  s->block = BLOCK_MATERIAL;
  return true;
}

// assign NAME object|material PATTERN
static bool state_assign(scene_reader *s, statement *st) {
  static const char *const stops[] = {"object", "material", NULL};
  scene_assign a = {.place = st->place};
  if (!statement_name(st, stops, &a.name)) return false;
  a.by_object = statement_takes(st, "object");
  if (!a.by_object && !statement_takes(st, "material"))
    return statement_refuse(st, "object or material after the name");
  if (!last_name(st, &a.pattern)) return false;
  scene_file *f = s->out;
  if (!has_room(st, f->assign_count, SCENE_MAX_ASSIGNS)) return false;
  f->assigns = one_more(st->mem, f->assigns, f->assign_count, sizeof a);
  f->assigns[f->assign_count++] = a;
  return true;
}

// film W H
static bool state_film(scene_reader *s, statement *st) {
  int w, h;
  if (!statement_int(st, 1, IMAGE_MAX_SIDE, &w) ||
      !statement_int(st, 1, IMAGE_MAX_SIDE, &h))
    return false;
  if ((int64_t)w * h > SCENE_MAX_FILM)
    return fail(st->err,
                "%s: film: %d x %d has more than %d pixels, which only "
                "--resolution may ask for",
                st->place, w, h, SCENE_MAX_FILM);
  s->out->film_width = w;
  s->out->film_height = h;
  return statement_done(st, "two numbers");
}

// exposure STOPS
static bool state_exposure(scene_reader *s, statement *st) {
  return statement_numbers(st, 1, -INFINITY, &s->out->exposure) &&
         statement_done(st, "one number");
}

// A keyword and the function that reads its statement.
typedef struct scene_keyword {
  const char *word;
  bool (*state)(scene_reader *s, statement *st);
} scene_keyword;

static const scene_keyword SCENE_KEYWORDS[] = {
    {"mesh", state_mesh},     {"camera", state_camera},
    {"eye", state_in_camera}, {"target", state_in_camera},
    {"up", state_in_camera},  {"fov", state_in_camera},
    {"env", state_env},       {"light", state_light},
    {"newmtl", state_newmtl}, {"assign", state_assign},
    {"film", state_film},     {"exposure", state_exposure},
};

enum { SCENE_KEYWORD_COUNT = sizeof SCENE_KEYWORDS / sizeof *SCENE_KEYWORDS };

// MTL statements that facet does not use, so that a block pasted from a library
// is not refused.
static const char *const UNUSED_MTL_KEYS[] = {
    "Ps",   "Pc",     "Pcr",       "aniso",    "anisor",  "sharpness",
    "disp", "map_Ps", "map_Pc",    "map_Pcr",  "decal",   "refl",
    "Pcf",  "map_Tf", "map_aniso", "map_refl", "map_aat",
};

// Whether word is one of them.
static bool is_unused_mtl_key(span word) {
  size_t n = sizeof UNUSED_MTL_KEYS / sizeof *UNUSED_MTL_KEYS, i = 0;
  while (i < n && !span_is(word, UNUSED_MTL_KEYS[i]))
    i++;
  return i < n;
}

// We own this format: a word that is not in it is a slip, to be told with what
// was probably meant.
static bool unknown_statement(span word, const statement *st) {
  const char *words[SCENE_KEYWORD_COUNT + MTL_KEY_COUNT + 1];
  int n = 0;
  for (int i = 0; i < SCENE_KEYWORD_COUNT; i++)
    words[n++] = SCENE_KEYWORDS[i].word;
  for (int i = 0; i < MTL_KEY_COUNT; i++)
    words[n++] = mtl_key_name((mtl_key)i);
  words[n] = NULL;
  const char *near = text_nearest(word, words);
  return fail(st->err, "%s: unknown statement \"%.*s\"%s%s%s", st->place,
              (int)word.length, word.at, near == NULL ? "" : ", expected \"",
              near == NULL ? "" : near, near == NULL ? "" : "\"?");
}

// A statement that is not the scene's own: of MTL, inside newmtl.
static bool state_mtl(scene_reader *s, span word, statement *st) {
  mtl_material nobody = mtl_default("");
  bool is_open = s->block == BLOCK_MATERIAL;
  mtl_material *m =
      is_open ? &s->out->materials[s->out->material_count - 1] : &nobody;
  bool known = false;
  if (!mtl_statement(m, word, st->rest, s->line, st->place, &known, st->mem,
                     s->r, st->err))
    return false;
  if (!known && is_open && is_unused_mtl_key(word)) {
    report_note(s->r, "%s: %.*s is not used", st->place, (int)word.length,
                word.at);
    return true;
  }
  if (!known) return unknown_statement(word, st);
  return is_open || fail(st->err,
                         "%s: %.*s outside a material, expected newmtl NAME "
                         "first",
                         st->place, (int)word.length, word.at);
}

// One line.
static bool read_statement(scene_reader *s, statement *st) {
  st->rest = text_trim(text_uncomment(st->rest));
  span word = text_word(&st->rest);
  if (word.length == 0) return true;
  for (int i = 0; i < SCENE_KEYWORD_COUNT; i++) {
    if (!span_is(word, SCENE_KEYWORDS[i].word)) continue;
    st->key = SCENE_KEYWORDS[i].word;
    return SCENE_KEYWORDS[i].state(s, st);
  }
  return state_mtl(s, word, st);
}

// Every camera must say where it stands and where it looks.
static bool cameras_complete(const scene_file *f, error *err) {
  for (size_t i = 0; i < f->camera_count; i++) {
    const camera *c = &f->cameras[i];
    const char *missing = !vec3_finite(c->eye)      ? "eye"
                          : !vec3_finite(c->target) ? "target"
                                                    : NULL;
    if (missing != NULL)
      return fail(err, "%s: camera %s: no %s X Y Z", f->path, c->name, missing);
  }
  return true;
}

scene_file scene_file_default(const char *folder) {
  return (scene_file){.folder = folder, .env = {.kind = ENV_SKY, .scale = 1}};
}

bool scene_file_read_text(scene_file *out, span text, const char *path,
                          arena *mem, report *r, error *err) {
  scene_file f = scene_file_default(path_folder(mem, path));
  f.path = arena_format(mem, "%s", path);
  scene_reader s = {.out = &f, .r = r};
  text_lines lines = text_lines_of(text, 1);
  bool ok = true;
  for (span line; ok && text_next_line(&lines, &line);) {
    s.line = (uint32_t)lines.line;
    statement st = {.rest = line, .mem = mem, .err = err};
    st.place = arena_format(mem, "%s:%u", path, s.line);
    ok = read_statement(&s, &st);
  }
  text_lines_free(&lines);
  if (!ok || !cameras_complete(&f, err)) return false;
  *out = f;
  return true;
}

bool scene_file_read(scene_file *out, const char *path, arena *mem, report *r,
                     error *err) {
  span text;
  return text_read(&text, path, mem, err) &&
         scene_file_read_text(out, text, path, mem, r, err);
}

// Three numbers with commas between them and nothing else.
static bool is_color(const char *text, vec3 *out) {
  float v[3];
  for (int i = 0; i < 3; i++) {
    size_t n = strcspn(text, ",");
    if (!span_float((span){text, n}, &v[i]) || !(v[i] >= 0) || isinf(v[i]))
      return false;
    text += n;
    if (*text != (i < 2 ? ',' : '\0')) return false;
    text += i < 2;
  }
  *out = (vec3){v[0], v[1], v[2]};
  return true;
}

scene_env scene_env_of_text(const char *text, arena *mem) {
  scene_env e = {.kind = ENV_MAP, .scale = 1};
  if (strcmp(text, "none") == 0)
    e.kind = ENV_NONE;
  else if (strcmp(text, "sky") == 0)
    e.kind = ENV_SKY;
  else if (is_color(text, &e.constant))
    e.kind = ENV_CONSTANT;
  else
    e.path = arena_format(mem, "%s", text);
  return e;
}
