// part.c — the file as it is written, and what reading and writing share.

#include "part.h"

#include "bytes.h"
#include "digest.h"
#include "file.h"

int part_width(const part *p) {
  return p->window.x1 - p->window.x0;
}

int part_height(const part *p) {
  return p->window.y1 - p->window.y0;
}

bool part_has_squares(int which) {
  return which == PART_COLOR || which == PART_EVEN || which == PART_ODD;
}

size_t part_pixel_bytes(unsigned films) {
  size_t sum = 0;
  for (int i = 0; i < PART_FILMS; i++)
    if (films >> i & 1) sum += part_has_squares(i) ? 52 : 28;
  return sum + (films >> PART_MARKS & 1) * 24;
}

shard part_shard(const part *p) {
  return (shard){part_width(p), part_height(p), p->shard, p->shards};
}

int part_shard_name(const part *p) {
  return p->shard == 0 ? p->shards : p->shard;
}

void part_deal(part *p, arena *mem) {
  shard s = part_shard(p);
  p->tile_count = shard_tiles(&s);
  p->tiles = ARENA_NEW(mem, part_tile, p->tile_count);
  for (size_t i = 0; i < p->tile_count; i++)
    p->tiles[i].number = (uint32_t)shard_tile(&s, i);
}

void part_films_new(part *p, arena *mem) {
  int w = part_width(p), h = part_height(p);
  size_t n = (size_t)w * (size_t)h;
  for (int i = 0; i < PART_FILMS; i++)
    if (p->films >> i & 1)
      p->film[i] = film_new(mem, w, h, part_has_squares(i));
  if ((p->films >> PART_MARKS & 1) == 0) return;
  p->marks = (doubling_marks){ARENA_NEW(mem, vec3, n), ARENA_NEW(mem, vec3, n)};
}

// The fixed part of the head.
static void put_head(uint8_t **at, const part *p) {
  const film_box *w = &p->window;
  const tally *t = &p->tally;
  memcpy(*at, PART_MAGIC, 8);
  *at += 8;
  bytes_put_u32(at, PART_FORMAT);
  const uint32_t words[PART_HEAD_WORDS] = {(uint32_t)p->width,
                                           (uint32_t)p->height,
                                           (uint32_t)w->x0,
                                           (uint32_t)w->y0,
                                           (uint32_t)w->x1,
                                           (uint32_t)w->y1,
                                           (uint32_t)p->shard,
                                           (uint32_t)p->shards,
                                           p->spp,
                                           p->complete,
                                           p->films,
                                           p->aovs,
                                           p->radiance,
                                           (uint32_t)strlen(p->key)};
  for (int i = 0; i < PART_HEAD_WORDS; i++)
    bytes_put_u32(at, words[i]);
  bytes_put_f32(at, p->exposure);
  const uint64_t counts[PART_HEAD_COUNTS] = {
      t->paths.rays, t->paths.cut, t->samples,   t->non_finite,
      t->bad_sample, t->bad_pixel, p->tile_count};
  for (int i = 0; i < PART_HEAD_COUNTS; i++)
    bytes_put_u64(at, counts[i]);
}

static void put_vec3(uint8_t **at, vec3 v) {
  bytes_put_f32(at, v.x);
  bytes_put_f32(at, v.y);
  bytes_put_f32(at, v.z);
}

// The pixels of a tile.
static void put_film(uint8_t **at, const film *f, const film_box *b) {
  for (int y = b->y0; y < b->y1; y++)
    for (int x = b->x0; x < b->x1; x++) {
      size_t i = (size_t)y * (size_t)f->width + (size_t)x;
      for (int c = 0; c < 3; c++)
        bytes_put_f64(at, f->sum[i][c]);
      for (int c = 0; c < 3 && f->square != NULL; c++)
        bytes_put_f64(at, f->square[i][c]);
      bytes_put_u32(at, f->count[i]);
    }
}

