// sketch.h — a drawing as a list of strokes: to look at as a picture, or to
// keep as SVG.

#ifndef SKETCH_H
#define SKETCH_H

#include "image.h"

#include <stdio.h>

// A line through points, drawn with a round pen.  One point is a dot.
typedef struct sketch_stroke {
  vec3 color;   // linear
  float width;  // in pixels
  size_t count;
  vec2 *points;
  struct sketch_stroke *next;
} sketch_stroke;

// Pixels, (0, 0) the upper left corner of the paper, y downwards; later strokes
// cover earlier ones.
typedef struct sketch {
  arena *mem;
  int width, height;
  sketch_stroke *first, *last;
} sketch;

typedef struct sketch_pen {
  vec3 color;
  float width;
} sketch_pen;

// White paper whose strokes will live in mem.
sketch sketch_new(arena *mem, int width, int height);

// Draw through n points, which are copied.
void sketch_line(sketch *s, sketch_pen pen, const vec2 *points, size_t n);
void sketch_dot(sketch *s, sketch_pen pen, vec2 at);

// The same in dashes of the given length, with gaps as long.
void sketch_dashes(sketch *s, sketch_pen pen, const vec2 *points, size_t n,
                   float length);

// How text is set: the height of a capital in pixels; the share of its length
// that lies before the point it is given (0 left, 0.5 centred, 1 right);
// upwards instead of to the right.
typedef struct sketch_type {
  float size, align;
  bool up;
} sketch_type;

// Set text with its base line through at.
void sketch_text(sketch *s, sketch_pen pen, const sketch_type *type, vec2 at,
                 const char *text);

// How long it is, in pixels.
float sketch_text_length(float size, const char *text);

// As a picture, in linear light; every pixel mixes by the share that a stroke
// covers of it.
image sketch_image(const sketch *s, arena *mem);

// As a document of SVG 1.1.
void sketch_svg(const sketch *s, FILE *out);

#endif
