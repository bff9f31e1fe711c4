// material.c — the decision table, one function a rule.

#include "material.h"

#include <string.h>

// What an MTL that does not say Ni means by "glass", and the exponent that a
// map_Ns without Ns scales (exporters write 0..1000).
#define USUAL_GLASS_NI 1.5f
#define USUAL_MAP_NS 1000.0f

const char *material_kind_name(material_kind k) {
  static const char *const names[] = {"Blinn-Phong", "metal-rough", "mirror",
                                      "glass"};
  return names[k];
}

// Whether c separates words in a name; the NUL at its end does.
static bool splits_words(char c) {
  return strchr("_.- \t0123456789", c) != NULL;
}

// c in lower case, for ASCII letters.
static char lowered(char c) {
  return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

bool material_has_word(const char *text, const char *word) {
  size_t n = strlen(word);
  for (const char *p = text; *p != '\0'; p++) {
    if (p != text && !splits_words(p[-1])) continue;
    size_t k = 0;
    while (k < n && lowered(p[k]) == word[k])
      k++;
    if (k == n && splits_words(p[n])) return true;
  }
  return false;
}

// "Pr 0.3 at garden.mtl:12": one statement as evidence.
static const char *evidence(const mtl_material *w, mtl_key key, float value,
                            arena *mem) {
  return arena_format(mem, "%s %g at %s:%u", mtl_key_name(key), (double)value,
                      w->file, w->line[key]);
}

// The same for a map or colour, whose value says nothing to the rule.
static const char *evidence_of_presence(const mtl_material *w, mtl_key key,
                                        arena *mem) {
  return arena_format(mem, "%s at %s:%u", mtl_key_name(key), w->file,
                      w->line[key]);
}

// Rule 2: Pr or Pm.
static bool rule_metal_rough(material *m, const mtl_material *w, arena *mem) {
  static const mtl_key keys[] = {MTL_PR, MTL_PM, MTL_MAP_PR, MTL_MAP_PM};
  for (int i = 0; i < 4; i++) {
    mtl_key key = keys[i];
    if (w->line[key] == 0) continue;
    m->kind = MATERIAL_METAL_ROUGH;
    m->rule = 2;
    m->why = key < MTL_MAP_KA
                 ? evidence(w, key, key == MTL_PR ? w->pr : w->pm, mem)
                 : evidence_of_presence(w, key, mem);
    if (w->line[MTL_TF] != 0) m->tf = w->tf;
    return true;
  }
  return false;
}

// Rule 3: illum.
static bool rule_illum(material *m, const mtl_material *w, arena *mem) {
  const char *second = NULL;
  switch (w->illum) {
  case 3:
  case 5:
  case 8:
    if (w->line[MTL_KS] == 0 || !(vec3_peak(w->ks) > 0)) return false;
    m->kind = MATERIAL_MIRROR;
    second = evidence_of_presence(w, MTL_KS, mem);
    break;
  case 6:
  case 7:
    if (!(w->ni > 1)) return false;
    m->kind = MATERIAL_GLASS;
    second = evidence(w, MTL_NI, w->ni, mem);
    break;
  case 4:
  case 9: m->kind = MATERIAL_BLINN_PHONG; break;
  default: return false;
  }
  m->rule = 3;
  m->why = arena_format(mem, "illum %d at %s:%u%s%s", w->illum, w->file,
                        w->line[MTL_ILLUM], second == NULL ? "" : ", ",
                        second == NULL ? "" : second);
  return true;
}

// Rule 4 for one name; `of` says whose it is.
static bool rule_name(material *m, const mtl_material *w, const char *name,
                      const char *of, arena *mem) {
  if (name == NULL) return false;
  const char *word = material_has_word(name, "glass")    ? "glass"
                     : material_has_word(name, "mirror") ? "mirror"
                                                         : NULL;
  if (word == NULL) return false;
  m->rule = 4;
  m->why = arena_format(mem, "%s name %s holds the word %s", of, name, word);
  if (word[0] == 'g') {
    m->kind = MATERIAL_GLASS;
    if (!(m->ni > 1)) m->ni = USUAL_GLASS_NI;
  } else {
    m->kind = MATERIAL_MIRROR;
    if (w->line[MTL_KS] == 0 || !(vec3_peak(w->ks) > 0)) m->ks = w->kd;
  }
  return true;
}

// A texture statement of w; the picture comes later.
static texture_map map_of(const mtl_material *w, mtl_key key, bool is_color) {
  return (texture_map){.options = w->map[key - MTL_FIRST_MAP],
                       .is_color = is_color};
}

// Everything that w says, before any rule.  A map stands for a number that is
// not given: it then scales 1.
static material material_as_written(const mtl_material *w) {
  material m = {
      .name = w->name,
      .kd = w->kd,
      .ks = w->ks,
      .ke = w->ke,
      .ns = w->ns,
      .ni = w->ni,
      .d = w->d,
      .roughness = w->pr,
      .metallic = w->pm,
      .map_kd = map_of(w, MTL_MAP_KD, true),
      .map_ks = map_of(w, MTL_MAP_KS, true),
      .map_ke = map_of(w, MTL_MAP_KE, true),
      .map_ns = map_of(w, MTL_MAP_NS, false),
      .map_d = map_of(w, MTL_MAP_D, false),
      .map_pr = map_of(w, MTL_MAP_PR, false),
      .map_pm = map_of(w, MTL_MAP_PM, false),
      .map_bump = map_of(w, MTL_MAP_BUMP, false),
      .map_norm = map_of(w, MTL_MAP_NORM, false),
  };
  const uint32_t *line = w->line;
  if (line[MTL_MAP_KS] != 0 && line[MTL_KS] == 0) m.ks = vec3_all(1);
  if (line[MTL_MAP_KE] != 0 && line[MTL_KE] == 0) m.ke = vec3_all(1);
  if (line[MTL_MAP_NS] != 0 && line[MTL_NS] == 0) m.ns = USUAL_MAP_NS;
  if (line[MTL_MAP_PR] != 0 && line[MTL_PR] == 0) m.roughness = 1;
  if (line[MTL_MAP_PM] != 0 && line[MTL_PM] == 0) m.metallic = 1;
  return m;
}

// Rules 2 to 5 for what w says, in order.
static void decide_by_content(material *m, const mtl_material *w,
                              const material_use *use, arena *mem) {
  const char *object = use->assigned != NULL ? NULL : use->object;
  const char *name = use->assigned != NULL ? w->name : use->name;
  if (rule_metal_rough(m, w, mem)) return;
  if (rule_illum(m, w, mem)) return;
  if (use->name_rules && rule_name(m, w, object, "object", mem)) return;
  if (use->name_rules && rule_name(m, w, name, "material", mem)) return;
  m->kind = MATERIAL_BLINN_PHONG;
  m->rule = 5;
  m->why = w->file == NULL ? "no material"
                           : arena_format(mem, "newmtl %s at %s:%u", w->name,
                                          w->file, w->newmtl_line);
}

material material_decide(const material_use *use, arena *mem) {
  mtl_material grey = mtl_default(use->name == NULL ? "" : use->name);
  const mtl_material *w = use->assigned != NULL  ? use->assigned
                          : use->written != NULL ? use->written
                                                 : &grey;
  material m = material_as_written(w);
  decide_by_content(&m, w, use, mem);
  if (use->assigned != NULL) {
    m.rule = 1;
    m.why = arena_format(mem, "assign at %s, then %s", use->assigned_at, m.why);
  }
  m.why = arena_format(mem, "rule %d: %s", m.rule, m.why);
  m.source = w == &grey ? NULL : w;
  m.passes =
      m.kind != MATERIAL_GLASS && (m.d < 1 || m.map_d.options.path != NULL);
  return m;
}

texture_map *material_map(material *m, int k) {
  texture_map *const all[MATERIAL_MAPS] = {
      &m->map_kd, &m->map_ks, &m->map_ke,   &m->map_ns,  &m->map_d,
      &m->map_pr, &m->map_pm, &m->map_bump, &m->map_norm};
  return all[k];
}

unsigned material_reads(const material *m, material_kind as) {
  enum { KD = 1, KS = 2, KE = 4, NS = 8, D = 16, PR = 32, PM = 64 };
  const unsigned normals = 128 | 256;
  unsigned reads = normals;
  if (vec3_peak(m->ke) > 0) reads |= KE;
  if (m->passes) reads |= D;
  switch (as) {
  case MATERIAL_BLINN_PHONG: return reads | KD | KS | NS;
  case MATERIAL_METAL_ROUGH: return reads | KD | PR | PM;
  case MATERIAL_MIRROR: return reads | KS;
  case MATERIAL_GLASS: break;
  }
  return reads;
}
