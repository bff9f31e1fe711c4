// light_part.h — emitters in parts, so that one may be asked for the part of
// it that can be seen.

#ifndef LIGHT_PART_H
#define LIGHT_PART_H

#include "light_tree.h"

// A triangle of a triangle, or a point light.  at, ab, ac: its corner and edges
// as weights of the corners 1 and 2 of the whole.
typedef struct light_part {
  light_triangle shape;
  vec2 at, ab, ac;
  uint32_t emitter;
} light_part;

// The parts of all emitters of a tree; of each triangle cuts * cuts.
typedef struct light_parts {
  const light_tree *tree;
  light_part *of;
  uint32_t *first;  // by emitter
  uint32_t cuts, count;
} light_parts;

// The most emitters that are cut, and the most parts of all of them.
enum { LIGHT_PARTS_EMITTERS = 64, LIGHT_PARTS_MOST = 64 };

// False when there are no emitters or too many, or parts too small for floats.
bool light_parts_of(light_parts *out, const light_tree *t, arena *mem);

// The power of a part, if it shines like all of its emitter.
float light_parts_power(const light_parts *p, uint32_t part);

// The part of an emitter in which its point q lies.
uint32_t light_parts_at(const light_parts *p, uint32_t emitter, vec3 q);

#endif
