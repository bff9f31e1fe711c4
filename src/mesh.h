// mesh.h — triangles that share vertices, and the names the file gave them.

#ifndef MESH_H
#define MESH_H

#include "arena.h"
#include "vec.h"

#include <stdint.h>

// A corner without normal or texture coordinate.
#define MESH_NONE UINT32_MAX

// What a run of consecutive triangles has in common; -1 where the file has
// said nothing.
typedef struct mesh_run {
  uint32_t first, count;  // triangles
  int object, group;      // into names of the mesh
  int material;           // into material_names
  int64_t smooth;         // smoothing group, 0 off, -1 no s statement yet
} mesh_run;

// Indexed triangles in file order.  normal_index and texcoord_index are NULL
// when no corner has any; colors is NULL or has one per position.
typedef struct mesh {
  size_t position_count, normal_count, texcoord_count, triangle_count;
  vec3 *positions;  // world units
  vec3 *colors;     // linear RGB as written
  vec3 *normals;    // as written, any length
  vec2 *texcoords;
  uint32_t *position_index;  // three a triangle
  uint32_t *normal_index;    // three a triangle, MESH_NONE where absent
  uint32_t *texcoord_index;
  mesh_run *runs;
  size_t run_count;
  const char **object_names, **group_names, **material_names;
  size_t object_count, group_count, material_count;  // distinct names
  uint64_t *material_lines;                          // of the first usemtl
  const char **libraries;                            // mtllib lines as written
  uint64_t *library_lines;                           // where
  size_t library_count;
  // Of the text itself:
  size_t face_count;  // valid faces as written
  size_t object_statements, group_statements;
  size_t line_elements, point_elements;
} mesh;

// Bounds over all positions that are finite, referenced or not; lo > hi when
// there are none.
void mesh_bounds(const mesh *m, vec3 *lo, vec3 *hi);

// Area of triangle t, and of all triangles, in double precision.  Triangles
// with a corner that is not finite count 0.
double mesh_triangle_area(const mesh *m, size_t t);
double mesh_area(const mesh *m);

#endif
