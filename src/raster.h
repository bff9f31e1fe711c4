// raster.h — a scene drawn by OpenGL: every triangle once, no rays.
//
// What it shows is direct light of point and directional lights, with shadow
// maps; light from the environment through raster_ambient; mirrors and glass
// that see the environment alone.  Direct light without shadows is that of the
// path engine.  No GL header here: the command line includes this.

#ifndef RASTER_H
#define RASTER_H

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

// Light from the environment, by whoever has prepared it.  All zero is what
// chapter 5 has: one irradiance from above and one from below.
typedef struct raster_ambient {
  const char *shader;   // file of shaders/ in place of ambient.glsl: defines
                        //   vec3 ambient_irradiance(vec3 n)
                        //   vec3 ambient_radiance(vec3 d, float roughness)
  const char *defines;  // lines for the shaders, or NULL
  // Bind textures to units first_unit, first_unit + 1, ... and set uniforms
  // of the program, which is in use.
  void (*bind)(const void *context, const gl *g, unsigned program,
               int first_unit);
  const void *context;
} raster_ambient;

// The first texture unit that is free for raster_ambient.bind.
enum { RASTER_AMBIENT_UNIT = 11 };

// The most point and directional lights.
enum { RASTER_MAX_LIGHTS = 32 };

typedef struct raster_settings {
  int width, height;
  int x0, y0, x1, y1;  // crop, half-open; all of the film when x1 is 0
  int msaa;            // samples a pixel: 1 is one in its middle; 0 counts as 1
  bool lights, shadows;
  bool sky;  // show the environment behind everything
  raster_shading shading;
  raster_model model;
  bool force_blinn_phong, force_pbr;  // --shading: every material by one model
  raster_ambient ambient;
  int shadow_size;  // texels a side of a shadow map; 0: chosen
} raster_settings;

// A scene in the memory of a context.
typedef struct raster raster;

// Seconds by stage, of raster_new and of the last raster_draw; drawing ends
// with the last pixel, not with the last command.
typedef struct raster_times {
  double upload, compile, shadow, draw, read;
} raster_times;

// Upload s and compile what it needs.  The scene and the context must outlive
// *out.  Fails when there are too many lights, when a shader does not compile
// or the framebuffer does not fit (exit status 5).
bool raster_new(raster **out, gl *g, const scene *s, const raster_settings *set,
                arena *mem, error *err);
void raster_free(raster *r);

// Draw one frame and resolve it.  Settings but width, height, msaa and crop
// may change from frame to frame through raster_change.
void raster_draw(raster *r, const camera_view *view);

// The frame as linear floats; of the crop window, row 0 on top.
image raster_read(raster *r, arena *mem);

// Means over a pixel's samples of their first surfaces, as in the path
// engine's AOVs: normal (-1..1), distance along the view axis, base colour.
// Draws a pass of its own with the view of the last raster_draw.  which is
// RASTER_NORMAL, RASTER_DEPTH or RASTER_ALBEDO.
bool raster_read_aov(image *out, raster *r, raster_shading which, arena *mem,
                     error *err);

// New settings; programs are compiled where they need others.
bool raster_change(raster *r, const raster_settings *set, error *err);

// The materials as drawn, to be changed between frames: numbers and colours,
// not kind or maps.  As many as the scene's, at least 1.
material *raster_materials(raster *r, size_t *count);

// Leave out or show again the triangles of a material, as an index into the
// scene's.
void raster_hide(raster *r, size_t material, bool hidden);

// The framebuffer of the last frame, for passes after it and for the window:
// a GL name, as are those of its resolved colour texture.
typedef struct raster_frame {
  unsigned framebuffer, texture;
  int width, height;
} raster_frame;
raster_frame raster_last_frame(const raster *r);

raster_times raster_last_times(const raster *r);

#endif
