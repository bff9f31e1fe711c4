// ibl_cache.c

#include "ibl_cache.h"

// Another number when the sums or the format change: old files are then
// ignored.
enum { CACHE_VERSION = 2 };

static const char KIND[] = "ibl";

// Bytes of a level's texels.
static size_t level_bytes(const ibl_level *l) {
  return ibl_level_texels(l) * sizeof *l->texels;
}

cache_key ibl_cache_key_of(const ibl_cache_set *s) {
  const image *map = s->map;
  cache_key k = CACHE_KEY_START;
  int head[4] = {CACHE_VERSION, (int)s->model, map->width, map->height};
  cache_key_add(&k, head, sizeof head);
  for (int i = 0; i < s->count; i++) {
    float facts[2] = {s->levels[i].roughness, (float)s->levels[i].width};
    cache_key_add(&k, facts, sizeof facts);
  }
  size_t texels = (size_t)map->width * (size_t)map->height;
  cache_key_add(&k, map->pixels, texels * sizeof *map->pixels);
  return k;
}

char *ibl_cache_path(cache_key key, arena *mem) {
  return cache_path(KIND, key, mem);
}

bool ibl_cache_load(const ibl_cache_set *s, cache_key key) {
  cache_file f;
  if (!cache_open(&f, KIND, key)) return false;
  bool ok = true;
  for (int i = 0; i < s->count && ok; i++)
    ok = cache_take(&f, s->levels[i].texels, level_bytes(&s->levels[i]), NULL);
  return cache_close(&f) && ok;
}

void ibl_cache_save(const ibl_cache_set *s, cache_key key, uint64_t most) {
  arena mem = {0};
  cache_part *parts = ARENA_NEW(&mem, cache_part, (size_t)s->count);
  for (int i = 0; i < s->count; i++)
    parts[i] = (cache_part){s->levels[i].texels, level_bytes(&s->levels[i])};
  cache_item item = {.kind = KIND,
                     .key = key,
                     .what =
                         arena_format(&mem, "environment of %dx%d, %d sums",
                                      s->map->width, s->map->height, s->count),
                     .parts = parts,
                     .count = s->count};
  cache_save(&item, most, NULL);
  arena_free(&mem);
}
