// shard.h — the tiles of a window, dealt out to several runs.

#ifndef SHARD_H
#define SHARD_H

#include "film.h"

// Pixels a side of a tile, the item of work of a thread.  Tiles are numbered
// row by row from the upper left corner of the window.
enum { SHARD_TILE = 16 };

// One hand of tiles: tile t goes to run t mod count, shifted by one from row to
// row where the hands would lie in columns.
typedef struct shard {
  int width, height;  // of the window in pixels
  int index, count;   // 0..count-1, and count at least 1
} shard;

// How many tiles it has, how many pixels, and the number of its k-th tile.
size_t shard_tiles(const shard *s);
size_t shard_pixels(const shard *s);
size_t shard_tile(const shard *s, size_t k);

// The pixels of a tile of the window.
film_box shard_box(const shard *s, size_t tile);

#endif
