// mtl_read.c

#include "mtl.h"
#include "path_find.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

// Keywords of a library that are noted by name.
enum { UNUSED_MAX = 64 };

// One library being read.
typedef struct mtl_reading {
  mtl_library *lib;
  const char *file, *folder;
  arena *mem;
  report *r;
  error *err;
  mtl_material *material;  // NULL before the first newmtl
  bool early;              // a statement came before it
  name_table unused;       // keywords that facet does not know
} mtl_reading;

// newmtl.  The name is the whole rest of the line, as in usemtl.
static void begin_material(mtl_reading *m, span rest, uint64_t line) {
  span name = text_trim(rest);
  size_t before = m->lib->count;
  m->material = mtl_add(m->lib, name, m->mem);
  if (m->lib->count == before) {
    report_warn(m->r, "%s:%" PRIu64 ": material \"%s\" again, this one counts",
                m->file, line, m->material->name);
    *m->material = mtl_default(m->material->name);
  }
  if (name.length == 0)
    report_warn(m->r, "%s:%" PRIu64 ": newmtl without a name", m->file, line);
  m->material->file = m->file;
  m->material->folder = m->folder;
  m->material->newmtl_line = (uint32_t)line;
}

// A keyword that facet does not know, noted when it comes first.
static void note_unused(mtl_reading *m, span key, const char *place) {
  if (m->unused.count >= UNUSED_MAX) return;
  size_t before = m->unused.count;
  int n = name_table_add(&m->unused, key, m->mem);
  if (m->unused.count > before)
    report_note(m->r, "%s: statement \"%.40s\" is not used", place,
                m->unused.names[n]);
}

static bool read_line(mtl_reading *m, span line, uint64_t number) {
  span rest = line;
  span key = text_word(&rest);
  if (key.length == 0 || key.at[0] == '#') return true;
  if (span_is(key, "newmtl")) {
    begin_material(m, rest, number);
    return true;
  }
  char place[512];
  snprintf(place, sizeof place, "%.480s:%" PRIu64, m->file, number);
  if (m->material == NULL) {
    if (!m->early)
      report_warn(m->r, "%s: statement before the first newmtl skipped", place);
    m->early = true;
    return true;
  }
  bool known;
  if (!mtl_statement(m->material, key, text_uncomment(rest), (uint32_t)number,
                     place, &known, m->mem, m->r, m->err))
    return false;
  if (!known) note_unused(m, key, place);
  return true;
}

// What looks like a mistake once a material is complete.
static void check_material(const mtl_material *m, report *r) {
  bool black = m->kd.x == 0 && m->kd.y == 0 && m->kd.z == 0;
  uint32_t line = m->line[MTL_MAP_KD];
  if (black && line != 0 && m->line[MTL_KD] != 0)
    report_warn(r, "%s:%" PRIu32 ": Kd 0 0 0 makes the texture of \"%s\" black",
                m->file, line, m->name);
}

bool mtl_read_text(mtl_library *lib, span text, const char *path, arena *mem,
                   report *r, error *err) {
  mtl_reading m = {.lib = lib, .mem = mem, .r = r, .err = err};
  m.file = arena_text(mem, path, strlen(path));
  m.folder = path_folder(mem, path);
  size_t before = lib->count;
  bool ok = true;
  text_lines lines = text_lines_of(text, 1);
  for (span line; ok && text_next_line(&lines, &line);)
    ok = read_line(&m, line, lines.line);
  text_lines_free(&lines);
  for (size_t i = before; ok && i < lib->count; i++)
    check_material(&lib->materials[i], r);
  return ok;
}

bool mtl_read(mtl_library *lib, const char *path, arena *mem, report *r,
              error *err) {
  arena own = {0};
  span text;
  bool ok = text_read(&text, path, &own, err) &&
            mtl_read_text(lib, text, path, mem, r, err);
  arena_free(&own);
  return ok;
}

// What has been looked for: mtllib lines, and libraries by path; and what
// finding needs.
typedef struct library_search {
  name_table asked, done;
  path_search where;
  int misses;
  arena *mem;
  report *r;
} library_search;

// Read the file found at path, once, whatever it is called.
static bool read_once(library_search *s, mtl_library *lib, const char *path,
                      error *err) {
  size_t before = s->done.count;
  const char *real = path_real(s->mem, path);
  name_table_add(&s->done, (span){real, strlen(real)}, s->mem);
  return s->done.count == before || mtl_read(lib, path, s->mem, s->r, err);
}

static void missing_library(const library_search *s, mtl_library *lib,
                            const path_found *f) {
  report_warn(s->r, "%s: %s", s->where.place,
              path_missing(f, "material library", s->mem));
  lib->missing++;
}

// The file of each word of name; *found counts those that are somewhere.  With
// lib, read them and warn of those that are not there.
static bool read_words(library_search *s, mtl_library *lib, const char *name,
                       int *found, error *err) {
  span rest = {name, strlen(name)};
  *found = 0;
  s->where.r = lib != NULL ? s->r : NULL;
  for (span word; (word = text_word(&rest)).length > 0;) {
    path_found f = path_find(&s->where, span_copy(s->mem, word));
    *found += f.path != NULL || f.outside;
    if (lib == NULL) continue;
    if (f.path == NULL) missing_library(s, lib, &f);
    if (f.path != NULL && !read_once(s, lib, f.path, err)) return false;
  }
  return true;
}

// One mtllib line: the file of that name, or else the files of its words.
static bool read_line_libraries(library_search *s, mtl_library *lib,
                                const char *name, error *err) {
  size_t before = s->asked.count;
  name_table_add(&s->asked, (span){name, strlen(name)}, s->mem);
  if (s->asked.count == before) return true;
  s->where.r = s->r;
  path_found f = path_find(&s->where, name);
  if (f.path != NULL) return read_once(s, lib, f.path, err);
  int found;
  read_words(s, NULL, name, &found, err);
  if (found > 0) return read_words(s, lib, name, &found, err);
  missing_library(s, lib, &f);
  return true;
}

bool mtl_read_all(mtl_library *lib, const mesh *m, const char *obj_path,
                  const char *root, arena *mem, report *r, error *err) {
  library_search s = {
      .where = {.root = root, .folder = path_folder(mem, obj_path), .mem = mem},
      .mem = mem,
      .r = r};
  s.where.misses = &s.misses;
  for (size_t i = 0; i < m->library_count; i++) {
    s.where.place =
        arena_format(mem, "%s:%" PRIu64, obj_path, m->library_lines[i]);
    if (!read_line_libraries(&s, lib, m->libraries[i], err)) return false;
  }
  return true;
}
