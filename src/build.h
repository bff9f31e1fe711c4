// build.h — trees built by the best hands of this machine.

#ifndef BUILD_H
#define BUILD_H

#include "bvh_part.h"

// Hands that use AVX2, or NULL where it is not to be had; the best to be had.
const bvh_hands *build_avx2_hands(void);
const bvh_hands *build_hands(void);

// bvh_build by the best hands, over the mesh that another bvh names
// (positions, index and triangle_count; nothing else of it is read): the same
// tree to the bit.
void build_tree(bvh *out, const bvh *mesh, bvh_method method, arena *mem,
                pool *threads);

#endif
