// figures.c — the pictures of chapter 17, and the numbers its text quotes.

#include "num.h"
#include "picture.h"
#include "tonemap.h"

#include <stdio.h>
#include <stdlib.h>

// A strip of a picture, and the stops that it spans from left to right.
enum { WIDTH = 480, STRIP = 28, GAP = 4 };
#define LEFT_STOPS (-6.0f)
#define RIGHT_STOPS 6.0f

// The colours of the strips of a curve: white light, and that of a lamp.
static const vec3 LIGHTS[] = {{1, 1, 1}, {1, 0.45f, 0.1f}};

static void write_strips(const char *path, const int *curves, int count) {
  arena mem = {0};
  image out = image_new(&mem, WIDTH, count * (2 * STRIP + GAP) - GAP);
  for (int i = 0; i < out.width * out.height; i++)
    out.pixels[i] = vec3_all(1);
  for (int k = 0; k < 2 * count; k++) {
    image strip = image_new(&mem, WIDTH, STRIP);
    for (int i = 0; i < WIDTH * STRIP; i++) {
      float u = ((float)(i % WIDTH) + 0.5f) / (float)WIDTH;
      float stops = LEFT_STOPS + u * (RIGHT_STOPS - LEFT_STOPS);
      strip.pixels[i] = vec3_scale(LIGHTS[k % 2], num_exp2(stops));
    }
    tonemap_apply(&strip, 0, (tonemap_curve)curves[k / 2]);
    int top = k * STRIP + k / 2 * GAP;
    for (int i = 0; i < WIDTH * STRIP; i++)
      out.pixels[top * WIDTH + i] = strip.pixels[i];
  }
  error err;
  if (!picture_write(&out, path, PICTURE_PNG, 8, &err)) {
    fprintf(stderr, "%s\n", err.text);
    exit(4);
  }
  arena_free(&mem);
}

// What each curve makes of radiance 1 and 8.
static void print_curves(void) {
  static const char *const names[] = {"none", "reinhard", "aces"};
  for (int curve = 0; curve < 3; curve++) {
    vec3 p[2] = {vec3_all(1), vec3_all(8)};
    image im = {2, 1, p};
    tonemap_apply(&im, 0, (tonemap_curve)curve);
    printf("%-8s 1 -> %.3f, 8 -> %.3f\n", names[curve], (double)p[0].x,
           (double)p[1].x);
  }
}

int main(int argc, char **argv) {
  if (argc != 2) return 2;
  char path[4096];
  snprintf(path, sizeof path, "%s/curves.png", argv[1]);
  write_strips(path,
               (const int[]){TONEMAP_NONE, TONEMAP_REINHARD, TONEMAP_ACES}, 3);
  snprintf(path, sizeof path, "%s/clipped.png", argv[1]);
  write_strips(path, (const int[]){TONEMAP_NONE}, 1);
  print_curves();
  return 0;
}
