// scene.c — everything a picture depends on, read in order and put together.

#include "scene.h"

#include "material_list.h"
#include "mesh_join.h"
#include "path_find.h"
#include "picture_head.h"

#include <string.h>
#include <sys/stat.h>
#include <time.h>

// What loading carries from step to step.
typedef struct scene_loader {
  scene *out;
  const scene_options *options;
  mesh *parts;                    // one per mesh statement
  const mtl_material ***written;  // per part and material name
  const char *root;               // of path_root; NULL: no limits
  arena *mem;
  pool *threads;
  report *r;
  error *err;
} scene_loader;

// A monotonic clock, in seconds.
static double load_clock(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// Where the suffix of the last component of path begins; its end if there is
// none.
static size_t stem_length(const char *path) {
  const char *slash = strrchr(path, '/');
  const char *dot = strrchr(path, '.');
  if (dot == NULL || dot == path || (slash != NULL && dot <= slash + 1))
    return strlen(path);
  return (size_t)(dot - path);
}

// Whether path ends in .scene, in any case of letters.
static bool is_scene_path(const char *path) {
  static const char suffix[] = ".scene";
  const char *at = path + stem_length(path);
  if (strlen(at) != strlen(suffix)) return false;
  for (int i = 0; suffix[i] != '\0'; i++)
    if ((at[i] | 0x20) != (suffix[i] | 0x20)) return false;
  return true;
}

// path with another suffix.
static char *with_suffix(arena *mem, const char *path, const char *suffix) {
  return arena_format(mem, "%.*s%s", (int)stem_length(path), path, suffix);
}

// A file that nobody named is no way out either, should it be a link.
static bool check_inside(scene_loader *l, const char *what, const char *path) {
  struct stat info;
  if (stat(path, &info) != 0 || path_is_inside(l->root, path)) return true;
  path_found f = {.tried = path, .outside = true};
  return fail(l->err, "%s", path_missing(&f, what, l->mem));
}

// The scene file that goes with path, read; without one the defaults, and the
// mesh that path means.
static bool load_file(scene_loader *l, const char *path) {
  scene_file *f = &l->out->file;
  bool is_scene = is_scene_path(path);
  const char *beside = is_scene ? path : with_suffix(l->mem, path, ".scene");
  struct stat info;
  bool is_stdin = strcmp(path, "-") == 0;
  bool have = is_scene ||
              (!is_stdin && stat(beside, &info) == 0 && !S_ISDIR(info.st_mode));
  *f = scene_file_default(path_folder(l->mem, path));
  if (have && !is_scene && !check_inside(l, "scene file", beside)) return false;
  if (have && !scene_file_read(f, beside, l->mem, l->r, l->err)) return false;
  if (f->mesh_count > 0) return true;
  f->meshes = ARENA_NEW(l->mem, scene_source, 1);
  f->mesh_count = 1;
  f->meshes[0] = (scene_source){
      .path = is_scene ? with_suffix(l->mem, path, ".obj") : path, .scale = 1};
  return !is_scene || check_inside(l, "mesh", f->meshes[0].path);
}

// Read mesh i and its libraries.
static bool load_part(scene_loader *l, size_t i) {
  scene_source *m = &l->out->file.meshes[i];
  if (m->place != NULL && strcmp(m->path, "-") != 0) {
    path_search where = {l->root, l->out->file.folder, m->place, l->mem, l->r,
                         NULL};
    path_found found = path_find(&where, m->path);
    if (found.path == NULL)
      return fail(l->err, "%s: %s", m->place,
                  path_missing(&found, "mesh", l->mem));
    m->path = found.path;
  }
  if (l->options->up_z) m->up_z = true;
  mesh *part = &l->parts[i];
  obj_times t = {0};
  if (!obj_read(part, m->path, l->mem, l->threads, l->r, &t, l->err))
    return false;
  l->out->times.read_parse += t.read_parse;
  l->out->times.merge += t.merge;
  l->out->times.triangulate += t.triangulate;
  l->out->times.bytes += t.bytes;
  mesh_place(part, m->scale, m->up_z);
  l->written[i] = ARENA_NEW(l->mem, const mtl_material *, part->material_count);
  return material_list_written(l->written[i], part, m->path, l->root, l->mem,
                               l->r, l->err);
}

// All meshes as one, with normals, and its materials.
static bool load_meshes(scene_loader *l) {
  scene *s = l->out;
  size_t n = s->file.mesh_count;
  l->parts = ARENA_NEW(l->mem, mesh, n);
  l->written = ARENA_NEW(l->mem, const mtl_material **, n);
  for (size_t i = 0; i < n; i++)
    if (!load_part(l, i)) return false;
  if (!mesh_join(&s->mesh, l->parts, n, l->mem, l->err)) return false;
  const scene_options *o = l->options;
  normals_generate(&s->mesh, o->normals,
                   o->crease_deg > 0 ? o->crease_deg : 180, l->mem, l->threads);
  mesh_extent(&s->mesh, &s->lo, &s->hi);
  const mtl_material **written =
      ARENA_NEW(l->mem, const mtl_material *, s->mesh.material_count);
  for (size_t i = 0, at = 0; i < n; i++)
    for (size_t k = 0; k < l->parts[i].material_count; k++)
      written[at++] = l->written[i][k];
  material_list list;
  if (!material_list_decide(&list, &s->mesh, written, &s->file,
                            !o->no_name_rules, l->mem, l->err))
    return false;
  s->textures = (texture_store){.mem = l->mem, .root = l->root};
  material_list_find(&list, &s->textures, l->r);
  s->materials = list.materials;
  s->material_count = list.count;
  s->material_of = list.of_triangle;
  return true;
}

// The environment in force.
static bool load_env(scene_loader *l) {
  scene_env *e = &l->out->file.env;
  const scene_options *o = l->options;
  path_search where = {l->root, l->out->file.folder, NULL, l->mem, l->r, NULL};
  if (o->env != NULL) {
    scene_env given = scene_env_of_text(o->env, l->mem);
    given.rotate_deg = e->rotate_deg;
    given.scale = e->scale;
    *e = given;
    // Named by whoever runs facet.
    where.folder = ".";
    where.root = NULL;
  }
  if (o->env_rotate_deg != NULL) e->rotate_deg = *o->env_rotate_deg;
  if (o->env_scale != NULL) e->scale = *o->env_scale;
  env *out = &l->out->env;
  *out = (env){.kind = e->kind, .constant = e->constant};
  if (e->kind == ENV_MAP) {
    where.place = e->place == NULL ? "--env" : e->place;
    path_found found = path_find(&where, e->path);
    if (found.path == NULL)
      return fail(l->err, "%s: %s", where.place,
                  path_missing(&found, "environment", l->mem));
    e->path = found.path;
    picture_head head;
    if (!picture_head_read(&head, e->path, l->err)) return false;
  }
  out->rotate = e->rotate_deg / 360;
  out->scale = e->scale;
  return true;
}

bool scene_load(scene *out, const char *path, const scene_options *options,
                arena *mem, pool *threads, report *r, error *err) {
  static const scene_options usual = {0};
  double start = load_clock();
  scene s = {.path = arena_format(mem, "%s", path)};
  scene_loader l = {.out = &s,
                    .options = options == NULL ? &usual : options,
                    .mem = mem,
                    .threads = threads,
                    .r = r,
                    .err = err};
  if (!l.options->allow_outside) l.root = path_root(mem, s.path);
  if (!load_file(&l, s.path) || !load_meshes(&l) || !load_env(&l)) return false;
  s.lights = s.file.lights;
  s.light_count = s.file.light_count;
  s.cameras = s.file.cameras;
  s.camera_count = s.file.camera_count;
  s.film_width = s.file.film_width;
  s.film_height = s.file.film_height;
  s.exposure = s.file.exposure;
  s.seconds_load = load_clock() - start;
  if (!l.options->skip_textures && !scene_decode(&s, NULL, true, mem, r, err))
    return false;
  *out = s;
  return true;
}

bool scene_decode(scene *s, const unsigned *wanted, bool environment,
                  arena *mem, report *r, error *err) {
  double start = load_clock();
  material_list list = {s->materials, s->material_count, s->material_of};
  material_list_decode(&list, &s->textures, wanted, r);
  double middle = load_clock();
  env e = s->env;
  bool map = environment && e.kind == ENV_MAP;
  if (map && !env_load(&e, s->file.env.path, mem, r, err)) return false;
  s->env.map = e.map;
  s->seconds_env += load_clock() - middle;
  s->seconds_textures += load_clock() - start;
  return true;
}

const camera *scene_camera(const scene *s, const char *name) {
  for (size_t i = 0; i < s->camera_count; i++)
    if (name == NULL || strcmp(s->cameras[i].name, name) == 0)
      return &s->cameras[i];
  return NULL;
}

vec2 scene_uv(const scene *s, const hit *h) {
  const mesh *m = &s->mesh;
  if (m->texcoord_index == NULL) return (vec2){0, 0};
  const uint32_t *corner = m->texcoord_index + 3 * (size_t)h->triangle;
  const float weight[3] = {1 - h->b1 - h->b2, h->b1, h->b2};
  vec2 uv = {0, 0};
  for (int i = 0; i < 3; i++) {
    if (corner[i] == MESH_NONE) return (vec2){0, 0};
    uv.x += weight[i] * m->texcoords[corner[i]].x;
    uv.y += weight[i] * m->texcoords[corner[i]].y;
  }
  return uv;
}

bool scene_material_closed(const scene *s, uint32_t which) {
  return mesh_is_closed(&s->mesh, s->material_of, which);
}
