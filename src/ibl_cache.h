// ibl_cache.h — prepared sums kept in files, so that an environment costs its
// time once.

#ifndef IBL_CACHE_H
#define IBL_CACHE_H

#include "ibl_level.h"
#include "image.h"
#include "microfacet.h"

#include <stdint.h>

// Levels of a map; their sizes are known and their texels allocated.
typedef struct ibl_cache_set {
  const image *map;
  pbr_model model;
  const ibl_level *levels;
  int count;
} ibl_cache_set;

// A hash of everything that the sums depend on: the map's texels, the model,
// the levels, and the version of this code.  Rotation and scale are applied
// when the sums are read, and are no part of it.
typedef struct ibl_cache_key {
  uint64_t a, b;
} ibl_cache_key;

ibl_cache_key ibl_cache_key_of(const ibl_cache_set *s);

// Fill the texels from the cache.  False when there is no file of that key, or
// one that is not whole: texels may then hold anything.
bool ibl_cache_load(const ibl_cache_set *s, ibl_cache_key key);

// What all files of the cache may take together, in bytes: twenty environments
// with all levels, or a hundred with a few.
#define IBL_CACHE_BYTES (UINT64_C(256) << 20)

// Write the texels, and remove the files that were not used for longest until
// all take at most `most` bytes.  Whoever reads meanwhile finds the whole file
// or none; failing is no error.
void ibl_cache_save(const ibl_cache_set *s, ibl_cache_key key, uint64_t most);

// The file of a key in mem, or NULL where the user has no place for caches.
char *ibl_cache_path(ibl_cache_key key, arena *mem);

#endif
