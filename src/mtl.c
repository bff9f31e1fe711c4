// mtl.c

#include "mtl.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

// What the words behind a keyword mean.
typedef enum mtl_value {
  VALUE_COLOR,
  VALUE_NUMBER,
  VALUE_ILLUM,
  VALUE_MAP
} mtl_value;

// A keyword: its spelling, its kind, its field.
typedef struct mtl_key_entry {
  const char *name;
  mtl_key key;
  mtl_value value;
  size_t field;
} mtl_key_entry;

// Every keyword that facet knows.  The first spelling of a key is the one that
// facet uses; letter case is free.
static const mtl_key_entry MTL_KEYS[] = {
    {"Ka", MTL_KA, VALUE_COLOR, offsetof(mtl_material, ka)},
    {"Kd", MTL_KD, VALUE_COLOR, offsetof(mtl_material, kd)},
    {"Ks", MTL_KS, VALUE_COLOR, offsetof(mtl_material, ks)},
    {"Ke", MTL_KE, VALUE_COLOR, offsetof(mtl_material, ke)},
    {"Tf", MTL_TF, VALUE_COLOR, offsetof(mtl_material, tf)},
    {"Ns", MTL_NS, VALUE_NUMBER, offsetof(mtl_material, ns)},
    {"Ni", MTL_NI, VALUE_NUMBER, offsetof(mtl_material, ni)},
    {"d", MTL_D, VALUE_NUMBER, offsetof(mtl_material, d)},
    {"Tr", MTL_TR, VALUE_NUMBER, offsetof(mtl_material, d)},
    {"Pr", MTL_PR, VALUE_NUMBER, offsetof(mtl_material, pr)},
    {"Pm", MTL_PM, VALUE_NUMBER, offsetof(mtl_material, pm)},
    {"illum", MTL_ILLUM, VALUE_ILLUM, 0},
    {"map_Ka", MTL_MAP_KA, VALUE_MAP, 0},
    {"map_Kd", MTL_MAP_KD, VALUE_MAP, 0},
    {"map_Ks", MTL_MAP_KS, VALUE_MAP, 0},
    {"map_Ke", MTL_MAP_KE, VALUE_MAP, 0},
    {"map_Ns", MTL_MAP_NS, VALUE_MAP, 0},
    {"map_d", MTL_MAP_D, VALUE_MAP, 0},
    {"map_Pr", MTL_MAP_PR, VALUE_MAP, 0},
    {"map_Pm", MTL_MAP_PM, VALUE_MAP, 0},
    {"map_Bump", MTL_MAP_BUMP, VALUE_MAP, 0},
    {"bump", MTL_MAP_BUMP, VALUE_MAP, 0},
    {"norm", MTL_MAP_NORM, VALUE_MAP, 0},
    {"map_norm", MTL_MAP_NORM, VALUE_MAP, 0},
};

// Entries of the table; the index of a keyword that is not there.
enum { MTL_NAME_COUNT = sizeof MTL_KEYS / sizeof MTL_KEYS[0] };

// d and 1 - Tr that differ by more are a contradiction; exporters write six
// decimals.
#define MTL_ALPHA_EPSILON 1e-5f

const char *mtl_key_name(mtl_key key) {
  int i = 0;
  while (MTL_KEYS[i].key != key)
    i++;
  return MTL_KEYS[i].name;
}

// Equal but for the case of ASCII letters.
static bool span_is_any_case(span s, const char *word) {
  if (strlen(word) != s.length) return false;
  for (size_t i = 0; i < s.length; i++) {
    bool letter = (word[i] | 0x20) >= 'a' && (word[i] | 0x20) <= 'z';
    if (s.at[i] != word[i] && !(letter && (s.at[i] ^ word[i]) == 0x20))
      return false;
  }
  return true;
}

static int mtl_key_find(span word) {
  int i = 0;
  while (i < MTL_NAME_COUNT && !span_is_any_case(word, MTL_KEYS[i].name))
    i++;
  return i;
}

mtl_material mtl_default(const char *name) {
  mtl_material m = {.name = name, .kd = {0.8f, 0.8f, 0.8f}, .tf = {1, 1, 1}};
  m.ni = 1;
  m.d = 1;
  m.pr = 0.5f;
  m.illum = -1;
  for (int i = 0; i < MTL_KEY_COUNT - MTL_FIRST_MAP; i++)
    m.map[i] = (mtl_map){.scale = {1, 1, 1}, .bump = 1};
  return m;
}

// A word cut to what fits a message, for "%.*s".
static int shown(span word) {
  return (int)(word.length < 40 ? word.length : 40);
}

// Up to `most` numbers, the rest noted; -1 when one is malformed.
static int mtl_numbers(span rest, float *x, int most, const char *name,
                       const mtl_site *site) {
  int n = 0;
  for (span word; (word = text_word(&rest)).length > 0; n++) {
    if (n == most) {
      report_note(site->r, "%s: %s: \"%.*s\" and what follows is not used",
                  site->place, name, shown(word), word.at);
      return n;
    }
    if (!span_float(word, &x[n])) {
      fail(site->err,
           "%s: %s: malformed number \"%.*s\", expected a decimal number",
           site->place, name, shown(word), word.at);
      return -1;
    }
    if (!isfinite(x[n]))
      report_warn(site->r, "%s: %s is not finite", site->place, name);
  }
  return n;
}

