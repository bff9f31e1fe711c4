// name_table.h — distinct names, numbered in the order they came.

#ifndef NAME_TABLE_H
#define NAME_TABLE_H

#include "text.h"

// Start with {0}.  Everything lives in the arena that name_table_add gets.
typedef struct name_table {
  const char **names;
  size_t count;
  uint32_t *slots;    // name number + 1 by hash, 0 where free
  size_t slot_count;  // a power of two
  uint64_t key;       // of the hash
} name_table;

// The number of name, which is copied to mem when it is new.
int name_table_add(name_table *t, span name, arena *mem);

// The number of name, -1 when it is not there.
int name_table_find(const name_table *t, span name);

#endif
