// bvh_read.h — the triangles of a mesh as the builders of trees want them.

#ifndef BVH_READ_H
#define BVH_READ_H

#include "bvh_part.h"

// The refs of all triangles that can be hit, in mesh order, in mem, and the
// root over them; counts what is kept and dropped in *b.  There is room for
// `percent` more of them.
bvh_part bvh_read(sah_ref **refs, bvh *b, uint32_t percent, arena *mem,
                  pool *threads);

// Refs that have been read, the root over them, how to cut it, the arena of the
// refs, which is freed as soon as they are not needed, and whose hands build;
// NULL: bvh_plain_hands.
typedef struct bvh_source {
  sah_ref *refs;
  bvh_part root;
  bvh_method method;
  arena *mem;
  const bvh_hands *hands;
} bvh_source;

// bvh_build of what bvh_read has counted in *out.
void bvh_build_source(bvh *out, const bvh_source *from, arena *mem,
                      pool *threads);

#endif
