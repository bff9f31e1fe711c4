// bvh_read.h — the triangles of a mesh as the builders of trees want them.

#ifndef BVH_READ_H
#define BVH_READ_H

#include "bvh_part.h"

// The refs of all triangles that can be hit, in mesh order, in mem, and the
// root over them; counts what is kept and dropped in *b.  There is room for
// `percent` more of them.
bvh_part bvh_read(sah_ref **refs, bvh *b, uint32_t percent, arena *mem,
                  pool *threads);

#endif
