// raster_program.c

#include "raster_program.h"

#include "clock.h"
#include "glsl.h"
#include "raster_maps.h"
#include "raster_mesh.h"

#include <ctype.h>
#include <string.h>

material_kind raster_kind(const raster_settings *set, const material *m) {
  bool opaque =
      m->kind == MATERIAL_BLINN_PHONG || m->kind == MATERIAL_METAL_ROUGH;
  if (opaque && set->force_blinn_phong) return MATERIAL_BLINN_PHONG;
  if (opaque && set->force_pbr) return MATERIAL_METAL_ROUGH;
  return m->kind;
}

float raster_roughness(material_kind kind, const material *m) {
  if (kind == MATERIAL_METAL_ROUGH) return m->roughness;
  if (kind == MATERIAL_BLINN_PHONG) return sqrtf(sqrtf(2 / (m->ns + 2)));
  return 0;
}

raster_gloss_place raster_gloss_place_of(const raster_settings *set,
                                         const material *m) {
  const raster_piece *from = &set->ambient;
  int place[2] = {0, 0};
  float roughness = raster_roughness(raster_kind(set, m), m);
  if (from->level != NULL) from->level(from->context, roughness, place);
  return (raster_gloss_place){place[0], place[1]};
}

// What the program may take for granted of the gloss.
static raster_gloss gloss_of(const raster_settings *set, material_kind kind,
                             const material *m) {
  const raster_piece *from = &set->ambient;
  bool rough = kind == MATERIAL_METAL_ROUGH;
  bool phong = kind == MATERIAL_BLINN_PHONG;
  if ((rough && m->map_pr.image != NULL) || (phong && m->map_ns.image != NULL))
    return RASTER_GLOSS_ANY;
  float roughness = raster_roughness(kind, m);
  int place[2];
  if (!(roughness > 0)) return RASTER_GLOSS_SHARP;
  return from->level != NULL && from->level(from->context, roughness, place)
             ? RASTER_GLOSS_LEVEL
             : RASTER_GLOSS_ANY;
}

raster_variant raster_variant_of(const raster_settings *set, const material *m,
                                 raster_shading shading) {
  raster_variant v = {.stage = RASTER_STAGE_SURFACE,
                      .kind = raster_kind(set, m),
                      .shading = shading};
  for (int k = 0; k < RASTER_MAP_COUNT; k++)
    if (raster_map_of(m, k)->image != NULL) v.maps |= 1u << k;
  v.maps &= material_reads(m, v.kind);
  if (shading != RASTER_RADIANCE) return v;
  v.gloss = gloss_of(set, v.kind, m);
  v.clear = v.kind == MATERIAL_METAL_ROUGH && vec3_peak(m->tf) > 0;
  return v;
}

// The define of a kind of surface, and its file of shaders/.
static const char *const KIND_DEFINES[] = {
    [MATERIAL_BLINN_PHONG] = "#define KIND_BLINN_PHONG\n",
    [MATERIAL_METAL_ROUGH] = "#define KIND_METAL_ROUGH\n",
    [MATERIAL_MIRROR] = "#define KIND_MIRROR\n",
    [MATERIAL_GLASS] = "#define KIND_GLASS\n",
};
static const char *const KIND_FILES[] = {
    [MATERIAL_BLINN_PHONG] = "blinn_phong.glsl",
    [MATERIAL_METAL_ROUGH] = "metal_rough.glsl",
    [MATERIAL_MIRROR] = "mirror.glsl",
    [MATERIAL_GLASS] = "clear.glsl",
};

static const char *or_nothing(const char *text) {
  return text == NULL ? "" : text;
}

// The define of what is known of the gloss.
static const char *const GLOSS_DEFINES[] = {
    [RASTER_GLOSS_ANY] = "",
    [RASTER_GLOSS_SHARP] = "#define GLOSS_SHARP\n",
    [RASTER_GLOSS_LEVEL] = "#define GLOSS_LEVEL\n",
};

// All the #define lines of a variant.
static char *defines_of(const raster_programs *p, raster_variant v,
                        arena *mem) {
  const raster_settings *set = p->set;
  char *text = arena_format(
      mem,
      "#define LIGHTS %zu\n#define ENV_KIND %d\n#define FIRST %d\n"
      "#define SKY_DEPTH %s\n#define SHADOW_DEPTH(z) %s\n%s%s%s%s%s%s",
      set->lights ? p->lights : 0, (int)p->env, (int)v.shading,
      p->clip_control ? "0.0" : "1.0",
      p->clip_control ? "(z)" : "(0.5 + 0.5 * (z))", KIND_DEFINES[v.kind],
      GLOSS_DEFINES[v.gloss], v.clear ? "#define CLEAR\n" : "",
      set->model == RASTER_REPORT ? "#define MODEL_REPORT\n" : "",
      or_nothing(set->ambient.defines), or_nothing(set->metal_rough.defines));
  text = arena_format(
      mem, "%s#define SAMPLES %d\n#define CLIP_Z(d) %s\n%s%s", text, p->samples,
      p->clip_control ? "(d)" : "(2.0 * (d) - 1.0)",
      p->colors ? "#define COLORS\n" : "", v.once ? "#define ONCE\n" : "");
  if (p->shadow_layers > 0 && set->lights)
    text = arena_format(mem, "%s#define SHADOWS\n#define SHADOW_LAYERS %zu\n",
                        text, p->shadow_layers);
  for (int k = 0; k < RASTER_MAP_COUNT; k++) {
    if (!(v.maps >> k & 1)) continue;
    char name[8];
    size_t n = strlen(raster_map_name(k));
    for (size_t i = 0; i <= n; i++)
      name[i] = (char)toupper((unsigned char)raster_map_name(k)[i]);
    text = arena_format(mem, "%s#define MAP_%s\n", text, name);
  }
  return text;
}

