// obj_chunk.h — one piece of an OBJ file, parsed by one thread by itself.

#ifndef OBJ_CHUNK_H
#define OBJ_CHUNK_H

#include "error.h"
#include "obj_corner.h"
#include "vec.h"

#include <stddef.h>
#include <stdint.h>

// What statements between faces say.
typedef enum obj_event_kind {
  OBJ_EVENT_OBJECT,
  OBJ_EVENT_GROUP,
  OBJ_EVENT_MATERIAL,
  OBJ_EVENT_SMOOTH,
  OBJ_EVENT_LIBRARY
} obj_event_kind;

// One of them, in force from the triangle with this number in the chunk.
typedef struct obj_event {
  obj_event_kind kind;
  uint32_t triangle;
  size_t name, length;  // in the chunk's names
  int64_t value;        // smoothing group; line of usemtl, mtllib
} obj_event;

// Whoever wants to see a box of this size whole must stand where floats end.
#define OBJ_FAR 1e37f

// What is counted, with the line where it was first seen.
typedef enum obj_tally_kind {
  OBJ_TALLY_SHORT_FACE,
  OBJ_TALLY_NOT_FINITE,
  OBJ_TALLY_FAR,
  OBJ_TALLY_BAD_SMOOTH,
  OBJ_TALLY_EXTRA,
  OBJ_TALLY_POINT,
  OBJ_TALLY_LINE,
  OBJ_TALLY_FREE_FORM,
  OBJ_TALLY_DISPLAY,
  OBJ_TALLY_UNKNOWN,
  OBJ_TALLY_COUNT
} obj_tally_kind;

typedef struct obj_tally {
  uint64_t count, line;
} obj_tally;

// A keyword that facet does not know, by its first line.
typedef struct obj_unknown {
  char keyword[24];  // cut short, with a NUL
  uint64_t line;
} obj_unknown;

// Keywords that are remembered; statements are counted beyond.
enum { OBJ_UNKNOWN_MAX = 64 };

// Everything a piece says.  Lines count from 1 at its start.  It grows while
// it is parsed; obj_pack leaves what was found in exactly the bytes that
// it needs, with the corners in one array per kind of index.
typedef struct obj_chunk {
  vec3 *positions, *colors, *normals;  // colors: one per position, if any
  vec2 *texcoords;
  obj_corner *corners;         // NULL when packed
  uint32_t *position_indices;  // NULL before; one per corner
  uint32_t *texcoord_indices;  // or NULL when no corner has one
  uint32_t *normal_indices;
  uint32_t *faces;  // corners of each; NULL when packed and all have three
  obj_event *events;
  char *names;
  obj_unknown *unknown;
  size_t position_count, normal_count, texcoord_count, corner_count;
  size_t face_count, event_count, name_bytes, unknown_count;
  size_t position_room, color_room, normal_room, texcoord_room, corner_room;
  size_t face_room, event_room, name_room, unknown_room;
  size_t triangle_count;
  uint64_t line_count;
  obj_tally tally[OBJ_TALLY_COUNT];
  bool has_color;                 // some position has one
  bool has_texcoord, has_normal;  // some corner has one
  // The first malformed statement; parsing stops there.
  error problem;
  uint64_t problem_line;  // 0: none
  // For messages about a face of which only the number is known: its line,
  // and how many positions the chunk had there.
  size_t watched_face;  // SIZE_MAX: none
  uint64_t watched_line;
  size_t watched_positions;
} obj_chunk;

// Append one vertex or one corner.
void obj_add_position(obj_chunk *c, vec3 p);
void obj_add_normal(obj_chunk *c, vec3 n);
void obj_add_texcoord(obj_chunk *c, vec2 t);
void obj_grow_corners(obj_chunk *c);

static inline void obj_add_corner(obj_chunk *c, obj_corner corner) {
  if (c->corner_count == c->corner_room) obj_grow_corners(c);
  c->corners[c->corner_count++] = corner;
}

// The corners from `first` on are a face, at least three.
void obj_add_face(obj_chunk *c, size_t first, uint64_t line);

// Empty a chunk; the next parse watches for no face.
void obj_chunk_reset(obj_chunk *c);

// Release the room of a chunk that was not packed.
void obj_chunk_free(obj_chunk *c);

#endif
