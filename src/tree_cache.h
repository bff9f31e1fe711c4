// tree_cache.h — wide trees kept in files, so that a mesh costs its tree once.

#ifndef TREE_CACHE_H
#define TREE_CACHE_H

#include "bvh_split.h"
#include "cache.h"
#include "wide_tree.h"

// Smaller meshes have no file.  Reading one is several times as fast as
// building whatever the size, but what is saved is then less than 10 ms, and
// the room is wanted for others.
enum { TREE_CACHE_LEAST = 50000 };

// Whose tree is asked for, and how it would be built: by bvh_split_build for so
// many rays, or by bvh_build with BVH_COARSE.
typedef struct tree_cache {
  bool cuts;
  double rays;
  cache_key mesh;    // of its positions and indices
  const char *name;  // of the mesh, for whoever looks at the cache
} tree_cache;

// Begin to ask: find the key of a mesh of so many positions, of which b names
// the arrays and the number of triangles.
void tree_cache_begin(tree_cache *c, const bvh *b, size_t position_count,
                      pool *threads);

// Fill *t and the counts of *b, nodes and order of which stay NULL, with what
// the builder would make, to the bit; false when the cache does not have it or
// its file is not whole, with *t empty.
bool tree_cache_load(const tree_cache *c, wide_tree *t, bvh *b, arena *mem,
                     pool *threads);

// Keep a tree that was built, in place of one whose patches nobody has looked
// for; one that is no more than what is there already is not written.  See
// cache_save.
void tree_cache_save(const tree_cache *c, const wide_tree *t, const bvh *b,
                     uint64_t most, pool *threads);

#endif
