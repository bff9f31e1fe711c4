// ibl_cache.c

#include "ibl_cache.h"

// Another number when the sums or the format change: old files are then
// ignored.
enum { CACHE_VERSION = 3 };

// In which the built-in sky is looked at.
enum { SKY_DIRECTIONS = 256 };

static const char KIND[] = "ibl";

// Bytes of a level's texels.
static size_t level_bytes(const ibl_level *l) {
  return ibl_level_texels(l) * sizeof *l->texels;
}

// The sky by what it looks like, so that another sky has another key: along a
// spiral from below to above.
static void add_sky(cache_key *k, const env *e) {
  env plain = *e;
  plain.rotate = 0, plain.scale = 1;
  for (int i = 0; i < SKY_DIRECTIONS; i++) {
    float at = ((float)i + 0.5f) / SKY_DIRECTIONS;
    vec3 seen = env_radiance(&plain, env_direction((vec2){16 * at, at}));
    cache_key_add(k, &seen, sizeof seen);
  }
}

cache_key ibl_cache_key_of(const ibl_cache_set *s) {
  const image *map = &s->e->map;
  cache_key k = CACHE_KEY_START;
  int head[4] = {CACHE_VERSION, (int)s->model, map->width, map->height};
  cache_key_add(&k, head, sizeof head);
  for (int i = 0; i < s->count; i++) {
    float facts[2] = {s->levels[i].roughness, (float)s->levels[i].width};
    cache_key_add(&k, facts, sizeof facts);
  }
  if (s->e->kind == ENV_SKY) add_sky(&k, s->e);
  if (s->e->kind == ENV_SKY) return k;
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
  const image *map = &s->e->map;
  bool sky = s->e->kind == ENV_SKY;
  cache_item item = {
      .kind = KIND,
      .key = key,
      .what = sky ? arena_format(&mem, "sky, %d sums", s->count)
                  : arena_format(&mem, "environment of %dx%d, %d sums",
                                 map->width, map->height, s->count),
      .parts = parts,
      .count = s->count};
  cache_save(&item, most, NULL);
  arena_free(&mem);
}
