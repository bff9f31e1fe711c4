// material_list.c — the materials of all triangles of a scene.

#include "material_list.h"

#include "path_find.h"

#include <fnmatch.h>
#include <inttypes.h>
#include <string.h>

bool material_list_written(const mtl_material **written, const mesh *m,
                           const char *path, const char *root, arena *mem,
                           report *r, error *err) {
  mtl_library lib = {0};
  if (!mtl_read_all(&lib, m, path, root, mem, r, err)) return false;
  for (size_t i = 0; i < m->material_count; i++) {
    long at = mtl_find(&lib, m->material_names[i]);
    written[i] = at < 0 ? NULL : &lib.materials[at];
    if (at < 0 && lib.missing == 0)
      report_warn(r,
                  "%s:%" PRIu64 ": material \"%s\" is not defined, it will be "
                  "grey",
                  path, m->material_lines[i], m->material_names[i]);
  }
  return true;
}

// What the decisions of a scene depend on.  Runs that must come out alike
// share a slot and are decided once.
typedef struct decision_table {
  const mesh *m;
  const mtl_material **written;   // per material name of m
  const mtl_material **assigned;  // per assign statement
  const scene_file *file;
  uint32_t *slots;  // 1 + index into the list, 0: not decided yet
  bool name_rules;
} decision_table;

// The material of a scene file by name, NULL when there is none.
static const mtl_material *scene_material(const scene_file *f,
                                          const char *name) {
  for (size_t i = 0; i < f->material_count; i++)
    if (strcmp(f->materials[i].name, name) == 0) return &f->materials[i];
  return NULL;
}

// The material that an assign statement means: of the scene file, else of any
// library.  NULL and an error when there is none.
static const mtl_material *assigned_material(const decision_table *t,
                                             const scene_assign *a, arena *mem,
                                             error *err) {
  const mtl_material *found = scene_material(t->file, a->name);
  for (size_t i = 0; found == NULL && i < t->m->material_count; i++)
    if (t->written[i] != NULL && strcmp(t->written[i]->name, a->name) == 0)
      found = t->written[i];
  if (found != NULL) return found;
  size_t room = t->file->material_count + t->m->material_count + 1, n = 0;
  const char **names = ARENA_NEW(mem, const char *, room);
  for (size_t i = 0; i < t->file->material_count; i++)
    names[n++] = t->file->materials[i].name;
  for (size_t i = 0; i < t->m->material_count; i++)
    if (t->written[i] != NULL) names[n++] = t->written[i]->name;
  const char *near = text_nearest((span){a->name, strlen(a->name)}, names);
  fail(err, "%s: assign: no material \"%s\"%s%s%s", a->place, a->name,
       near == NULL ? "" : ", expected \"", near == NULL ? "" : near,
       near == NULL ? "" : "\"?");
  return NULL;
}

// The name with index i, NULL for -1.
static const char *name_or_null(const char *const *names, int i) {
  return i < 0 ? NULL : names[i];
}

// The first assign statement that catches run r, -1 when none does.
static int assign_for(const decision_table *t, const mesh_run *r) {
  const char *names[2][2] = {
      {name_or_null(t->m->material_names, r->material), NULL},
      {name_or_null(t->m->object_names, r->object),
       name_or_null(t->m->group_names, r->group)}};
  for (size_t i = 0; i < t->file->assign_count; i++) {
    const scene_assign *a = &t->file->assigns[i];
    for (int k = 0; k < 2; k++) {
      const char *name = names[a->by_object][k];
      if (name != NULL && fnmatch(a->pattern, name, 0) == 0) return (int)i;
    }
  }
  return -1;
}

// What an object's name says by rule 4.
enum { WORD_NONE, WORD_GLASS, WORD_MIRROR, WORD_KINDS };

// The slot of run r, and what material_decide needs to know.  A face without
// an object goes by its group.
static size_t slot_of(const decision_table *t, const mesh_run *r,
                      material_use *use) {
  int a = assign_for(t, r);
  *use = (material_use){.name_rules = t->name_rules};
  use->name = name_or_null(t->m->material_names, r->material);
  use->object = name_or_null(t->m->object_names, r->object);
  if (use->object == NULL)
    use->object = name_or_null(t->m->group_names, r->group);
  if (r->material >= 0) use->written = t->written[r->material];
  if (a >= 0) {
    use->assigned = t->assigned[a];
    use->assigned_at = t->file->assigns[a].place;
    return (size_t)a;
  }
  int word = WORD_NONE;
  if (use->object != NULL && material_has_word(use->object, "mirror"))
    word = WORD_MIRROR;
  if (use->object != NULL && material_has_word(use->object, "glass"))
    word = WORD_GLASS;
  return t->file->assign_count +
         (size_t)((r->material + 1) * WORD_KINDS + word);
}

// Fill in the table; false when an assign names no material.
static bool table_new(decision_table *t, const mtl_material *const *written,
                      arena *mem, error *err) {
  const mesh *m = t->m;
  t->written = ARENA_NEW(mem, const mtl_material *, m->material_count);
  for (size_t i = 0; i < m->material_count; i++) {
    t->written[i] = scene_material(t->file, m->material_names[i]);
    if (t->written[i] == NULL) t->written[i] = written[i];
  }
  size_t n = t->file->assign_count;
  t->assigned = ARENA_NEW(mem, const mtl_material *, n);
  for (size_t i = 0; i < n; i++) {
    t->assigned[i] = assigned_material(t, &t->file->assigns[i], mem, err);
    if (t->assigned[i] == NULL) return false;
  }
  t->slots = ARENA_NEW(mem, uint32_t, n + WORD_KINDS * (m->material_count + 1));
  return true;
}

