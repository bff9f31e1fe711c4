// cache.h — what took long to make, kept in a file under the key of all that
// it was made of.

#ifndef CACHE_H
#define CACHE_H

#include "cache_folder.h"
#include "pool.h"

#include <stdio.h>

// 128 bits that stand for any number of bytes.
typedef struct cache_key {
  uint64_t a, b;
} cache_key;

// A key before anything is added to it.
#define CACHE_KEY_START ((cache_key){1, 2})

// Add n bytes to a key; where they end counts.
void cache_key_add(cache_key *k, const void *data, size_t n);

// The key of n bytes, found by all threads: that of the keys of their MiB.
cache_key cache_sum(const void *data, size_t n, pool *threads);

bool cache_key_same(cache_key x, cache_key y);

// The file of a kind ("ibl", "tree") and key, in mem, or NULL where the user
// has no place for caches.
char *cache_path(const char *kind, cache_key key, arena *mem);

// A file that is being read.
typedef struct cache_file {
  int fd;
  uint64_t at, left;    // the next byte, and how many follow
  cache_key sum, want;  // of what was taken, and of all
} cache_file;

// Open the file of a kind and key; false where there is none that is whole.
bool cache_open(cache_file *f, const char *kind, cache_key key);

// Read the next n bytes, as one of the parts that were saved; false when there
// are not so many.
bool cache_take(cache_file *f, void *to, size_t n, pool *threads);

// Close it.  True when everything was taken and is what was saved: until then
// nothing of it is to be believed.  It then counts as used just now.
bool cache_close(cache_file *f);

// Remove the file of a kind and key, which turned out not to be whole.
void cache_remove(const char *kind, cache_key key);

// What is to be saved: for whom, as a line of text, and its parts.
typedef struct cache_part {
  const void *at;
  size_t bytes;
} cache_part;

typedef struct cache_item {
  const char *kind;
  cache_key key;
  const char *what;
  const cache_part *parts;
  int count;
} cache_item;

// Save it, unless it takes more than `most` bytes, and remove what was not used
// for longest until the whole cache takes at most that.  Whoever reads
// meanwhile finds the whole file or none; failing is no error.
void cache_save(const cache_item *item, uint64_t most, pool *threads);

// The bytes of a cache_item's line of text, with its NUL.
enum { CACHE_WHAT = 64 };

// What a file of the folder is for; empty where it does not say.
void cache_what(char what[CACHE_WHAT], const cache_entry *e);

#endif
