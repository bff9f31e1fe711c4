// shard.c

#include "shard.h"

static size_t tiles_across(const shard *s) {
  return ((size_t)s->width + SHARD_TILE - 1) / SHARD_TILE;
}

static size_t tiles_down(const shard *s) {
  return ((size_t)s->height + SHARD_TILE - 1) / SHARD_TILE;
}

// Whether a row deals the same number of tiles to every run, so that the next
// would begin with the same run again.
static bool rows_are_even(const shard *s) {
  return tiles_across(s) % (size_t)s->count == 0;
}

size_t shard_tiles(const shard *s) {
  size_t all = tiles_across(s) * tiles_down(s), n = (size_t)s->count;
  return (all + n - 1 - (size_t)s->index) / n;
}

size_t shard_tile(const shard *s, size_t k) {
  size_t n = (size_t)s->count, i = (size_t)s->index;
  if (!rows_are_even(s)) return i + k * n;
  size_t in_row = tiles_across(s) / n, row = k / in_row;
  size_t first = (i + n - row % n) % n;
  return row * tiles_across(s) + first + k % in_row * n;
}

film_box shard_box(const shard *s, size_t tile) {
  int x = (int)(tile % tiles_across(s)) * SHARD_TILE;
  int y = (int)(tile / tiles_across(s)) * SHARD_TILE;
  int x1 = x + SHARD_TILE, y1 = y + SHARD_TILE;
  return (film_box){x, y, x1 < s->width ? x1 : s->width,
                    y1 < s->height ? y1 : s->height};
}

size_t shard_pixels(const shard *s) {
  size_t sum = 0;
  for (size_t k = 0; k < shard_tiles(s); k++) {
    film_box b = shard_box(s, shard_tile(s, k));
    sum += (size_t)(b.x1 - b.x0) * (size_t)(b.y1 - b.y0);
  }
  return sum;
}
