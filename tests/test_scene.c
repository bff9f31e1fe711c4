// test_scene.c — scene files, and what becomes of them.

#include "scene.h"

#include "mesh_join.h"

#include <dirent.h>
#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static const char FOLDER[] = "tests/data/scene";

// One loaded scene, with what was said on the way.
typedef struct loaded {
  arena mem;
  report report;
  scene scene;
  error err;
  bool ok;
} loaded;

static loaded *load_path(const char *path, const scene_options *options) {
  loaded *l = calloc(1, sizeof *l);
  l->report.mem = &l->mem;
  l->ok =
      scene_load(&l->scene, path, options, &l->mem, NULL, &l->report, &l->err);
  return l;
}

static loaded *load_name(const char *name, const scene_options *options) {
  char path[300];
  snprintf(path, sizeof path, "%s/%s", FOLDER, name);
  return load_path(path, options);
}

static void loaded_free(loaded *l) {
  arena_free(&l->mem);
  free(l);
}

// The scene of a temporary file with this text.
static loaded *load_text(const char *text) {
  char folder[] = "/tmp/facet-scene-XXXXXX", path[64];
  assert_non_null(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/t.Scene", folder);
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  fputs(text, f);
  fclose(f);
  scene_options from_here = {.allow_outside = true};
  loaded *l = load_path(path, &from_here);
  remove(path);
  rmdir(folder);
  return l;
}

// The message must start with the file's path and go on as its first line says.
static void check_error(const char *path, const loaded *l, const char *want) {
  size_t n = strlen(path);
  if (l->ok) fail_msg("%s: loaded, expected %s", path, want);
  bool place = strncmp(l->err.text, path, n) == 0 && l->err.text[n] == ':';
  const char *rest = l->err.text + n + 1;
  if (*rest == ' ') rest++;
  if (!place || strncmp(rest, want, strlen(want)) != 0)
    fail_msg("%s: said \"%s\", expected \"%s\"", path, l->err.text, want);
}

// The counts must be those of the first line.
static void check_ok(const char *path, const loaded *l, const char *want) {
  if (!l->ok) fail_msg("%s: %s", path, l->err.text);
  const scene *s = &l->scene;
  char got[200];
  snprintf(got, sizeof got,
           "triangles %zu materials %zu warnings %d cameras %zu lights %zu",
           s->mesh.triangle_count, s->material_count, l->report.warnings,
           s->camera_count, s->light_count);
  if (strcmp(got, want) != 0) fail_msg("%s: %s, expected %s", path, got, want);
}

// Every file of the folder does what its first line says.
static void files_do_what_they_say(void **state) {
  (void)state;
  DIR *d = opendir(FOLDER);
  assert_non_null(d);
  int files = 0;
  for (struct dirent *e; (e = readdir(d)) != NULL;) {
    char path[400], line[200] = "";
    snprintf(path, sizeof path, "%s/%s", FOLDER, e->d_name);
    FILE *f = fopen(path, "r");
    if (e->d_name[0] == '.' || f == NULL) continue;
    assert_non_null(fgets(line, sizeof line, f));
    fclose(f);
    line[strcspn(line, "\n")] = '\0';
    bool is_error = strncmp(line, "# error ", 8) == 0;
    if (!is_error && strncmp(line, "# ok ", 5) != 0) continue;
    loaded *l = load_path(path, NULL);
    if (is_error) check_error(path, l, line + 8);
    if (!is_error) check_ok(path, l, line + 5);
    loaded_free(l);
    files++;
  }
  closedir(d);
  assert_true(files >= 48);
}

// Every statement arrives where it belongs.
static void statements_arrive(void **state) {
  (void)state;
  loaded *l = load_name("full.scene", NULL);
  const scene *s = &l->scene;
  assert_true(l->ok);
  assert_true(s->film_width == 320 && s->film_height == 200);
  assert_true(s->exposure == -1.5f);
  assert_string_equal(s->cameras[0].name, "front left");
  assert_true(s->cameras[0].eye.z == 5 && s->cameras[0].fov_deg == 40);
  assert_true(s->cameras[0].up.y == 1);
  assert_ptr_equal(scene_camera(s, NULL), &s->cameras[0]);
  const camera *top = scene_camera(s, "top");
  assert_true(top->up.z == -1 && top->fov_deg == 55.5f && top->eye.y == 9);
  assert_null(scene_camera(s, "bottom"));
  assert_true(s->env.kind == ENV_CONSTANT && s->env.constant.z == 0.3f);
  assert_true(s->env.scale == 2 && fabsf(s->env.rotate - 1.0f / 12) < 1e-7f);
  assert_true(s->lights[0].kind == LIGHT_POINT && s->lights[0].at.y == 2);
  assert_true(s->lights[0].power.z == 30);
  assert_true(s->lights[1].kind == LIGHT_DIR && s->lights[1].at.y == -1);
  assert_true(s->lights[1].power.y == 0.25f);
  loaded_free(l);
}

// The material of the face that starts at triangle t.
static const material *material_at(const scene *s, size_t t) {
  return &s->materials[s->material_of[t]];
}

// assign goes by object, group and material names; the scene's own material
// goes before the library's of the same name.
static void assignments_and_overrides_hold(void **state) {
  (void)state;
  loaded *l = load_name("full.scene", NULL);
  const scene *s = &l->scene;
  // Faces in order: Front, Back, Mirror (two), lid, floor; two triangles each.
  assert_true(material_at(s, 0)->kd.z == 0.9f);
  assert_int_equal(material_at(s, 0)->rule, 5);
  assert_non_null(strstr(material_at(s, 0)->why, "full.scene:23"));
  assert_int_equal(material_at(s, 4)->kind, MATERIAL_MIRROR);
  assert_int_equal(material_at(s, 4)->rule, 4);
  assert_int_equal(material_at(s, 8)->kind, MATERIAL_METAL_ROUGH);
  assert_non_null(strstr(material_at(s, 8)->why, "assign at "));
  assert_int_equal(material_at(s, 10)->kind, MATERIAL_GLASS);
  for (size_t t = 0; t < 24; t++)
    assert_string_equal(material_at(s, t)->name, material_at(s, t % 12)->name);
  loaded_free(l);
  scene_options no_names = {.no_name_rules = true};
  l = load_name("box.obj", &no_names);
  assert_int_equal(material_at(&l->scene, 4)->rule, 5);
  loaded_free(l);
}

static bool same(vec3 a, vec3 b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}

// The scene's material of a name goes before the library's under assign too;
// a face without an object goes by its group, and the word in it is looked at
// for each.
static void names_are_looked_up_in_order(void **state) {
  (void)state;
  loaded *l = load_name("override.scene", NULL);
  assert_int_equal(material_at(&l->scene, 4)->rule, 1);
  assert_true(material_at(&l->scene, 4)->kd.z == 1);
  loaded_free(l);
  l = load_name("groups.obj", NULL);
  assert_int_equal(material_at(&l->scene, 0)->kind, MATERIAL_BLINN_PHONG);
  assert_int_equal(material_at(&l->scene, 1)->kind, MATERIAL_GLASS);
  assert_int_equal(material_at(&l->scene, 2)->kind, MATERIAL_MIRROR);
  loaded_free(l);
  char here[300], text[500];
  assert_non_null(getcwd(here, sizeof here));
  snprintf(text, sizeof text,
           "mesh \"%s/%s/box.obj\"\nnewmtl object\nKd 0 1 0\n"
           "assign object object lid\n",
           here, FOLDER);
  l = load_text(text);
  if (!l->ok) fail_msg("%s", l->err.text);
  assert_string_equal(material_at(&l->scene, 8)->name, "object");
  loaded_free(l);
}

// Any number of statements of a kind is kept, in order.
static void many_lights_are_kept(void **state) {
  (void)state;
  char here[300], text[8000];
  assert_non_null(getcwd(here, sizeof here));
  int n = snprintf(text, sizeof text, "mesh \"%s/%s/box.obj\"\n", here, FOLDER);
  for (int i = 0; i < 100; i++)
    n += snprintf(text + n, sizeof text - (size_t)n,
                  "light point %d 0 0 intensity 1 1 %d\n", i, 2 * i);
  loaded *l = load_text(text);
  assert_int_equal(l->scene.light_count, 100);
  for (int i = 0; i < 100; i++)
    assert_true(l->scene.lights[i].at.x == (float)i &&
                l->scene.lights[i].power.z == (float)(2 * i));
  loaded_free(l);
}

// A texture is loaded, or with skip_textures only looked for.
static void textures_are_loaded(void **state) {
  (void)state;
  loaded *l = load_name("textured.obj", NULL);
  const material *m = &l->scene.materials[0];
  assert_non_null(m->map_kd.image);
  assert_int_equal(m->map_kd.image->width, 4);
  assert_true(m->kd.x == 1);
  loaded_free(l);
  scene_options skip = {.skip_textures = true};
  l = load_name("textured.obj", &skip);
  assert_null(l->scene.materials[0].map_kd.image);
  assert_true(l->scene.materials[0].kd.x == 1);
  loaded_free(l);
}

// Normals are smoothed over any angle unless a crease is given; bounds leave
// out what is not finite.
static void geometry_is_prepared(void **state) {
  (void)state;
  loaded *l = load_name("smooth.obj", NULL);
  const mesh *m = &l->scene.mesh;
  vec3 n = m->normals[m->normal_index[0]];
  assert_true(fabsf(n.z - 0.70710678f) < 1e-6f);
  assert_true(fabsf(n.y - 0.70710678f) < 1e-6f);
  loaded_free(l);
  l = load_name("not finite.obj", NULL);
  assert_true(same(l->scene.lo, vec3_all(0)) && l->scene.hi.y == 1);
  assert_true(l->scene.hi.z == 0);
  loaded_free(l);
}

// Placing turns normals but does not scale them; joining fills in white where
// only one part has colours.
static void normals_and_colors_are_joined(void **state) {
  (void)state;
  vec3 p[3] = {{1, 2, 3}, {1, 0, 0}, {0, 1, 0}}, n[1] = {{1, 2, 3}};
  vec3 c[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  uint32_t index[3] = {0, 1, 2}, normal_index[3] = {0, MESH_NONE, 0};
  mesh parts[2] = {{.position_count = 3,
                    .triangle_count = 1,
                    .positions = p,
                    .position_index = index},
                   {0}};
  parts[1] = parts[0];
  parts[1].colors = c;
  parts[1].normals = n;
  parts[1].normal_count = 1;
  parts[1].normal_index = normal_index;
  mesh_place(&parts[1], 2, true);
  assert_true(same(p[0], (vec3){2, 6, -4}) && same(n[0], (vec3){1, 3, -2}));
  arena mem = {0};
  error err;
  mesh m;
  assert_true(mesh_join(&m, parts, 2, &mem, &err));
  assert_true(same(m.colors[1], vec3_all(1)) && same(m.colors[4], c[1]));
  assert_true(m.normal_index[0] == MESH_NONE && m.normal_index[3] == 0);
  assert_true(m.normal_index[4] == MESH_NONE && m.texcoord_index == NULL);
  arena_free(&mem);
}

// Meshes are joined in order; scale and up move the points; runs, names and
// texture coordinates go along.
static void meshes_are_joined(void **state) {
  (void)state;
  loaded *one = load_name("box.obj", NULL), *l = load_name("full.scene", NULL);
  const mesh *a = &one->scene.mesh, *m = &l->scene.mesh;
  assert_int_equal(m->position_count, 2 * a->position_count);
  assert_int_equal(m->run_count, 2 * a->run_count);
  for (size_t i = 0; i < a->position_count; i++) {
    vec3 p = a->positions[i], q = m->positions[a->position_count + i];
    assert_true(same(m->positions[i], p));
    assert_true(same(q, (vec3){p.x / 2, p.z / 2, -p.y / 2}));
  }
  for (size_t i = 0; i < 3 * a->triangle_count; i++) {
    size_t k = 3 * a->triangle_count + i;
    assert_int_equal(m->position_index[k], a->position_index[i] + 8);
    uint32_t uv = a->texcoord_index[i];
    assert_int_equal(m->texcoord_index[k], uv == MESH_NONE ? uv : uv + 4);
  }
  for (size_t i = 0; i < a->run_count; i++) {
    const mesh_run *r = &a->runs[i], *q = &m->runs[a->run_count + i];
    assert_int_equal(q->first, r->first + 12);
    assert_int_equal(q->count, r->count);
    if (r->object >= 0)
      assert_string_equal(m->object_names[q->object],
                          a->object_names[r->object]);
    assert_int_equal(q->group < 0, r->group < 0);
    if (r->material >= 0)
      assert_string_equal(m->material_names[q->material],
                          a->material_names[r->material]);
  }
  assert_true(same(l->scene.lo, vec3_all(-1)) &&
              same(l->scene.hi, vec3_all(1)));
  loaded_free(one);
  loaded_free(l);
}

// What the command line says goes before the scene file.
static void options_win(void **state) {
  (void)state;
  const float rotate = 90, scale = 3;
  scene_options o = {.env = "1,2,3",
                     .env_rotate_deg = &rotate,
                     .env_scale = &scale,
                     .up_z = true};
  loaded *l = load_name("full.scene", &o);
  const env *e = &l->scene.env;
  assert_true(e->kind == ENV_CONSTANT && same(e->constant, (vec3){1, 2, 3}));
  assert_true(e->rotate == 0.25f && e->scale == 3);
  vec3 p = l->scene.mesh.positions[1];
  assert_true(same(p, (vec3){1, -1, 1}));
  loaded_free(l);
  o = (scene_options){.env = "none"};
  l = load_name("full.scene", &o);
  assert_true(l->scene.env.kind == ENV_NONE && l->scene.env.scale == 2);
  loaded_free(l);
  o.env = "sky";
  l = load_name("full.scene", &o);
  assert_true(l->scene.env.kind == ENV_SKY);
  loaded_free(l);
  o.env = "nowhere.hdr";
  l = load_name("full.scene", &o);
  assert_false(l->ok);
  assert_non_null(strstr(l->err.text, "--env: environment not found, tried "
                                      "nowhere.hdr"));
  loaded_free(l);
  l = load_name("box.obj", NULL);
  assert_true(l->scene.env.kind == ENV_SKY && l->scene.env.scale == 1);
  loaded_free(l);
}

// A scene as text reads back to the same scene, and to the same text but for
// the places in its comments.
static void text_reads_back(void **state) {
  (void)state;
  loaded *a = load_name("full.scene", NULL);
  char *text = scene_to_text(&a->scene, &a->mem);
  loaded *b = load_text(text);
  if (!b->ok) fail_msg("%s\n%s", b->err.text, text);
  const scene *s = &a->scene, *t = &b->scene;
  assert_int_equal(s->mesh.triangle_count, t->mesh.triangle_count);
  for (size_t i = 0; i < s->mesh.position_count; i++)
    assert_true(same(s->mesh.positions[i], t->mesh.positions[i]));
  assert_memory_equal(s->material_of, t->material_of,
                      s->mesh.triangle_count * sizeof(uint32_t));
  for (size_t i = 0; i < s->material_count; i++) {
    const material *m = &s->materials[i], *n = &t->materials[i];
    assert_string_equal(m->name, n->name);
    assert_int_equal(m->kind, n->kind);
    assert_int_equal(m->rule, n->rule);
    assert_true(same(m->kd, n->kd) && m->ni == n->ni && m->ns == n->ns);
    assert_true(m->roughness == n->roughness && m->metallic == n->metallic);
  }
  for (size_t i = 0; i < s->camera_count; i++) {
    assert_string_equal(s->cameras[i].name, t->cameras[i].name);
    assert_true(same(s->cameras[i].eye, t->cameras[i].eye));
    assert_true(same(s->cameras[i].up, t->cameras[i].up));
    assert_true(s->cameras[i].fov_deg == t->cameras[i].fov_deg);
  }
  assert_memory_equal(s->lights, t->lights, s->light_count * sizeof(light));
  assert_true(s->env.rotate == t->env.rotate && s->env.scale == t->env.scale);
  assert_true(same(s->env.constant, t->env.constant));
  assert_true(s->exposure == t->exposure && s->film_width == t->film_width);
  char *again = scene_to_text(t, &b->mem);
  text[strcspn(text, "#")] = again[strcspn(again, "#")] = '\0';
  assert_string_equal(text, again);
  loaded_free(a);
  loaded_free(b);
}

// A material with every statement survives the round trip, in a name with
// blanks, with its texture's options.
static void materials_read_back(void **state) {
  (void)state;
  char here[300], text[2000];
  assert_non_null(getcwd(here, sizeof here));
  snprintf(text, sizeof text,
           "mesh \"%s/%s/box.obj\"\nenv none\nnewmtl my mat\n"
           "Ka .1 .2 .3\nKd .3 .4 .5\nKs .5 .6 .7\nKe 1 2 3\nTf .2 .3 .4\n"
           "Ns 33.25\nNi 1.25\nTr 0.25\nPr .125\nPm .5\nillum 2\n"
           "map_Kd -s 2 3 1 -o .5 .25 0 -clamp on no file.png\n"
           "map_Bump -bm 0.5 -imfchan g other.png\nassign my mat object *\n",
           here, FOLDER);
  loaded *a = load_text(text);
  if (!a->ok) fail_msg("%s", a->err.text);
  assert_int_equal(a->report.warnings, 2);
  char *printed = scene_to_text(&a->scene, &a->mem);
  loaded *b = load_text(printed);
  if (!b->ok) fail_msg("%s", b->err.text);
  const mtl_material *m = &a->scene.file.materials[0];
  const mtl_material *n = &b->scene.file.materials[0];
  assert_string_equal(m->name, n->name);
  assert_true(same(m->ka, n->ka) && same(m->kd, n->kd) && same(m->ks, n->ks));
  assert_true(same(m->ke, n->ke) && same(m->tf, n->tf));
  assert_true(m->ns == n->ns && m->ni == n->ni && m->d == n->d);
  assert_true(m->pr == n->pr && m->pm == n->pm && m->illum == n->illum);
  const mtl_map *p = &n->map[MTL_MAP_KD - MTL_FIRST_MAP];
  assert_true(p->scale.y == 3 && p->offset.x == 0.5f && p->clamp);
  assert_non_null(strstr(p->path, "/no file.png"));
  p = &n->map[MTL_MAP_BUMP - MTL_FIRST_MAP];
  assert_true(p->bump == 0.5f && p->channel == 'g');
  loaded_free(a);
  loaded_free(b);
}

// Warnings name the path that was tried; faces keep a grey that shows.
static void what_is_missing_is_told(void **state) {
  (void)state;
  loaded *l = load_name("no library.obj", NULL);
  assert_non_null(
      strstr(l->report.first->text, "tests/data/scene/not there.mtl"));
  assert_true(l->scene.materials[0].kd.x == 0.8f);
  loaded_free(l);
  l = load_name("no texture.obj", NULL);
  assert_non_null(
      strstr(l->report.first->text, "tests/data/scene/nowhere.png"));
  assert_non_null(strstr(l->report.first->text, "no texture.mtl:3"));
  assert_true(l->scene.materials[0].kd.x == 0.8f);
  assert_false(l->scene.materials[0].passes);
  assert_true(l->scene.materials[1].kd.x == 0.3f);
  loaded_free(l);
  scene_options skip = {.skip_textures = true};
  l = load_name("no texture.obj", &skip);
  assert_int_equal(l->report.warnings, 1);
  loaded_free(l);
}

// The coordinate of a hit is the weighted mean of the corners'.
static void uv_is_interpolated(void **state) {
  (void)state;
  loaded *l = load_name("box.obj", NULL);
  hit h = {.b1 = 0.25f, .b2 = 0.5f, .triangle = 0};
  vec2 uv = scene_uv(&l->scene, &h);
  assert_true(uv.x == 0.75f && uv.y == 0.5f);
  h.triangle = 5;
  uv = scene_uv(&l->scene, &h);
  assert_true(uv.x == 0 && uv.y == 0);
  loaded_free(l);
  l = load_name("stem.obj", NULL);
  h.triangle = 0;
  assert_true(scene_uv(&l->scene, &h).x == 0);
  loaded_free(l);
}

// A box is closed, one without a lid is not; equal places count as one point.
static void closed_means_no_border(void **state) {
  (void)state;
  vec3 p[8];
  uint32_t index[39], tag[13] = {0};
  static const uint32_t quad[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                      {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (int i = 0; i < 8; i++)
    p[i] = (vec3){(float)(i & 1), (float)(i & 2), (float)(i & 4)};
  vec3 corners[36];
  for (int i = 0; i < 12; i++)
    for (int k = 0; k < 3; k++) {
      int at = k == 0 ? 0 : i % 2 + k;
      corners[3 * i + k] = p[quad[i / 2][at]];
      index[3 * i + k] = (uint32_t)(3 * i + k);
    }
  mesh m = {.triangle_count = 12,
            .position_count = 36,
            .positions = corners,
            .position_index = index};
  assert_true(mesh_is_closed(&m, tag, 0));
  assert_true(mesh_is_closed(&m, tag, 1));
  vec3 kept = corners[4];
  corners[4].x += 0.5f;
  assert_false(mesh_is_closed(&m, tag, 0));
  corners[4] = kept;
  // A triangle that is a point or a line takes nothing away.
  m.triangle_count = 13;
  index[36] = 5;
  index[37] = index[38] = 5;
  assert_true(mesh_is_closed(&m, tag, 0));
  m.triangle_count = 12;
  tag[3] = 1;
  assert_false(mesh_is_closed(&m, tag, 0));
  assert_false(mesh_is_closed(&m, tag, 1));
}

// Read the first n bytes as a scene file; what is refused says where.
static void read_bytes(const char *path, const char *bytes, size_t n) {
  int file = open(path, O_WRONLY | O_CREAT, 0600);
  assert_true(file >= 0);
  assert_true(write(file, bytes, n) == (ssize_t)n);
  assert_int_equal(ftruncate(file, (off_t)n), 0);
  close(file);
  arena mem = {0};
  report r = {.mem = &mem};
  error err = {{0}};
  scene_file out = {.exposure = 77};
  bool ok = scene_file_read(&out, path, &mem, &r, &err);
  assert_true(ok || strncmp(err.text, path, strlen(path)) == 0);
  assert_true(ok || out.exposure == 77);
  arena_free(&mem);
}

// Every beginning of a good file, and the file with one byte changed, is read
// or refused with its name, and nothing else happens.
static void damaged_files_are_read_or_refused(void **state) {
  (void)state;
  char folder[] = "/tmp/facet-scene-XXXXXX", path[64], bytes[2000];
  assert_non_null(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/t.scene", folder);
  FILE *f = fopen("tests/data/scene/full.scene", "rb");
  assert_non_null(f);
  size_t n = fread(bytes, 1, sizeof bytes, f);
  fclose(f);
  assert_true(n > 500 && n < sizeof bytes);
  for (size_t i = 0; i <= n; i++)
    read_bytes(path, bytes, i);
  uint32_t random = 1;
  int turns = getenv("FACET_QUICK") == NULL ? 5000 : 500;
  for (int i = 0; i < turns; i++) {
    random = random * 1664525u + 1013904223u;
    size_t at = (random >> 8) % n;
    char old = bytes[at];
    bytes[at] = (char)(random >> 24);
    read_bytes(path, bytes, n);
    bytes[at] = old;
  }
  remove(path);
  rmdir(folder);
}

// An OBJ that is not there is an error that names it.
static void missing_files_are_errors(void **state) {
  (void)state;
  const char *names[] = {"none.obj", "none.scene"};
  for (int i = 0; i < 2; i++) {
    loaded *l = load_name(names[i], NULL);
    assert_false(l->ok);
    assert_non_null(strstr(l->err.text, names[i]));
    loaded_free(l);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(files_do_what_they_say),
      cmocka_unit_test(statements_arrive),
      cmocka_unit_test(assignments_and_overrides_hold),
      cmocka_unit_test(names_are_looked_up_in_order),
      cmocka_unit_test(many_lights_are_kept),
      cmocka_unit_test(textures_are_loaded),
      cmocka_unit_test(geometry_is_prepared),
      cmocka_unit_test(normals_and_colors_are_joined),
      cmocka_unit_test(meshes_are_joined),
      cmocka_unit_test(options_win),
      cmocka_unit_test(text_reads_back),
      cmocka_unit_test(materials_read_back),
      cmocka_unit_test(what_is_missing_is_told),
      cmocka_unit_test(uv_is_interpolated),
      cmocka_unit_test(closed_means_no_border),
      cmocka_unit_test(damaged_files_are_read_or_refused),
      cmocka_unit_test(missing_files_are_errors),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
