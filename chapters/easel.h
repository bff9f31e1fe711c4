// easel.h — what the programs of the chapters share: white paper, pixels, and
// a place to hang pictures.

#ifndef EASEL_H
#define EASEL_H

#include "picture.h"

#include <stdio.h>
#include <stdlib.h>

// Say what went wrong, and end.
static inline _Noreturn void give_up(const error *err, int status) {
  fprintf(stderr, "%s\n", err->text);
  exit(status);
}

// Write a picture into the folder, or say why not and end.
static inline void publish(const char *folder, const char *name, image im) {
  error err;
  arena mem = {0};
  const char *path = arena_format(&mem, "%s/%s.png", folder, name);
  if (!picture_write(&im, path, PICTURE_PNG, 8, &err)) give_up(&err, 4);
  arena_free(&mem);
}

// Pixel (x, y), which lies in the image.
static inline vec3 *pixel(image im, int x, int y) {
  return &im.pixels[(size_t)y * (size_t)im.width + (size_t)x];
}

static inline image tinted(arena *mem, int width, int height, vec3 color) {
  image im = image_new(mem, width, height);
  for (int i = 0; i < width * height; i++)
    im.pixels[i] = color;
  return im;
}

static inline image paper(arena *mem, int width, int height) {
  return tinted(mem, width, height, vec3_all(1));
}

// Copy one picture into another, its left upper corner at (x0, y0).
static inline void paste(image to, image from, int x0, int y0) {
  for (int y = 0; y < from.height; y++)
    for (int x = 0; x < from.width; x++)
      *pixel(to, x0 + x, y0 + y) = *pixel(from, x, y);
}

// A line one pixel wide, its ends in pixels; what lies outside is left out.
static inline void draw_thin_line(image im, vec2 a, vec2 b, vec3 color) {
  float length = fmaxf(fabsf(b.x - a.x), fabsf(b.y - a.y));
  int steps = (int)(4 * length) + 1;
  for (int i = 0; i <= steps; i++) {
    float t = (float)i / (float)steps;
    int x = (int)(a.x + t * (b.x - a.x)), y = (int)(a.y + t * (b.y - a.y));
    if (x >= 0 && x < im.width && y >= 0 && y < im.height)
      *pixel(im, x, y) = color;
  }
}

// Pictures of one height side by side, four white pixels between them.
static inline image row_of(arena *mem, const image *parts, int n) {
  int width = -4;
  for (int i = 0; i < n; i++)
    width += parts[i].width + 4;
  image all = paper(mem, width, parts[0].height);
  for (int i = 0, at = 0; i < n; at += parts[i].width + 4, i++)
    paste(all, parts[i], at, 0);
  return all;
}

#endif
