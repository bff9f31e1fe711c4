// path_plain.h — materials of which a path needs to know next to nothing.

#ifndef PATH_PLAIN_H
#define PATH_PLAIN_H

#include "matter.h"

// What a material is if it is that and nothing else, the same everywhere:
// opaque (but for glass), dark, without maps.  Its albedo, and the index of
// refraction inside over outside.
typedef enum plain_kind {
  PLAIN_NOT,
  PLAIN_MATT,
  PLAIN_MIRROR,
  PLAIN_GLASS
} plain_kind;
typedef struct path_plain {
  vec3 albedo;
  float eta;
  plain_kind kind;
} path_plain;

// By material of a scene, in mem; NULL where colours are the corners'.
const path_plain *path_plains(const scene *s, arena *mem);

#endif