// Append files to the list of a stage.
static void add_parts(const char **parts, const char *const *more) {
  size_t n = 0;
  while (parts[n] != NULL)
    n++;
  for (; *more != NULL && n + 1 < GLSL_MAX_PARTS; more++)
    parts[n++] = *more;
}

static void add_part(const char **parts, const char *file) {
  add_parts(parts, (const char *const[]){file, NULL});
}

// The files of a piece, or this chapter's own file in their place.
static void add_piece(const char **parts, const raster_piece *piece,
                      const char *own) {
  if (piece->shaders[0] == NULL)
    add_part(parts, own);
  else
    add_parts(parts, piece->shaders);
}

static void surface_parts(glsl_spec *spec, const raster_programs *p,
                          raster_variant v) {
  const char **parts = spec->fragment;
  spec->vertex[0] = v.once ? "cover.vert" : "surface.vert";
  add_part(parts, "num.glsl");
  if (v.once) add_part(parts, "seen.glsl");
  add_part(parts, v.once ? "at_once.glsl" : "at.glsl");
  add_part(parts, "env.glsl");
  add_piece(parts, &p->set->ambient, "ambient.glsl");
  add_part(parts, "matter.glsl");
  add_part(parts, "normal.glsl");
  if (v.shading != RASTER_RADIANCE) {
    add_part(parts, "first.frag");
    return;
  }
  add_part(parts, "glass.glsl");
  if (v.kind == MATERIAL_METAL_ROUGH)
    add_piece(parts, &p->set->metal_rough, KIND_FILES[v.kind]);
  else
    add_part(parts, KIND_FILES[v.kind]);
  add_part(parts, "light.glsl");
  add_part(parts, "shadow.glsl");
  add_part(parts, "surface.frag");
}

static glsl_spec parts_of(const raster_programs *p, raster_variant v) {
  glsl_spec spec = {.attributes = RASTER_ATTRIBUTES};
  switch (v.stage) {
  case RASTER_STAGE_SURFACE: surface_parts(&spec, p, v); break;
  case RASTER_STAGE_SKY:
    spec.vertex[0] = v.once ? "cover.vert" : "sky.vert";
    add_part(spec.fragment, "num.glsl");
    if (v.once) add_part(spec.fragment, "seen.glsl");
    add_part(spec.fragment, "env.glsl");
    add_part(spec.fragment, v.once ? "sky_once.frag" : "sky.frag");
    break;
  case RASTER_STAGE_SHADOW:
    spec.vertex[0] = "shadow.vert";
    spec.fragment[0] = "shadow.frag";
    break;
  case RASTER_STAGE_SHADOW_SHEET:
    spec.vertex[0] = "surface.vert";
    add_part(spec.fragment, "num.glsl");
    add_part(spec.fragment, "at.glsl");
    add_part(spec.fragment, "matter.glsl");
    add_part(spec.fragment, "shadow_sheet.frag");
    break;
  case RASTER_STAGE_SEEN:
    spec.vertex[0] = "shadow.vert";
    spec.fragment[0] = "seen.frag";
    break;
  case RASTER_STAGE_VEIL:
    spec.vertex[0] = "sky.vert";
    spec.fragment[0] = "shadow.frag";
    break;
  case RASTER_STAGE_KIND:
    spec.vertex[0] = "cover.vert";
    add_part(spec.fragment, "seen.glsl");
    add_part(spec.fragment, "kind.frag");
    break;
  }
  return spec;
}

bool raster_variant_same(raster_variant a, raster_variant b) {
  return a.stage == b.stage && a.kind == b.kind && a.shading == b.shading &&
         a.maps == b.maps && a.gloss == b.gloss && a.clear == b.clear &&
         a.once == b.once;
}

bool raster_program_get(GLuint *out, raster_programs *p, raster_variant v,
                        error *err) {
  for (size_t i = 0; i < p->count; i++)
    if (raster_variant_same(p->entries[i].variant, v)) {
      *out = p->entries[i].program;
      return true;
    }
  if (p->count == RASTER_MAX_PROGRAMS)
    return fail(err, "OpenGL: more than %d combinations of textures",
                RASTER_MAX_PROGRAMS);
  double start = clock_seconds();
  arena scratch = {0};
  glsl_spec spec = parts_of(p, v);
  spec.defines = defines_of(p, v, &scratch);
  GLuint program = 0;
  bool ok = glsl_program(&program, p->g, &spec, err);
  arena_free(&scratch);
  p->seconds += clock_seconds() - start;
  if (!ok) return false;
  p->entries[p->count++] = (raster_entry){v, program};
  *out = program;
  return true;
}

void raster_programs_free(raster_programs *p) {
  const gl_api *f = gl_functions(p->g);
  for (size_t i = 0; i < p->count; i++)
    f->DeleteProgram(p->entries[i].program);
  p->count = 0;
}

void raster_set1(const gl *g, GLuint program, const char *name, float x) {
  const gl_api *f = gl_functions(g);
  f->Uniform1f(f->GetUniformLocation(program, name), x);
}

void raster_set2(const gl *g, GLuint program, const char *name, vec2 v) {
  const gl_api *f = gl_functions(g);
  f->Uniform2f(f->GetUniformLocation(program, name), v.x, v.y);
}

void raster_set3(const gl *g, GLuint program, const char *name, vec3 v) {
  const gl_api *f = gl_functions(g);
  f->Uniform3f(f->GetUniformLocation(program, name), v.x, v.y, v.z);
}

void raster_set_unit(const gl *g, GLuint program, const char *name, int unit) {
  const gl_api *f = gl_functions(g);
  f->Uniform1i(f->GetUniformLocation(program, name), unit);
}
