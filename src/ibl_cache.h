// ibl_cache.h — prepared sums kept in files, so that an environment costs its
// time once.

#ifndef IBL_CACHE_H
#define IBL_CACHE_H

#include "cache.h"
#include "env.h"
#include "ibl_level.h"
#include "microfacet.h"

// Levels of a map or of the built-in sky; their sizes are known and their
// texels allocated.
typedef struct ibl_cache_set {
  const env *e;
  pbr_model model;
  const ibl_level *levels;
  int count;
} ibl_cache_set;

// A hash of everything that the sums depend on: the map's texels or the sky in
// some directions, the model, the levels, and the version of this code.
// Rotation and scale are applied when the sums are read, and are no part of it.
cache_key ibl_cache_key_of(const ibl_cache_set *s);

// Fill the texels from the cache.  False when there is no file of that key, or
// one that is not whole: texels may then hold anything.
bool ibl_cache_load(const ibl_cache_set *s, cache_key key);

// Write the texels; see cache_save.
void ibl_cache_save(const ibl_cache_set *s, cache_key key, uint64_t most);

// The file of a key in mem, or NULL where the user has no place for caches.
char *ibl_cache_path(cache_key key, arena *mem);

#endif
