// obj_pack.h — chunks of an OBJ file in exactly the bytes that they need.

#ifndef OBJ_PACK_H
#define OBJ_PACK_H

#include "arena.h"
#include "obj_chunk.h"

// Where packed chunks are kept: blocks, filled one after the other.
typedef struct obj_store {
  arena mem;
  size_t block_bytes;  // of a new block
  char *at;
  size_t left;
} obj_store;

// Move what c holds into the store; *c is empty again, but keeps its room for
// the next piece.
obj_chunk obj_pack(obj_chunk *c, obj_store *store);

#endif
