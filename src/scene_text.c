// scene_text.c — a scene as a scene file that reads back to the same scene.

#include "scene.h"

#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

// Text that grows.
typedef struct scene_writer {
  char *text;
  size_t length, room;
} scene_writer;

static void say(scene_writer *w, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

// Append printf-style.
static void say(scene_writer *w, const char *format, ...) {
  va_list args;
  va_start(args, format);
  int n = vsnprintf(NULL, 0, format, args);
  va_end(args);
  w->text = array_grow(w->text, &w->room, w->length + (size_t)n + 1, 1);
  va_start(args, format);
  vsnprintf(w->text + w->length, (size_t)n + 1, format, args);
  va_end(args);
  w->length += (size_t)n;
}

// A keyword and three numbers, with the 9 digits that give the float back.
static void say_vec3(scene_writer *w, const char *key, vec3 v) {
  say(w, "%s %.9g %.9g %.9g", key, (double)v.x, (double)v.y, (double)v.z);
}

// A name in quotes, so that blanks and keywords in it do no harm.
static void say_name(scene_writer *w, const char *name) {
  bool plain = strchr(name, '"') != NULL;
  say(w, plain ? " %s" : " \"%s\"", name);
}

// A path as seen from anywhere, in quotes.
static void say_path(scene_writer *w, const char *path) {
  char here[PATH_MAX];
  if (path[0] == '/' || strcmp(path, "-") == 0 ||
      getcwd(here, sizeof here) == NULL)
    say_name(w, path);
  else
    say(w, " \"%s/%s\"", here, path);
}

static void say_meshes(scene_writer *w, const scene *s) {
  for (size_t i = 0; i < s->file.mesh_count; i++) {
    const scene_source *m = &s->file.meshes[i];
    say(w, "mesh");
    say_path(w, m->path);
    say(w, " scale %.9g up %s\n", (double)m->scale, m->up_z ? "Z" : "Y");
  }
}

static void say_cameras(scene_writer *w, const scene *s) {
  for (size_t i = 0; i < s->camera_count; i++) {
    const camera *c = &s->cameras[i];
    say(w, "\ncamera");
    say_name(w, c->name == NULL ? "framed" : c->name);
    say_vec3(w, "\neye", c->eye);
    say_vec3(w, "\ntarget", c->target);
    say_vec3(w, "\nup", c->up);
    say(w, "\nfov %.9g\n", (double)c->fov_deg);
  }
}

static void say_lights(scene_writer *w, const scene *s) {
  const scene_env *e = &s->file.env;
  say(w, "\nenv");
  if (e->kind == ENV_NONE) say(w, " none");
  if (e->kind == ENV_SKY) say(w, " sky");
  if (e->kind == ENV_CONSTANT) say_vec3(w, " constant", e->constant);
  if (e->kind == ENV_MAP) say_path(w, e->path);
  say(w, " rotate %.9g scale %.9g\n", (double)e->rotate_deg, (double)e->scale);
  for (size_t i = 0; i < s->light_count; i++) {
    const light *l = &s->lights[i];
    bool dir = l->kind == LIGHT_DIR;
    say_vec3(w, dir ? "light dir" : "light point", l->at);
    say_vec3(w, dir ? " irradiance" : " intensity", l->power);
    say(w, "\n");
  }
}

// A texture statement.
static void say_map(scene_writer *w, const mtl_material *m, mtl_key key) {
  const mtl_map *map = &m->map[key - MTL_FIRST_MAP];
  if (map->path == NULL) return;
  say(w, "%s", mtl_key_name(key));
  say_vec3(w, " -s", map->scale);
  say_vec3(w, " -o", map->offset);
  if (key == MTL_MAP_BUMP) say(w, " -bm %.9g", (double)map->bump);
  if (map->clamp) say(w, " -clamp on");
  if (map->channel != 0) say(w, " -imfchan %c", map->channel);
  char here[PATH_MAX];
  bool rooted = map->path[0] == '/', beside = strcmp(m->folder, ".") == 0;
  say(w, " ");
  if (!rooted && m->folder[0] != '/' && getcwd(here, sizeof here) != NULL)
    say(w, "%s/", here);
  if (!rooted && !beside) say(w, "%s/", m->folder);
  say(w, "%s\n", map->path);
}

// What a material of the scene file says, statement by statement.
static void say_material(scene_writer *w, const mtl_material *m) {
  const vec3 colors[] = {m->ka, m->kd, m->ks, m->ke, m->tf};
  const float numbers[] = {m->ns, m->ni, m->d, m->d, m->pr, m->pm};
  say(w, "\nnewmtl");
  say_name(w, m->name);
  say(w, "\n");
  for (int key = 0; key < MTL_MAP_KA; key++) {
    if (m->line[key] == 0) continue;
    const char *word = mtl_key_name(key == MTL_TR ? MTL_D : (mtl_key)key);
    if (key <= MTL_TF) {
      say_vec3(w, word, colors[key]);
      say(w, "\n");
    } else if (key == MTL_ILLUM) {
      say(w, "%s %d\n", word, m->illum);
    } else {
      say(w, "%s %.9g\n", word, (double)numbers[key - MTL_NS]);
    }
  }
  for (int key = MTL_MAP_KA; key < MTL_KEY_COUNT; key++)
    say_map(w, m, (mtl_key)key);
}

// Materials and assignments of the scene file, then what became of each.
static void say_materials(scene_writer *w, const scene *s) {
  for (size_t i = 0; i < s->file.material_count; i++)
    say_material(w, &s->file.materials[i]);
  if (s->file.assign_count > 0) say(w, "\n");
  for (size_t i = 0; i < s->file.assign_count; i++) {
    const scene_assign *a = &s->file.assigns[i];
    say(w, "assign");
    say_name(w, a->name);
    say(w, " %s", a->by_object ? "object" : "material");
    say_name(w, a->pattern);
    say(w, "\n");
  }
  say(w, "\n");
  for (size_t i = 0; i < s->material_count; i++) {
    const material *m = &s->materials[i];
    say(w, "# %s: %s by %s\n", m->name[0] == '\0' ? "(no material)" : m->name,
        material_kind_name(m->kind), m->why);
  }
}

char *scene_to_text(const scene *s, arena *mem) {
  scene_writer w = {0};
  say(&w, "# For use in another folder: facet render --allow-outside\n");
  say_meshes(&w, s);
  if (s->film_width > 0) say(&w, "film %d %d\n", s->film_width, s->film_height);
  say(&w, "exposure %.9g\n", (double)s->exposure);
  say_cameras(&w, s);
  say_lights(&w, s);
  say_materials(&w, s);
  char *text = arena_text(mem, w.text, w.length);
  array_free(w.text);
  return text;
}
