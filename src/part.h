// part.h — a picture that is not finished, in a file: sums of samples, to which
// more samples or other tiles can be added.
//
// Little-endian, one after the other:
//   8 bytes "FACETPRT", u32 PART_FORMAT
//   u32 film width and height, window x0 y0 x1 y1, shard, shards, spp,
//     complete, films, aovs (both bits), radiance, bytes of the key
//   f32 exposure
//   u64 rays, rays lost, samples, dropped samples, the first dropped one and
//     its pixel; u64 number of tiles
//   the key
//   u64 digest of all that
//   for each tile u32 number, taken and round of two colors; u64 rays, f64
//     need of both, u64 digest
//   u64 digest of this table
//   for each tile, for each film, for each pixel: 3 f64 sums, 3 f64 sums of
//     squares (radiance only), u32 count; of PART_MARKS 6 f32

#ifndef PART_H
#define PART_H

#include "adaptive.h"
#include "doubling.h"
#include "render_sums.h"

// How a file starts, and another number when the layout changes.
#define PART_MAGIC "FACETPRT"
enum { PART_FORMAT = 2 };

// Limits: bytes of a key, shards, samples of a pixel.
enum { PART_KEY_MAX = 8192, PART_SHARDS_MAX = 1000000, PART_SPP_MAX = 1 << 30 };

// Sizes in the file: the numbers of the head, all of it but the key, and a row
// of the table.
enum {
  PART_HEAD_WORDS = 14,
  PART_HEAD_COUNTS = 7,
  PART_HEAD_BYTES = 12 + 4 * PART_HEAD_WORDS + 4 + 8 * PART_HEAD_COUNTS,
  PART_ROW_BYTES = 52
};

// Its films, and bits of part.films.  A picture in halves has no PART_COLOR.
enum {
  PART_COLOR,
  PART_NORMAL,
  PART_DEPTH,
  PART_ALBEDO,
  PART_EVEN,
  PART_ODD,
  PART_FILMS,
  PART_MARKS = PART_FILMS  // what doubling keeps
};

// A tile of the window.  Where samples are not in two halves, only the first
// number of each pair counts, and need is 0.
typedef struct part_tile {
  uint32_t number;
  adaptive_tile state;
  uint64_t digest;  // of its bytes in the file
} part_tile;

typedef struct part {
  int width, height;  // of the full film
  film_box window;    // within it
  int shard, shards;  // of the window: 0..shards-1
  uint32_t spp;       // asked for
  bool complete;      // nothing was left to do
  bool radiance;      // and not a picture of normals or the like
  float exposure;     // stops, for whoever makes a PNG of radiance
  unsigned films;     // bits
  unsigned aovs;      // as RENDER_AOV_ has them
  const char *key;    // lines "name value": all that the samples depend on
  tally tally;
  size_t tile_count;
  part_tile *tiles;       // ascending
  film film[PART_FILMS];  // over the window; sum NULL where absent
  doubling_marks marks;
} part;

// The tiles of its window that are its shard's, as a table without samples.
void part_deal(part *p, arena *mem);

// Films for the bits of p->films, empty.
void part_films_new(part *p, arena *mem);

// The size of the window, and its tiles that are p's.
int part_width(const part *p);
int part_height(const part *p);
shard part_shard(const part *p);

// The number that people give its shard, 1..shards.
int part_shard_name(const part *p);

// Whether a film has squares, and the bytes of a pixel of it.
bool part_has_squares(int which);
size_t part_pixel_bytes(unsigned films);

// Write p to path, whole or not at all.  Fills in the digests of the tiles.
bool part_write(part *p, const char *path, error *err);

// Read all but the sums, into mem.  What is in the file is checked, and never
// taken for more than the file is long.
bool part_read_head(part *out, const char *path, arena *mem, error *err);

// Read the sums of p's tiles from the file that its head came from, into its
// films.  On failure some may have been filled.
bool part_read_sums(part *p, const char *path, error *err);

// What differs first between the keys of a and b: "seed is 1, not 2", in text;
// false when they are equal.
bool part_keys_differ(const char *a, const char *b, char *text, size_t size);

#endif