// All that there is of a tile; how many bytes.
static size_t put_tile(uint8_t *to, const part *p, size_t number) {
  shard s = part_shard(p);
  film_box b = shard_box(&s, number);
  uint8_t *at = to;
  for (int i = 0; i < PART_FILMS; i++)
    if (p->films >> i & 1) put_film(&at, &p->film[i], &b);
  if ((p->films >> PART_MARKS & 1) == 0) return (size_t)(at - to);
  for (int y = b.y0; y < b.y1; y++)
    for (int x = b.x0; x < b.x1; x++) {
      size_t i = (size_t)y * (size_t)s.width + (size_t)x;
      put_vec3(&at, p->marks.whole[i]);
      put_vec3(&at, p->marks.half[i]);
    }
  return (size_t)(at - to);
}

static void put_row(uint8_t **at, const part_tile *t) {
  const adaptive_tile *s = &t->state;
  const uint32_t words[5] = {t->number, s->taken[0], s->taken[1], s->round[0],
                             s->round[1]};
  for (int i = 0; i < 5; i++)
    bytes_put_u32(at, words[i]);
  bytes_put_u64(at, s->rays);
  bytes_put_f64(at, s->need[0]);
  bytes_put_f64(at, s->need[1]);
  bytes_put_u64(at, t->digest);
}

// Write n bytes and their digest.
static void write_sealed(FILE *f, const uint8_t *bytes, size_t n) {
  uint8_t seal[8], *at = seal;
  bytes_put_u64(&at, digest_add(DIGEST_START, bytes, n));
  fwrite(bytes, 1, n, f);
  fwrite(seal, 1, sizeof seal, f);
}

// Head, key and table.  The digests of the tiles are to be known.
static void write_head(FILE *f, const part *p, arena *scratch) {
  size_t key = strlen(p->key), table = p->tile_count * PART_ROW_BYTES;
  uint8_t *bytes = arena_alloc(scratch, PART_HEAD_BYTES + key + table, 1);
  uint8_t *at = bytes;
  put_head(&at, p);
  memcpy(at, p->key, key);
  write_sealed(f, bytes, PART_HEAD_BYTES + key);
  at = bytes;
  for (size_t i = 0; i < p->tile_count; i++)
    put_row(&at, &p->tiles[i]);
  write_sealed(f, bytes, table);
}

// Each tile is encoded twice, for its digest and to be written: the table
// stands before the sums, so that it can be read without them.
bool part_write(part *p, const char *path, error *err) {
  arena scratch = {0};
  file_writer w;
  if (!file_create(&w, path, &scratch, err)) {
    arena_free(&scratch);
    return false;
  }
  size_t most = part_pixel_bytes(p->films) * SHARD_TILE * SHARD_TILE;
  uint8_t *bytes = arena_alloc(&scratch, most, 1);
  for (size_t i = 0; i < p->tile_count; i++) {
    size_t n = put_tile(bytes, p, p->tiles[i].number);
    p->tiles[i].digest = digest_add(DIGEST_START, bytes, n);
  }
  write_head(w.stream, p, &scratch);
  for (size_t i = 0; i < p->tile_count; i++)
    fwrite(bytes, 1, put_tile(bytes, p, p->tiles[i].number), w.stream);
  bool ok = file_commit(&w, err);
  arena_free(&scratch);
  return ok;
}

// The length of the line at s.
static int line_length(const char *s) {
  return (int)strcspn(s, "\n");
}

bool part_keys_differ(const char *a, const char *b, char *text, size_t size) {
  while (*a != 0 && *b != 0) {
    int m = line_length(a), n = line_length(b);
    int name = (int)strcspn(a, " \n");
    if (m != n || memcmp(a, b, (size_t)m) != 0) {
      bool same = name < m && name < n && memcmp(a, b, (size_t)name + 1) == 0;
      if (same)
        snprintf(text, size, "%.*s is %.*s, not %.*s", name, a, m - name - 1,
                 a + name + 1, n - name - 1, b + name + 1);
      else
        snprintf(text, size, "%.*s is there, not %.*s", m, a, n, b);
      return true;
    }
    a += m + (a[m] != 0);
    b += n + (b[n] != 0);
  }
  if (*a == 0 && *b == 0) return false;
  snprintf(text, size, "one of them says more");
  return true;
}
