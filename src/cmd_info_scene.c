// cmd_info_scene.c

#include "cmd_info_scene.h"

#include "cmd_plan.h"

#include "path_find.h"
#include "scene.h"

#include <math.h>
#include <string.h>

// A mesh as its file has it, and the scene that becomes of it.
typedef struct scene_facts {
  const options *o;
  const char *path;
  arena *mem;
  pool *threads;
  report remarks;
  mesh m;
  scene s;
  bool has_scene;    // s is set
  size_t *by_name;   // triangles of each material name of m
  size_t unnamed;    // triangles before any usemtl
  size_t *by_place;  // triangles of each material of s
} scene_facts;

// Count the triangles of each material name, and of each decided material.
static void count_materials(scene_facts *f) {
  f->by_name = ARENA_NEW(f->mem, size_t, f->m.material_count);
  for (size_t i = 0; i < f->m.run_count; i++) {
    const mesh_run *run = &f->m.runs[i];
    if (run->material < 0) f->unnamed += run->count;
    if (run->material >= 0) f->by_name[run->material] += run->count;
  }
  if (!f->has_scene) return;
  f->by_place = ARENA_NEW(f->mem, size_t, f->s.material_count);
  for (size_t t = 0; t < f->s.mesh.triangle_count; t++)
    if (f->s.material_of[t] < f->s.material_count)
      f->by_place[f->s.material_of[t]]++;
}

// Read the file.  An OBJ is read by itself first: its counts are those of its
// text, whatever a scene file makes of it.  That it makes no scene is then
// only a warning.
static bool read_facts(scene_facts *f, error *err) {
  bool alone = cmd_has_suffix(f->path, ".obj");
  report of_text = {.mem = f->mem};
  if (alone &&
      !obj_read(&f->m, f->path, f->mem, f->threads, &of_text, NULL, err))
    return false;
  scene_options so = {.normals = NORMALS_FILE,
                      .crease_deg = 180,
                      .skip_textures = true,
                      .allow_outside = f->o->value[OPT_ALLOW_OUTSIDE].given,
                      .no_name_rules = f->o->value[OPT_NO_NAME_RULES].given,
                      .up_z = f->o->value[OPT_UP_AXIS].words == 1};
  f->remarks = (report){.mem = f->mem};
  f->has_scene =
      scene_load(&f->s, f->path, &so, f->mem, f->threads, &f->remarks, err);
  if (!f->has_scene && !alone) return false;
  if (!f->has_scene) {
    f->remarks = of_text;
    report_warn(&f->remarks, "%s", err->text);
  }
  if (!alone) f->m = f->s.mesh;
  count_materials(f);
  return true;
}

// A usemtl name for people: an empty one has to be called something.
static const char *shown_name(const char *name) {
  return name == NULL ? "(none)" : *name == 0 ? "(empty)" : name;
}

static const char *model_name(const material *m) {
  return material_kind_name(m->kind);
}

static void json_triple(json *j, const char *key, vec3 v) {
  json_open(j, key, '[');
  json_float(j, NULL, v.x);
  json_float(j, NULL, v.y);
  json_float(j, NULL, v.z);
  json_close(j, '[');
}

// The members that count what the text has.
static void json_counts(json *j, const scene_facts *f) {
  const mesh *m = &f->m;
  json_count(j, "positions", m->position_count);
  json_count(j, "normals", m->normal_count);
  json_count(j, "texcoords", m->texcoord_count);
  json_count(j, "vertex_colors", m->colors ? m->position_count : 0);
  json_count(j, "faces", m->face_count);
  json_count(j, "triangles", m->triangle_count);
  json_count(j, "lines", m->line_elements);
  json_count(j, "points", m->point_elements);
  json_count(j, "objects", m->object_statements);
  json_count(j, "groups", m->group_statements);
  json_count(j, "materials", m->material_count);
  json_number(j, "area", mesh_area(m));
  vec3 lo, hi;
  mesh_bounds(m, &lo, &hi);
  if (lo.x > hi.x) {
    json_text(j, "bbox", NULL);
    return;
  }
  json_open(j, "bbox", '[');
  json_triple(j, NULL, lo);
  json_triple(j, NULL, hi);
  json_close(j, '[');
}

// The parameters that the material's model reads.
static void json_parameters(json *j, const material *m) {
  if (m->kind != MATERIAL_GLASS && m->kind != MATERIAL_MIRROR)
    json_triple(j, "kd", m->kd);
  if (m->kind == MATERIAL_BLINN_PHONG || m->kind == MATERIAL_MIRROR)
    json_triple(j, "ks", m->ks);
  if (m->kind == MATERIAL_BLINN_PHONG) json_float(j, "ns", m->ns);
  if (m->kind == MATERIAL_GLASS) json_float(j, "ni", m->ni);
  if (m->kind == MATERIAL_METAL_ROUGH) {
    json_float(j, "roughness", m->roughness);
    json_float(j, "metallic", m->metallic);
    json_triple(j, "tf", m->tf);
  }
  json_float(j, "d", m->d);
  json_triple(j, "ke", m->ke);
}

