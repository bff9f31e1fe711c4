// bvh_split_part.h — one node of a tree that may cut triangles: decide, part.

#ifndef BVH_SPLIT_PART_H
#define BVH_SPLIT_PART_H

#include "bvh_part.h"
#include "bvh_split_bins.h"

// In sah_ref.as.unused of a ref: whether its triangle is large and may be cut.
enum { SPLIT_WHOLE = 0, SPLIT_LARGE = 1 };

// A node to be.  Its refs are part.begin..part.end-1 of one of the two arrays;
// room_begin..room_end-1 of both belong to it and to all below it, and what is
// more than it needs may be filled with parts of triangles.
typedef struct bvh_split_node {
  bvh_part part;
  uint32_t room_begin, room_end;
  uint32_t large;  // how many of its refs may be cut
  int array;       // which of the two
} bvh_split_node;

// Some refs of a node: what they put into the bins, and what of them goes to
// either side and where to.
typedef struct bvh_split_chunk {
  uint32_t begin, end;
  uint32_t count[2], to[2], large[2];
  sah_box box[2], centres[2];
  sah_bins bins;
  bvh_split_bins parts;
} bvh_split_chunk;

// What parting nodes needs: the mesh, the arrays, the threads and one chunk
// for each chunk_size refs.
typedef struct bvh_split_shop {
  const bvh *b;
  sah_ref *refs[2];
  double root_area;
  pool *threads;
  bvh_split_chunk *chunks;
  uint32_t chunk_size;
} bvh_split_shop;

// Part node n into two; false when it had better be a leaf.  The refs of the
// children are in the other array; their numbers and depth are the caller's.
bool bvh_split_node_part(const bvh_split_shop *shop, const bvh_split_node *n,
                         bvh_split_node child[2]);

#endif
