// raster_settings.h — what the rasteriser is asked for.

#ifndef RASTER_SETTINGS_H
#define RASTER_SETTINGS_H

#include "gl.h"
#include "scene.h"

// What a pixel shows: the same as of the path engine's pictures.
typedef enum raster_shading {
  RASTER_RADIANCE,
  RASTER_NORMAL,  // (n + 1) / 2 of the shading normal, 0 where there is none
  RASTER_DEPTH,   // along the view axis, over that of the farthest corner of
                  // the scene's box; 1 where there is nothing
  RASTER_ALBEDO
} raster_shading;

// The formulas of metallic-roughness.
typedef enum raster_model { RASTER_GGX, RASTER_REPORT } raster_model;

// Shader files in the place of this chapter's own, with what they need.  The
// later chapters' way into a surface's program.
typedef struct raster_piece {
  const char *shaders[4];  // files of shaders/, NULL at the end
  const char *defines;     // lines for every shader, or NULL
  // Of an environment: whether light under a lobe of that roughness is a whole
  // level, and then that level's first texel and width.  May be NULL.
  bool (*level)(const void *context, float roughness, int place[2]);
  // Bind textures to units first_unit, first_unit + 1, ... and set uniforms
  // of the program, which is in use.  Called before each material is drawn.
  void (*bind)(const void *context, const gl *g, unsigned program,
               int first_unit);  // may be NULL
  const void *context;
} raster_piece;

// The first texture units that are free for the pieces' bind.
enum { RASTER_AMBIENT_UNIT = 11, RASTER_METAL_ROUGH_UNIT = 14 };

// The most point and directional lights.
enum { RASTER_MAX_LIGHTS = 32 };

// What nobody would see, and what therefore is left out; zero leaves out
// nothing.  Chapter 13 finds it out.
typedef struct raster_spared {
  bool outside;        // triangles outside of what a camera or a lamp sees
  bool edges;          // triangles with two corners in one place
  bool covered;        // the sky, if a test says that surfaces cover it
  const bool *unseen;  // by material: none of it is in view; may be NULL
} raster_spared;

typedef struct raster_settings {
  int width, height;
  int x0, y0, x1, y1;  // crop, half-open; all of the film when x1 is 0
  int msaa;            // samples a pixel: 1 is one in its middle; 0 counts as 1
  bool lights, shadows;
  bool sky;   // show the environment behind everything
  bool each;  // shade every triangle where it is drawn, not every pixel once
  raster_shading shading;
  raster_model model;
  bool force_blinn_phong, force_pbr;  // --shading: every material by one model
  // In place of ambient.glsl: light from the environment.  Defines
  //   vec3 ambient_irradiance(vec3 n)
  //   vec3 ambient_radiance(vec3 d, float roughness)
  raster_piece ambient;
  // In place of metal_rough.glsl.  Defines
  //   vec3 matter_direct(matter m, vec3 n, vec3 wo, vec3 wi)
  //   vec3 matter_ambient(matter m, vec3 n, vec3 wo)
  raster_piece metal_rough;
  int shadow_size;  // texels a side of a shadow map; 0: chosen
  raster_spared spared;
  bool thorough;  // make programs for every kind of surface
} raster_settings;

// What was done, in numbers: of raster_new and the last raster_draw.
typedef struct raster_counts {
  size_t kinds, programs;  // of surface, among all programs
  size_t maps, map_bytes;  // textures of materials, without their mipmaps
  double map_seconds;      // that they took
  size_t uploaded, bytes;  // triangles, and bytes of their vertices
  double seconds;          // that these took
  size_t once;             // frames in which visibility came first
  size_t lamps;            // that programs know of
  size_t drawn;            // triangles, for the eye
  size_t layers, casters;  // shadow maps drawn into; triangles in all of them
  size_t shadow_bytes;
  size_t skies, resolves;  // passes
} raster_counts;

#endif