bool material_list_decide(material_list *out, const mesh *m,
                          const mtl_material *const *written,
                          const scene_file *file, bool name_rules, arena *mem,
                          error *err) {
  decision_table t = {.m = m, .file = file, .name_rules = name_rules};
  if (!table_new(&t, written, mem, err)) return false;
  material_use use;
  size_t count = 0;
  for (size_t i = 0; i < m->run_count; i++) {
    size_t slot = slot_of(&t, &m->runs[i], &use);
    if (t.slots[slot] == 0) t.slots[slot] = (uint32_t)++count;
  }
  material_list l = {ARENA_NEW(mem, material, count), count,
                     ARENA_NEW(mem, uint32_t, m->triangle_count)};
  for (size_t i = 0; i < m->run_count; i++) {
    const mesh_run *r = &m->runs[i];
    uint32_t at = t.slots[slot_of(&t, r, &use)] - 1;
    if (l.materials[at].why == NULL)
      l.materials[at] = material_decide(&use, mem);
    for (uint32_t k = 0; k < r->count; k++)
      l.of_triangle[r->first + k] = at;
  }
  *out = l;
  return true;
}

// Find the texture that statement `key` of w names, and read its head.  A path
// is checked once: what is wrong with it is noted in the store.
static void find_map(texture_map *map, const mtl_material *w, mtl_key key,
                     texture_store *store, report *r) {
  if (map->options.path == NULL || w == NULL) return;
  arena *mem = store->mem;
  const char *place = arena_format(mem, "%s:%u", w->file, w->line[key]);
  path_search where = {store->root, w->folder, place, mem, r, &store->misses};
  path_found found = path_find(&where, map->options.path);
  if (found.outside) {
    const char *why = path_missing(&found, "texture", mem);
    if (texture_refuse(store, found.tried, why))
      report_warn(r, "%s: %s", place, why);
    return;
  }
  error why;
  size_t before = store->failed;
  const char *path = found.path != NULL ? found.path : found.tried;
  map->found = texture_check(store, path, &why);
  if (map->found == NULL && store->failed != before)
    report_warn(r, "%s: texture left out: %s", place, why.text);
}

// Take back what m says only because of a map that could not be loaded.
static void forget_missing_maps(material *m, const mtl_material *w) {
  mtl_material usual = mtl_default("");
  if (m->map_kd.found == NULL && w->line[MTL_KD] == 0) m->kd = usual.kd;
  if (m->map_ks.found == NULL && w->line[MTL_KS] == 0) m->ks = usual.ks;
  if (m->map_ke.found == NULL && w->line[MTL_KE] == 0) m->ke = usual.ke;
  if (m->map_ns.found == NULL && w->line[MTL_NS] == 0) m->ns = usual.ns;
  if (m->map_pr.found == NULL && w->line[MTL_PR] == 0) m->roughness = usual.pr;
  if (m->map_pm.found == NULL && w->line[MTL_PM] == 0) m->metallic = usual.pm;
  if (m->map_d.found == NULL && !(m->d < 1)) m->passes = false;
}

// The statements, in the order of material_map.
static const mtl_key map_keys[MATERIAL_MAPS] = {
    MTL_MAP_KD, MTL_MAP_KS, MTL_MAP_KE,   MTL_MAP_NS,   MTL_MAP_D,
    MTL_MAP_PR, MTL_MAP_PM, MTL_MAP_BUMP, MTL_MAP_NORM,
};

void material_list_find(material_list *list, texture_store *store, report *r) {
  for (size_t i = 0; i < list->count; i++) {
    material *m = &list->materials[i];
    const mtl_material *w = m->source;
    for (int k = 0; k < MATERIAL_MAPS; k++)
      find_map(material_map(m, k), w, map_keys[k], store, r);
    if (w != NULL) forget_missing_maps(m, w);
  }
}

// Decode one; what is damaged behind a good head is a map that is missing.
static void decode_map(texture_map *map, const mtl_material *w, mtl_key key,
                       texture_store *store, report *r) {
  if (map->found == NULL || map->image != NULL) return;
  error why;
  size_t before = store->failed;
  map->image = texture_get(store, map->found, r, &why);
  if (map->image != NULL) return;
  map->found = NULL;
  if (store->failed != before)
    report_warn(r, "%s:%u: texture left out: %s", w->file, w->line[key],
                why.text);
}

void material_list_decode(material_list *list, texture_store *store,
                          const unsigned *wanted, report *r) {
  for (size_t i = 0; i < list->count; i++) {
    material *m = &list->materials[i];
    for (int k = 0; k < MATERIAL_MAPS; k++)
      if (wanted == NULL || (wanted[i] >> k & 1) != 0)
        decode_map(material_map(m, k), m->source, map_keys[k], store, r);
    if (m->source != NULL) forget_missing_maps(m, m->source);
  }
}
