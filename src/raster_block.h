// raster_block.h — triangles a handful at a time, each with its box, and what
// of them cannot be in a view.

#ifndef RASTER_BLOCK_H
#define RASTER_BLOCK_H

#include "scene.h"

// Triangles of one material that follow each other in the file, and their
// finite corners' box; lo > hi when there are none.
typedef struct raster_block {
  uint32_t first, count;  // triangles of the mesh
  uint32_t material;      // of the scene, 0 where it has none
  vec3 lo, hi;
} raster_block;

// The most triangles of a block: few enough for tight boxes, enough for a call
// of OpenGL to be worth while.
enum { RASTER_BLOCK_MOST = 1024 };

typedef struct raster_blocks {
  raster_block *items;  // by material, and then in the order of the file
  size_t count;
} raster_blocks;

// Blocks end where the material or the object changes.
raster_blocks raster_blocks_of(const scene *s, arena *mem);

// A half space: inside where n . p + d >= 0.
typedef struct raster_plane {
  double n[3], d;
} raster_plane;

// What is inside of all of these: the four sides of a picture, and what lies
// ahead.
typedef struct raster_frustum {
  raster_plane side[5];
} raster_frustum;

// Of a camera, for the window of its film from (x0, y0) to (x1, y1).
raster_frustum raster_frustum_of(const camera_view *v, const int window[4]);

// Of a column-major matrix to clip space, for positions less the origin.
raster_frustum raster_frustum_of_matrix(const float m[16], vec3 origin);

// Whether no triangle of the block can be seen: its box is outside of one
// plane by more than the rounding of floats.
bool raster_block_outside(const raster_block *b, const raster_frustum *f);

// Whether two corners of a triangle are one point, so that no ray and no
// sample ever meets it.
bool raster_is_edge(const mesh *m, size_t triangle);

#endif
