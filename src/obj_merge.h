// obj_merge.h — chunks of an OBJ file put together into one mesh.

#ifndef OBJ_MERGE_H
#define OBJ_MERGE_H

#include "mesh.h"
#include "obj_chunk.h"

// What came before a chunk: where its things go in the mesh.
typedef struct obj_place {
  size_t position, normal, texcoord, face, triangle;
  uint64_t line;
} obj_place;

// Faces of a chunk with some flaw: how many, the first (in the chunk), and
// what its index resolved to when that was the flaw.
typedef struct obj_flaw {
  size_t count, first;
  int64_t index;
} obj_flaw;

// What the faces of a chunk turned out to be; the kinds of index are position,
// texture coordinate, normal.
typedef struct obj_findings {
  obj_flaw index[3];  // an index out of range
  obj_flaw polygon;   // crosses itself or has no area
  obj_flaw flat;      // a triangle without area
  bool has[3];        // some index was right
} obj_findings;

// Memory of one worker, freed by obj_scratch_free.
typedef struct obj_scratch {
  vec3 *points;
  uint32_t *corners;
  uint32_t *resolved[3];
  size_t point_room, corner_room, resolved_room[3];
  arena mem;
} obj_scratch;

// Where each of n packed chunks goes; places[n] is the total.
void obj_places(const obj_chunk *chunks, size_t n, obj_place *places);

// Copy the vertices of a chunk to their place in m.
void obj_merge_vertices(mesh *m, const obj_chunk *c, const obj_place *at);

// Resolve the indices of a chunk and cut its faces into triangles, after the
// vertices of all chunks are in place.
obj_findings obj_merge_faces(const mesh *m, const obj_chunk *c,
                             const obj_place *at, obj_scratch *s);
void obj_scratch_free(obj_scratch *s);

// Names, libraries and runs of m from the events of n chunks.
void obj_merge_events(mesh *m, const obj_chunk *chunks, const obj_place *places,
                      size_t n, arena *mem);

#endif
