// raster_program.h — a program for each way in which a surface is drawn, made
// when it is first needed.

#ifndef RASTER_PROGRAM_H
#define RASTER_PROGRAM_H

#include "gl.h"
#include "gl_api.h"
#include "raster_settings.h"

// What a program draws.
typedef enum raster_stage {
  RASTER_STAGE_SURFACE,
  RASTER_STAGE_SKY,
  RASTER_STAGE_SHADOW,        // solid: depth alone
  RASTER_STAGE_SHADOW_SHEET,  // where its opacity is at least a half
  RASTER_STAGE_SEEN,          // the number of each triangle
  RASTER_STAGE_KIND,          // which program a pixel wants, as depth
  RASTER_STAGE_VEIL           // nothing, where the sky would be
} raster_stage;

// What is known of a surface's gloss when its program is made: nothing, that
// it is sharp, or that it is a whole level of the environment.
typedef enum raster_gloss {
  RASTER_GLOSS_ANY,
  RASTER_GLOSS_SHARP,
  RASTER_GLOSS_LEVEL
} raster_gloss;

// All that tells one program from another in one scene.
typedef struct raster_variant {
  raster_stage stage;
  material_kind kind;
  raster_shading shading;
  unsigned maps;  // bit k: the material has texture k of raster_maps.h
  raster_gloss gloss;
  bool clear;  // metallic-roughness that lets light through
  bool once;   // of pixels: the triangle is known by its number
} raster_variant;

typedef struct raster_entry {
  raster_variant variant;
  GLuint program;
} raster_entry;

// The most programs of a scene: there are four kinds of surface, but many
// combinations of textures.
enum { RASTER_MAX_PROGRAMS = 64 };

// The programs so far, and what they have in common.
typedef struct raster_programs {
  const gl *g;
  const raster_settings *set;
  size_t lights, shadow_layers;  // 0 layers: no shadows
  env_kind env;
  int samples;        // a pixel, of what is seen
  bool colors;        // vertices have colours
  bool clip_control;  // depth is reversed, see raster_pass.h
  raster_entry entries[RASTER_MAX_PROGRAMS];
  size_t count;
  double seconds;  // spent in compiling
} raster_programs;

// The program for a variant, compiled when there is none yet.
bool raster_program_get(GLuint *out, raster_programs *p, raster_variant v,
                        error *err);

void raster_programs_free(raster_programs *p);

// How a material is drawn under --shading blinn-phong or pbr.
material_kind raster_kind(const raster_settings *set, const material *m);

// The roughness under which a surface sees the environment, textures aside: a
// Blinn-Phong highlight has one whose lobe is as wide, alpha^2 = 2 / (n + 2).
float raster_roughness(material_kind kind, const material *m);

// Where the environment lies that a material sees: first texel and width of a
// level, 0 where there is none.
typedef struct raster_gloss_place {
  int first, width;
} raster_gloss_place;
raster_gloss_place raster_gloss_place_of(const raster_settings *set,
                                         const material *m);

// The variant that draws a material's radiance or whatever else is asked for.
raster_variant raster_variant_of(const raster_settings *set, const material *m,
                                 raster_shading shading);

bool raster_variant_same(raster_variant a, raster_variant b);

// Uniforms of the program in use, by name; unknown names are passed over.
void raster_set1(const gl *g, GLuint program, const char *name, float x);
void raster_set2(const gl *g, GLuint program, const char *name, vec2 v);
void raster_set3(const gl *g, GLuint program, const char *name, vec3 v);
void raster_set_unit(const gl *g, GLuint program, const char *name, int unit);

#endif
