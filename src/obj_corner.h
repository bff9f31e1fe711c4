// obj_corner.h — corners of faces that do not know yet where they are in the
// file.

#ifndef OBJ_CORNER_H
#define OBJ_CORNER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// A corner of a face: position, texture coordinate, normal, counted from 0.
// A positive index of the file counts from the file's start and is kept less
// one.  A negative one counts back from its line: as a chunk does not know
// what came before it, that one becomes OBJ_RELATIVE + OBJ_BACK + the place
// in the chunk, which may be below 0.  OBJ_NONE where there is none.
typedef struct obj_corner {
  uint32_t position, texcoord, normal;
} obj_corner;

#define OBJ_NONE UINT32_MAX

// The flag of an index that counts from the chunk's start.
#define OBJ_RELATIVE 0x80000000u

// Relative indices reach this far back; it leaves room for the vertices of
// one chunk above.
#define OBJ_BACK (0x7fffffffu - (1u << 24))

// What an index as written, not 0, becomes in a corner when the chunk has
// `count` elements of its kind; false when it is too far from there.
static inline bool obj_index(long long written, size_t count, uint32_t *out) {
  if (written > 0) {
    if (written > (long long)OBJ_RELATIVE - 1) return false;
    *out = (uint32_t)(written - 1);
    return true;
  }
  if (written < -(long long)OBJ_BACK) return false;
  *out = OBJ_RELATIVE +
         (uint32_t)((long long)OBJ_BACK + (long long)count + written);
  return true;
}

#endif