// The decisions of the scene: per material the rule and what came of it.
static void json_decisions(json *j, const scene_facts *f) {
  json_open(j, "decisions", '[');
  for (size_t i = 0; i < f->s.material_count; i++) {
    const material *m = &f->s.materials[i];
    json_open(j, NULL, '{');
    json_text(j, "name", m->name);
    json_text(j, "model", model_name(m));
    json_count(j, "rule", (unsigned long long)m->rule);
    json_text(j, "why", m->why);
    json_count(j, "triangles", f->by_place[i]);
    json_parameters(j, m);
    json_close(j, '{');
  }
  json_close(j, '[');
}

// What light there is from everywhere.
static const char *env_name(const env *e) {
  static const char *const names[] = {"none", "constant", "sky", "map"};
  return names[e->kind];
}

static void json_camera(json *j, const camera *c) {
  json_open(j, NULL, '{');
  json_text(j, "name", c->name);
  json_triple(j, "eye", c->eye);
  json_triple(j, "target", c->target);
  json_triple(j, "up", c->up);
  json_float(j, "fov", c->fov_deg);
  json_close(j, '{');
}

// Cameras, lights, environment, film.
static void json_stage(json *j, const scene *s) {
  json_open(j, "cameras", '[');
  for (size_t i = 0; i < s->camera_count; i++)
    json_camera(j, &s->cameras[i]);
  json_close(j, '[');
  json_open(j, "lights", '[');
  for (size_t i = 0; i < s->light_count; i++) {
    bool point = s->lights[i].kind == LIGHT_POINT;
    json_open(j, NULL, '{');
    json_text(j, "kind", point ? "point" : "dir");
    json_triple(j, point ? "position" : "direction", s->lights[i].at);
    json_triple(j, point ? "intensity" : "irradiance", s->lights[i].power);
    json_close(j, '{');
  }
  json_close(j, '[');
  json_text(j, "env", env_name(&s->env));
  json_open(j, "film", '[');
  json_count(j, NULL, (unsigned long long)s->film_width);
  json_count(j, NULL, (unsigned long long)s->film_height);
  json_close(j, '[');
}

// What facet render would do with it, by each engine.  Normals are left out:
// only a render makes those that are missing.
static bool plan_of_scene(plan *out, const scene_facts *f, bool path) {
  plan_request r;
  error err;
  if (!cmd_plan_usual(&r, &f->s, path, &err)) return false;
  *out = plan_make(&r, f->mem);
  out->line[PLAN_NORMALS].told = false;
  return true;
}

// The member "plan": a list of stages by engine.
static void json_plans(json *j, const scene_facts *f) {
  static const char *const engines[] = {"raster", "path"};
  json_open(j, "plan", '{');
  for (int i = 0; i < 2; i++) {
    plan p;
    if (plan_of_scene(&p, f, i == 1)) cmd_plan_json(j, engines[i], &p);
  }
  json_close(j, '{');
}

// The object of --json.
static void print_json_scene(const scene_facts *f) {
  json j = {.out = stdout};
  json_open(&j, NULL, '{');
  json_text(&j, "file", f->path);
  json_counts(&j, f);
  json_open(&j, "triangles_by_material", '{');
  if (f->unnamed > 0) json_count(&j, shown_name(NULL), f->unnamed);
  for (size_t i = 0; i < f->m.material_count; i++)
    if (f->by_name[i] > 0)
      json_count(&j, shown_name(f->m.material_names[i]), f->by_name[i]);
  json_close(&j, '{');
  json_open(&j, "libraries", '[');
  for (size_t i = 0; i < f->m.library_count; i++)
    json_text(&j, NULL, f->m.libraries[i]);
  json_close(&j, '[');
  if (f->has_scene) json_decisions(&j, f);
  if (f->has_scene) json_stage(&j, &f->s);
  if (f->has_scene) json_plans(&j, f);
  cmd_json_warnings(&j, &f->remarks);
  json_close(&j, '{');
  json_end(&j);
}

// A text from a file as a terminal may see it.
static const char *plain(arena *mem, const char *text) {
  char *copy = arena_format(mem, "%s", text);
  error_plain(copy);
  return copy;
}

static void print_triple(const char *label, vec3 v) {
  printf("  %s %g %g %g", label, (double)v.x, (double)v.y, (double)v.z);
}

