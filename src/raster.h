// raster.h — a scene drawn by OpenGL: every triangle once, no rays.
//
// What it shows is direct light of point and directional lights, with shadow
// maps; light from the environment, roughly; mirrors and glass
// that see the environment alone.  Direct light without shadows is that of the
// path engine.  No GL header here: the command line includes this.

#ifndef RASTER_H
#define RASTER_H

#include "raster_settings.h"

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

// Draw one frame and resolve it.  view is of the whole film, width x height.
// Fails when a program does not compile that was not needed before.
bool raster_draw(raster *r, const camera_view *view, error *err);

// The same without waiting for its end: for frames that follow each other.
// raster_wait returns when all of them are done.
bool raster_draw_next(raster *r, const camera_view *view, error *err);
void raster_wait(const raster *r);

// Resolve the last frame once more: the seconds that takes alone.
double raster_resolve_seconds(const raster *r);

// The frame as linear floats; of the crop window, row 0 on top.
image raster_read(raster *r, arena *mem);

// Means over a pixel's samples of their first surfaces, as in the path
// engine's AOVs: normal (-1..1), distance along the view axis, base colour.
// Draws a pass of its own with the view of the last raster_draw.  which is
// RASTER_NORMAL, RASTER_DEPTH or RASTER_ALBEDO.
bool raster_read_aov(image *out, raster *r, raster_shading which, arena *mem,
                     error *err);

// New settings for the next frames; width, height, crop and msaa stay.  All
// programs are made anew.
bool raster_change(raster *r, const raster_settings *set, error *err);

// The materials as drawn, to be changed between frames: numbers and colours,
// not kind or maps.  As many as the scene's, at least 1.
material *raster_materials(raster *r, size_t *count);

// Leave out or show again the triangles of a material, as an index into the
// scene's.
void raster_hide(raster *r, size_t which, bool hidden);

// The framebuffer of the last frame, for passes after it and for the window:
// a GL name, as are those of its resolved colour texture.
typedef struct raster_frame {
  unsigned framebuffer, texture;
  int width, height, samples;
} raster_frame;
raster_frame raster_last_frame(const raster *r);

raster_times raster_last_times(const raster *r);
raster_counts raster_last_counts(const raster *r);

#endif
