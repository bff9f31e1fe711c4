// gl_worlds.h — contexts and drawn worlds, for the tests of the rasteriser.

#ifndef GL_WORLDS_H
#define GL_WORLDS_H

#include "gl_api.h"
#include "raster.h"
#include "worlds.h"

// A context, or a test that is skipped with the reason.
static inline gl *gl_or_skip(gl_backend b, arena *mem) {
  gl *g;
  error err;
  if (gl_open(&g, b, mem, &err)) return g;
  print_message("# SKIP %s\n", err.text);
  skip();
  return NULL;
}

// A stage of a program, put together from n pieces of text.
static inline GLuint compiled(const gl_api *f, GLenum stage, int n,
                              const char *const *text) {
  GLuint s = f->CreateShader(stage);
  GLint ok;
  char log[2000] = "";
  f->ShaderSource(s, n, text, NULL);
  f->CompileShader(s);
  f->GetShaderiv(s, GL_COMPILE_STATUS, &ok);
  f->GetShaderInfoLog(s, sizeof log, NULL, log);
  if (!ok) print_message("# %s\n", log);
  assert_true(ok);
  return s;
}

// What a world looks like to the rasteriser.
static inline image drawn(const world *w, gl *g, const camera_view *v,
                          const raster_settings *set, arena *mem) {
  raster *r;
  error err = {{0}};
  if (!raster_new(&r, g, &w->scene, set, mem, &err) ||
      !raster_draw(r, v, &err)) {
    print_message("# %s\n", err.text);
    fail();
  }
  image out = raster_read(r, mem);
  raster_free(r);
  return out;
}

static inline bool never(const void *tree, const ray *r) {
  (void)tree;
  (void)r;
  return false;
}

// Light along the ray through the middle of a pixel: direct light alone, with
// shadows or without.
static inline vec3 traced(const world *w, const camera_view *v, int x, int y,
                          bool shadows) {
  path_world p = w->path;
  p.max_depth = 2;
  if (!shadows) p.tracer.any = never;
  path_stats stats = {0};
  rng random = rng_of(0, 0, 0);
  ray r = camera_ray(v, (float)x + 0.5f, (float)y + 0.5f);
  return path_naive_radiance(&p, r, &random, &stats);
}

// Whether the rays a little to the four sides of a pixel's middle meet
// different triangles.
static inline bool on_edge(const world *w, const camera_view *v, int x, int y) {
  uint32_t seen[4];
  for (int i = 0; i < 4; i++) {
    float dx = i & 1 ? 0.01f : -0.01f, dy = i & 2 ? 0.01f : -0.01f;
    ray r = camera_ray(v, (float)x + 0.5f + dx, (float)y + 0.5f + dy);
    hit h = {.triangle = HIT_NONE};
    w->path.tracer.closest(w->path.tracer.tree, &r, &h);
    seen[i] = h.triangle;
  }
  return seen[0] != seen[1] || seen[0] != seen[2] || seen[0] != seen[3];
}

// The 8-bit difference: of linear values clamped to 1.
static inline float far_apart(vec3 a, vec3 b) {
  vec3 one = vec3_all(1);
  return vec3_peak(vec3_abs(vec3_sub(vec3_min(a, one), vec3_min(b, one))));
}

#endif
