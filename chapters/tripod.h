// tripod.h — what the programs of the chapters from 3 on share: a scene from a
// file, and a camera put in front of it.

#ifndef TRIPOD_H
#define TRIPOD_H

#include "easel.h"
#include "scene.h"

// Read a scene; sky stands for its environment unless it is NULL.
static inline void open_scene(scene *s, const char *path, const char *sky,
                              arena *mem, pool *threads) {
  error err;
  scene_options options = {.env = sky};
  if (!scene_load(s, path, &options, mem, threads, NULL, &err))
    give_up(&err, 4);
}

static inline camera_view view_by(const camera *c, int w, int h) {
  camera_view v;
  error err;
  if (!camera_view_of(&v, c, w, h, &err)) give_up(&err, 4);
  return v;
}

static inline camera_view view_of(vec3 eye, vec3 target, float fov, int w,
                                  int h) {
  camera c = {.eye = eye, .target = target, .up = {0, 1, 0}, .fov_deg = fov};
  return view_by(&c, w, h);
}

#endif
