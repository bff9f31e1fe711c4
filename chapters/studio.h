// studio.h — what the programs of the chapters from 12 on share: a scene with
// all that tracing paths in it takes.

#ifndef STUDIO_H
#define STUDIO_H

#include "path.h"
#include "tripod.h"
#include "wide.h"

typedef struct studio {
  scene scene;
  bvh binary;
  wide_tree tree;
  path_world world;
  light_set lights;
  path_tracer tracer;
  integrator by;
} studio;

// It points into itself: s must stay where it is.
static inline void studio_open(studio *s, const char *path, arena *mem,
                               pool *threads) {
  open_scene(&s->scene, path, NULL, mem, threads);
  const mesh *m = &s->scene.mesh;
  bvh_build(&s->binary, m->positions, m->position_index,
            (uint32_t)m->triangle_count, BVH_SAH, mem, threads);
  wide_tree_build(&s->tree, &s->binary, mem, threads);
  s->world = (path_world){
      .scene = &s->scene, .tracer = wide_tracer(&s->tree), .lights = true};
  s->world.dfg = matter_table(&s->scene, PBR_GGX, mem, threads);
  light_set_build(&s->lights, &s->scene, true, true, mem, threads);
  s->tracer = (path_tracer){
      .world = &s->world, .lights = &s->lights, .sampler = SAMPLER_SOBOL};
  s->by = path_integrator(&s->tracer);
}

#endif
