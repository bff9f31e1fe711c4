// bvh.h — a binary tree of boxes over triangles, and the list beside it.

#ifndef BVH_H
#define BVH_H

#include "aabb.h"
#include "arena.h"
#include "pool.h"
#include "ray.h"

// Inner (count 0): children are nodes first and first + 1.  Leaf: triangles
// order[first .. first + count - 1].  32 bytes, two to a cache line.
typedef struct bvh_node {
  vec3 lo;
  uint32_t first;
  vec3 hi;
  uint32_t count;
} bvh_node;

// How nodes are split: where the surface area heuristic expects the least
// work, asking at up to 31, 15 or 7 places an axis; or through the middle of
// the longest side.  Coarse: as the first, but a few triangles stay together,
// for trees that test the triangles of a leaf at once.  Ones: as the first, but
// until one is left, for trees over what is not to be parted.
typedef enum bvh_method {
  BVH_SAH,
  BVH_MEDIAN,
  BVH_SAH_16,
  BVH_SAH_8,
  BVH_COARSE,
  BVH_ONES
} bvh_method;

// No leaf lies deeper, whatever the input; the root has depth 0.  No leaf
// holds more triangles.  BVH_COARSE cuts none of up to BVH_COARSE_LEAF.
enum { BVH_MAX_DEPTH = 64, BVH_MAX_LEAF = 8, BVH_COARSE_LEAF = 4 };

// The triangles of a mesh and a tree over those that can be hit: zero-area
// triangles and those with a corner that is not finite are dropped.
typedef struct bvh {
  const vec3 *positions;
  const uint32_t *index;    // three a triangle, in mesh order
  uint32_t triangle_count;  // of the mesh
  bvh_node *nodes;          // nodes[0] is the root; NULL when nothing is left
  uint32_t node_count;
  uint32_t *order;  // triangle numbers in leaf order
  uint32_t refs;    // how many: kept, or more where leaves share triangles
  uint32_t parts;   // leaves hold so many parts more than there are wholes
  uint32_t kept, dropped;
  // Where leaves share triangles: bundle i, all of a leaf, is those of order
  // from bundles[i] to bundles[i + 1] - 1; otherwise NULL.
  uint32_t *bundles;
  uint32_t bundle_count;
  int depth;
  double cost;      // SAH cost, in triangle tests per random ray
  double cut_rays;  // more rays repay cutting triangles; see bvh_split.h
  double seconds;
} bvh;

// Build over all threads; the same tree for any number of them.  Depth is
// bounded whatever the input.
void bvh_build(bvh *out, const vec3 *positions, const uint32_t *index,
               uint32_t triangle_count, bvh_method method, arena *mem,
               pool *threads);

// Closest and any hit by the tree, and by testing every triangle of it.  All
// four agree to the bit.  See tracer.
bool bvh_closest(const bvh *b, const ray *r, hit *h);
bool bvh_any(const bvh *b, const ray *r);
bool brute_closest(const bvh *b, const ray *r, hit *h);
bool brute_any(const bvh *b, const ray *r);

// What a ray costs.
typedef struct bvh_visits {
  uint32_t nodes, triangles;
} bvh_visits;

// bvh_closest, counting into *v.
bool bvh_closest_counted(const bvh *b, const ray *r, hit *h, bvh_visits *v);

tracer bvh_tracer(const bvh *b);
tracer brute_tracer(const bvh *b);

#endif
