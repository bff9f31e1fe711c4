// scene_digest.h — what was read, as numbers: of the scene in memory, so that a
// comment in a file may change and a digit may not.

#ifndef SCENE_DIGEST_H
#define SCENE_DIGEST_H

#include "camera.h"
#include "scene.h"

// One digest for each kind of thing that a picture depends on, so that it can
// be said which one has changed.
typedef struct scene_digest {
  uint64_t geometry;   // vertices, triangles, and which material they have
  uint64_t materials;  // with the options of their textures
  uint64_t textures;   // texels
  uint64_t lights;
  uint64_t environment;
  uint64_t camera;
} scene_digest;

scene_digest scene_digest_of(const scene *s, const camera_view *view);

#endif
