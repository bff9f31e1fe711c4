// raster_mesh.h — the triangles of a scene as a list of vertices in the memory
// of the context, sorted by material.

#ifndef RASTER_MESH_H
#define RASTER_MESH_H

#include "gl.h"
#include "gl_api.h"
#include "raster_block.h"

// Vertices that are drawn in one call, three a triangle.
typedef struct raster_part {
  GLint first;
  GLsizei count;
} raster_part;

// A triangle that lets light straight through, to be drawn from far to near.
typedef struct raster_sheet {
  vec3 middle;     // less the origin
  uint32_t first;  // vertex
  uint32_t material;
  float depth;  // of the view that the sheets are sorted for
} raster_sheet;

typedef struct raster_mesh {
  vec3 origin;  // taken off all positions: floats are finest near 0
  GLuint vertices, buffer, indices;
  size_t bytes;        // of the vertices
  raster_part *parts;  // by material of the scene, at least one
  size_t part_count;
  raster_blocks blocks;
  raster_part *of_block;  // the vertices of each block
  size_t *block_end;      // by material: blocks of this one and all before
  raster_sheet *sheets;
  size_t sheet_count;
  uint32_t *sheet_index;  // room for their vertices
} raster_mesh;

// The vertex attributes, in order, as glsl_spec.attributes wants them: four
// floats each.  Read as a list of RGBA texels, the buffer has four a vertex.
#define RASTER_ATTRIBUTES "in_position in_normal in_facet in_color"

// no_edges: leave out what raster_is_edge.
void raster_mesh_upload(raster_mesh *out, const gl *g, const scene *s,
                        bool no_edges, arena *mem);
void raster_mesh_free(const gl *g, raster_mesh *m);

// Sort the sheets for a view from `eye`, less the origin, along `forward`, and
// upload their indices: the far ones come first.
void raster_mesh_sort(raster_mesh *m, const gl *g, vec3 eye, vec3 forward);

// The vertices of a material that may be in a view, as few calls as cover its
// blocks: *count of them in mem.  view NULL: all.
const raster_part *raster_mesh_in(const raster_mesh *m, size_t of,
                                  const raster_frustum *view, arena *mem,
                                  size_t *count);

#endif