// One material for people: the decision, then the parameters in force.
static void print_material(const material *m, size_t triangles, arena *mem) {
  const char *name = plain(mem, shown_name(m->name));
  printf("material %s: %zu triangles\n", name, triangles);
  printf("  %s, %s\n ", model_name(m), plain(mem, m->why));
  bool glass = m->kind == MATERIAL_GLASS, mirror = m->kind == MATERIAL_MIRROR;
  if (!glass && !mirror) print_triple("kd", m->kd);
  if (mirror || m->kind == MATERIAL_BLINN_PHONG) print_triple("ks", m->ks);
  if (m->kind == MATERIAL_BLINN_PHONG) printf("  ns %g", (double)m->ns);
  if (glass) printf("  ni %g", (double)m->ni);
  if (m->kind == MATERIAL_METAL_ROUGH)
    printf("  roughness %g  metallic %g", (double)m->roughness,
           (double)m->metallic);
  if (m->d < 1) printf("  d %g", (double)m->d);
  if (vec3_peak(m->ke) > 0) print_triple("ke", m->ke);
  const texture_map *maps[] = {&m->map_kd, &m->map_ks,   &m->map_ke,
                               &m->map_ns, &m->map_d,    &m->map_pr,
                               &m->map_pm, &m->map_bump, &m->map_norm};
  const char *const names[] = {"map_Kd", "map_Ks",   "map_Ke",
                               "map_Ns", "map_d",    "map_Pr",
                               "map_Pm", "map_Bump", "norm"};
  for (size_t i = 0; i < sizeof maps / sizeof *maps; i++)
    if (maps[i]->options.path != NULL)
      printf("\n    %s %s", names[i], plain(mem, maps[i]->options.path));
  printf("\n");
}

// Where each mtllib line led.
static void print_libraries(const scene_facts *f) {
  int misses = 0;
  path_search where = {.folder = path_folder(f->mem, f->path),
                       .place = f->path,
                       .mem = f->mem,
                       .misses = &misses};
  if (!f->o->value[OPT_ALLOW_OUTSIDE].given)
    where.root = path_root(f->mem, f->path);
  for (size_t i = 0; i < f->m.library_count; i++) {
    const char *name = f->m.libraries[i];
    path_found found = path_find(&where, name);
    printf("library   %s: %s\n", plain(f->mem, name),
           found.path      ? plain(f->mem, found.path)
           : found.outside ? "outside of the folder"
                           : "not found as one name");
  }
}

// Cameras, lights, environment.
static void print_stage(const scene *s, arena *mem) {
  for (size_t i = 0; i < s->camera_count; i++) {
    const camera *c = &s->cameras[i];
    printf("camera %s:", plain(mem, shown_name(c->name)));
    print_triple("eye", c->eye);
    print_triple("target", c->target);
    printf("  fov %g\n", (double)c->fov_deg);
  }
  for (size_t i = 0; i < s->light_count; i++) {
    bool point = s->lights[i].kind == LIGHT_POINT;
    printf("light %s:", point ? "point" : "dir");
    print_triple(point ? "at" : "towards", s->lights[i].at);
    print_triple(point ? "intensity" : "irradiance", s->lights[i].power);
    printf("\n");
  }
  printf("environment: %s\n", env_name(&s->env));
}

// All of it for people.
static void print_text_scene(const scene_facts *f) {
  const mesh *m = &f->m;
  printf("%s\n", f->path);
  printf("positions %zu, normals %zu, texture coordinates %zu%s\n",
         m->position_count, m->normal_count, m->texcoord_count,
         m->colors ? ", vertex colours" : "");
  printf("faces     %zu, triangles %zu, lines %zu, points %zu\n", m->face_count,
         m->triangle_count, m->line_elements, m->point_elements);
  printf("objects   %zu, groups %zu, materials %zu\n", m->object_statements,
         m->group_statements, m->material_count);
  vec3 lo, hi;
  mesh_bounds(m, &lo, &hi);
  if (lo.x <= hi.x)
    printf("bounds    %g %g %g to %g %g %g\n", (double)lo.x, (double)lo.y,
           (double)lo.z, (double)hi.x, (double)hi.y, (double)hi.z);
  printf("area      %.9g\n", mesh_area(m));
  print_libraries(f);
  for (size_t i = 0; f->has_scene && i < f->s.material_count; i++)
    print_material(&f->s.materials[i], f->by_place[i], f->mem);
  if (f->has_scene) print_stage(&f->s, f->mem);
  for (int i = 0; i < 2 && f->has_scene; i++) {
    plan p;
    if (plan_of_scene(&p, f, i == 1)) cmd_plan_print(&p, stdout);
  }
}

int info_scene(const options *o, const char *path) {
  arena mem = {0};
  scene_facts f = {.o = o, .path = path, .mem = &mem};
  f.threads = pool_new(&mem, cmd_threads(o));
  error err;
  int code = EXIT_DONE;
  bool ok = read_facts(&f, &err);
  bool want_scene = o->value[OPT_SCENE].given;
  if (!ok || (want_scene && !f.has_scene))
    code = cmd_fail(o, EXIT_INPUT, "%s", err.text);
  else if (want_scene)
    fputs(scene_to_text(&f.s, &mem), stdout);
  else if (o->value[OPT_JSON].given)
    print_json_scene(&f);
  else
    print_text_scene(&f);
  if (code == EXIT_DONE && !o->value[OPT_JSON].given)
    cmd_remarks(o, &f.remarks);
  pool_free(f.threads);
  arena_free(&mem);
  return code;
}
