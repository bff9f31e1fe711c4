// cache_folder.h — where results are kept from run to run, and how much of
// them.

#ifndef CACHE_FOLDER_H
#define CACHE_FOLDER_H

#include "arena.h"

#include <stdint.h>
#include <time.h>

// The folder in mem, made when it is not there: XDG_CACHE_HOME/facet, else
// ~/.cache/facet; NULL when nobody says where.
char *cache_folder(arena *mem);

// What all files of the cache may take together, in bytes: 256 MiB, or as many
// MiB as FACET_CACHE_MIB says; 0: nothing is kept.
uint64_t cache_limit(void);

// A file of the cache, KIND-KEY.bin, or one that a process has begun to write
// beside it; when it was last read or written.
typedef struct cache_entry {
  char name[128];
  uint64_t bytes;
  struct timespec used;
} cache_entry;

// All of them in mem, those not used for longest first; how many.
size_t cache_entries(cache_entry **out, arena *mem);

// Remove those not used for longest until all take at most `most` bytes; how
// many went.  Another process may remove the same ones: then fewer are left
// than had to be, which does no harm.
size_t cache_prune(uint64_t most);

#endif
