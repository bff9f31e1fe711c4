// figures.c — the pictures of chapter 12, and the numbers its text quotes.

#include "camera.h"
#include "num.h"
#include "picture.h"
#include "wide.h"

#include <stdio.h>
#include <stdlib.h>

// Where the pictures go, and the threads that make them.
typedef struct output {
  const char *folder;
  arena mem;
  pool *threads;
} output;

// Write a picture, or say why not and end.
static void publish(output *o, const char *name, image im) {
  error err;
  const char *path = arena_format(&o->mem, "%s/%s.png", o->folder, name);
  if (picture_write(&im, path, PICTURE_PNG, 8, &err)) return;
  fprintf(stderr, "%s\n", err.text);
  exit(4);
}

// ---- A mesh by formula ----

// A mesh that is being filled; its arrays are large enough from the start.
typedef struct rock {
  vec3 *p;
  uint32_t *index;
  uint32_t vertices, triangles;
} rock;

static float wave(float x) {
  return num_circle(x - floorf(x)).y;
}

// Bumps of six sizes on the unit sphere.
static vec3 rock_point(vec3 d) {
  float r = 1, size = 0.16f, often = 0.37f;
  for (int k = 0; k < 6; k++) {
    vec3 u = vec3_scale(d, often);
    r += size * wave(u.x + 0.6f * wave(u.y)) * wave(u.y + 0.6f * wave(u.z)) *
         wave(u.z + 0.1f * (float)k);
    size *= 0.55f;
    often *= 2.1f;
  }
  return vec3_scale(d, r);
}

// Six faces of n x n cells, pushed out to the sphere.
static rock rock_of(arena *mem, uint32_t n) {
  size_t cells = 6 * (size_t)n * n, points = 6 * (size_t)(n + 1) * (n + 1);
  rock m = {ARENA_NEW(mem, vec3, points), ARENA_NEW(mem, uint32_t, 6 * cells),
            0, 0};
  for (int f = 0; f < 6; f++) {
    uint32_t first = m.vertices, row = n + 1;
    for (uint32_t i = 0; i < row * row; i++) {
      float u = 2 * (float)(i % row) / (float)n - 1;
      float v = 2 * (float)(i / row) / (float)n - 1, s = f & 1 ? 1 : -1;
      vec3 d = f < 2   ? (vec3){s, s * u, v}
               : f < 4 ? (vec3){v, s, s * u}
                       : (vec3){s * u, v, s};
      m.p[m.vertices++] = rock_point(vec3_unit(d));
    }
    for (uint32_t i = 0; i < n * n; i++) {
      uint32_t a = first + i / n * row + i % n, b = a + row;
      uint32_t *t = m.index + 3 * (size_t)m.triangles;
      t[0] = t[4] = a;
      t[1] = t[3] = a + 1;
      t[2] = t[5] = b;
      t[3] = b;
      t[4] = a + 1;
      t[5] = b + 1;
      m.triangles += 2;
    }
  }
  return m;
}

// ---- Heat ----

// From black through red to white, for x from 0 to 1.
static vec3 heat_color(float x) {
  static const vec3 stops[6] = {{0, 0, 0.02f},     {0.03f, 0.02f, 0.35f},
                                {0.35f, 0, 0.25f}, {0.85f, 0.12f, 0.01f},
                                {1, 0.65f, 0.05f}, {1, 1, 0.9f}};
  float at = fminf(fmaxf(x, 0), 0.9999f) * 5;
  int k = (int)at;
  return vec3_lerp(stops[k], stops[k + 1], at - (float)k);
}

// Nodes that the ray of each pixel visits, in the binary tree and in the wide
// one, by the same colours: white is 60.
static void draw_heats(output *o, const bvh *b, const wide_tree *w) {
  const camera c = {NULL, {1.4f, 1.6f, 3.2f}, {0, 0, 0}, {0, 1, 0}, 36};
  const wide_level *level = wide_level_at(0);
  camera_view view;
  error err;
  if (!camera_view_of(&view, &c, 236, 236, &err)) exit(3);
  image im = image_new(&o->mem, 480, 236);
  double sum[2] = {0};
  for (int i = 0; i < 480 * 236; i++)
    im.pixels[i] = (vec3){1, 1, 1};
  for (int i = 0; i < 236 * 236; i++) {
    ray r = camera_ray(&view, (float)(i % 236) + 0.5f, (float)(i / 236) + 0.5f);
    hit h;
    bvh_visits v[2] = {{0}};
    bvh_closest_counted(b, &r, &h, &v[0]);
    level->closest_counted(w, &r, &h, &v[1]);
    for (int k = 0; k < 2; k++) {
      sum[k] += v[k].nodes;
      im.pixels[i / 236 * 480 + 244 * k + i % 236] =
          heat_color((float)v[k].nodes / 60);
    }
  }
  publish(o, "heat", im);
  printf("nodes a pixel: binary %.1f, wide %.1f\n", sum[0] / (236 * 236),
         sum[1] / (236 * 236));
}

int main(int argc, char **argv) {
  output o = {.folder = argc > 1 ? argv[1] : "."};
  o.threads = pool_new(&o.mem, pool_default_threads());
  rock m = rock_of(&o.mem, 100);
  bvh b;
  bvh_build(&b, m.p, m.index, m.triangles, BVH_SAH, &o.mem, o.threads);
  wide_tree w;
  wide_tree_build(&w, &b, &o.mem, o.threads);
  draw_heats(&o, &b, &w);
  pool_free(o.threads);
  arena_free(&o.mem);
  return 0;
}