// How a statement ended.
typedef enum mtl_result { MTL_FAILED, MTL_IGNORED, MTL_APPLIED } mtl_result;

// Three numbers, or one for grey.  Spectral curves and CIE XYZ are noted.
static mtl_result mtl_color(vec3 *out, span rest, const char *name,
                            const mtl_site *site) {
  float x[3] = {0};
  span after = rest;
  span first = text_word(&after);
  if (span_is(first, "spectral") || span_is(first, "xyz")) {
    report_note(site->r, "%s: %s %.*s is not used", site->place, name,
                (int)first.length, first.at);
    return MTL_IGNORED;
  }
  int n = mtl_numbers(rest, x, 3, name, site);
  if (n < 0) return MTL_FAILED;
  if (n == 0 || n == 2) {
    fail(site->err, "%s: %s has %d numbers, expected 1 or 3", site->place, name,
         n);
    return MTL_FAILED;
  }
  *out = n == 1 ? vec3_all(x[0]) : (vec3){x[0], x[1], x[2]};
  return MTL_APPLIED;
}

// One number; "-halo" in front of it is noted.
static mtl_result mtl_number(float *out, span rest, const char *name,
                             const mtl_site *site) {
  float x = 0;
  span after = rest;
  if (span_is(text_word(&after), "-halo")) {
    report_note(site->r, "%s: %s -halo is not used", site->place, name);
    rest = after;
  }
  int n = mtl_numbers(rest, &x, 1, name, site);
  if (n < 0) return MTL_FAILED;
  if (n == 0) {
    fail(site->err, "%s: %s without its number", site->place, name);
    return MTL_FAILED;
  }
  *out = x;
  return MTL_APPLIED;
}

// d wins over Tr, in any order; both at odds is a warning.
static mtl_result mtl_alpha(mtl_material *m, mtl_key key, span rest,
                            const mtl_site *site) {
  float x;
  const char *name = mtl_key_name(key);
  mtl_result result = mtl_number(&x, rest, name, site);
  if (result != MTL_APPLIED) return result;
  float d = key == MTL_TR ? 1 - x : x;
  bool other = m->line[key == MTL_TR ? MTL_D : MTL_TR] != 0;
  if (other && fabsf(d - m->d) > MTL_ALPHA_EPSILON)
    report_warn(site->r, "%s: d and Tr contradict each other, d counts",
                site->place);
  if (key == MTL_D || m->line[MTL_D] == 0) m->d = d;
  return MTL_APPLIED;
}

// An illumination model, 0 to 10.
static mtl_result mtl_illum(mtl_material *m, span rest, const mtl_site *site) {
  float x;
  mtl_result result = mtl_number(&x, rest, "illum", site);
  if (result != MTL_APPLIED) return result;
  if (!(x >= 0 && x <= 10) || x != floorf(x)) {
    report_warn(site->r, "%s: illum is no model, expected 0 to 10",
                site->place);
    return MTL_IGNORED;
  }
  m->illum = (int)x;
  return MTL_APPLIED;
}

// A texture; its colour multiplies Kd, which is white where nobody says more.
static mtl_result mtl_texture(mtl_material *m, mtl_key key, span rest,
                              const mtl_site *site) {
  mtl_map map = {0};
  if (!mtl_map_parse(&map, rest, site)) return MTL_FAILED;
  if (map.path == NULL) return MTL_IGNORED;
  m->map[key - MTL_FIRST_MAP] = map;
  if (key == MTL_MAP_KD && m->line[MTL_KD] == 0) m->kd = vec3_all(1);
  return MTL_APPLIED;
}

bool mtl_statement(mtl_material *m, span key, span rest, uint32_t line,
                   const char *place, bool *known, arena *mem, report *r,
                   error *err) {
  mtl_site site = {place, mem, r, err};
  int i = mtl_key_find(key);
  *known = i < MTL_NAME_COUNT;
  if (!*known) return true;
  mtl_key k = MTL_KEYS[i].key;
  const char *name = MTL_KEYS[i].name;
  void *field = (char *)m + MTL_KEYS[i].field;
  mtl_result result = MTL_IGNORED;
  switch (MTL_KEYS[i].value) {
  case VALUE_COLOR: result = mtl_color(field, rest, name, &site); break;
  case VALUE_NUMBER:
    result = k == MTL_D || k == MTL_TR ? mtl_alpha(m, k, rest, &site)
                                       : mtl_number(field, rest, name, &site);
    break;
  case VALUE_ILLUM: result = mtl_illum(m, rest, &site); break;
  case VALUE_MAP: result = mtl_texture(m, k, rest, &site); break;
  }
  if (result == MTL_APPLIED) m->line[k] = line;
  return result != MTL_FAILED;
}

long mtl_find(const mtl_library *lib, const char *name) {
  return name_table_find(&lib->names, (span){name, strlen(name)});
}

mtl_material *mtl_add(mtl_library *lib, span name, arena *mem) {
  size_t i = (size_t)name_table_add(&lib->names, name, mem);
  if (i < lib->count) return &lib->materials[i];
  if (lib->count == lib->room) {
    lib->room = lib->room == 0 ? 8 : 2 * lib->room;
    mtl_material *more = ARENA_NEW(mem, mtl_material, lib->room);
    if (lib->count > 0) memcpy(more, lib->materials, lib->count * sizeof *more);
    lib->materials = more;
  }
  mtl_material *m = &lib->materials[lib->count++];
  *m = mtl_default(lib->names.names[i]);
  return m;
}
