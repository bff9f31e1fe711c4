// part_read.c — the file as it is read: by somebody who trusts nothing in it.

#include "part.h"

#include "bytes.h"
#include "digest.h"
#include "file.h"

#include <float.h>
#include <math.h>

// A file on the way in.
typedef struct part_file {
  FILE *f;
  const char *path;
  error *err;
} part_file;

static bool bad(const part_file *in, const char *what) {
  return fail(in->err, "%s: %s", in->path, what);
}

// Read n bytes.
static bool take(part_file *in, void *to, size_t n) {
  return fread(to, 1, n, in->f) == n || bad(in, "ends early");
}

// The digest that follows, of what has come before.
static bool check_seal(part_file *in, uint64_t digest, const char *what) {
  uint8_t seal[8];
  const uint8_t *at = seal;
  return take(in, seal, sizeof seal) &&
         (bytes_get_u64(&at) == digest || bad(in, what));
}

// Whether low <= x <= high.
static bool within(uint32_t x, uint32_t low, uint32_t high) {
  return x >= low && x <= high;
}

// The bits of films and of AOVs belong together: samples in one sequence or in
// two halves, and a film for each AOV that has one.
static bool films_fit(unsigned films, unsigned aovs) {
  const unsigned both = 1u << PART_EVEN | 1u << PART_ODD;
  const unsigned one = 1u << PART_COLOR, marks = 1u << PART_MARKS;
  unsigned kind = films & (both | one), first = 0;
  if (aovs & RENDER_AOV_NORMAL) first |= 1u << PART_NORMAL;
  if (aovs & RENDER_AOV_DEPTH) first |= 1u << PART_DEPTH;
  if (aovs & RENDER_AOV_ALBEDO) first |= 1u << PART_ALBEDO;
  return aovs < 1u << RENDER_AOV_COUNT && (kind == both || kind == one) &&
         (films & ~marks) == (kind | first) &&
         (kind == one || (films & marks) == 0);
}

// The words of the head make sense.
static bool plausible(const uint32_t *w) {
  return within(w[0], 1, IMAGE_MAX_SIDE) && within(w[1], 1, IMAGE_MAX_SIDE) &&
         w[2] < w[4] && w[4] <= w[0] && w[3] < w[5] && w[5] <= w[1] &&
         within(w[7], 1, PART_SHARDS_MAX) && w[6] < w[7] &&
         within(w[8], 1, PART_SPP_MAX) && w[9] <= 1 &&
         films_fit(w[10], w[11]) && w[12] <= 1 &&
         within(w[13], 1, PART_KEY_MAX);
}

// Take the head apart.  The length of the key is in *key.
static bool parse_head(part *p, size_t *key, const uint8_t *at) {
  uint32_t w[PART_HEAD_WORDS];
  uint64_t n[PART_HEAD_COUNTS];
  for (int i = 0; i < PART_HEAD_WORDS; i++)
    w[i] = bytes_get_u32(&at);
  float exposure = bytes_get_f32(&at);
  for (int i = 0; i < PART_HEAD_COUNTS; i++)
    n[i] = bytes_get_u64(&at);
  if (!plausible(w) || !isfinite(exposure)) return false;
  *p = (part){.width = (int)w[0],
              .height = (int)w[1],
              .window = {(int)w[2], (int)w[3], (int)w[4], (int)w[5]},
              .shard = (int)w[6],
              .shards = (int)w[7],
              .spp = w[8],
              .complete = w[9] == 1,
              .exposure = exposure,
              .films = w[10],
              .aovs = w[11],
              .radiance = w[12] == 1,
              .tally = {{.rays = n[0], .cut = n[1]}, n[2], n[3], n[4], n[5]}};
  *key = w[13];
  shard s = part_shard(p);
  p->tile_count = shard_tiles(&s);
  return n[6] == p->tile_count && n[3] <= n[2] && n[4] <= INT32_MAX &&
         n[5] < (uint64_t)w[0] * w[1];
}

// Printing characters and line ends only.
static bool is_text(const char *s, size_t n) {
  for (size_t i = 0; i < n; i++)
    if ((s[i] < ' ' || s[i] > '~') && s[i] != '\n') return false;
  return true;
}

static bool read_top(part *p, part_file *in, arena *mem) {
  uint8_t bytes[PART_HEAD_BYTES];
  const uint8_t *at = bytes + 8;
  size_t length;
  if (fread(bytes, 1, 8, in->f) != 8 || memcmp(bytes, PART_MAGIC, 8) != 0)
    return bad(in, "is no part of a picture");
  if (!take(in, bytes + 8, sizeof bytes - 8)) return false;
  if (bytes_get_u32(&at) != PART_FORMAT)
    return bad(in, "was written by another version of facet");
  if (!parse_head(p, &length, at)) return bad(in, "its head makes no sense");
  uint8_t *all = arena_alloc(mem, PART_HEAD_BYTES + length + 1, 1);
  char *key = (char *)all + PART_HEAD_BYTES;
  memcpy(all, bytes, sizeof bytes);
  if (!take(in, key, length)) return false;
  if (!is_text(key, length)) return bad(in, "its head makes no sense");
  p->key = key;
  return check_seal(in, digest_add(DIGEST_START, all, sizeof bytes + length),
                    "its head is damaged");
}

// Whether a row can be that of the i-th tile.
static bool row_fits(const part *p, size_t i) {
  const part_tile *t = &p->tiles[i];
  const adaptive_tile *s = &t->state;
  shard all = part_shard(p);
  bool in_halves = (p->films >> PART_EVEN & 1) != 0;
  if (t->number != shard_tile(&all, i)) return false;
  for (int k = 0; k < 2; k++)
    if (s->taken[k] > PART_SPP_MAX || s->round[k] > PART_SPP_MAX ||
        !(s->need[k] >= 0 && s->need[k] < (double)INFINITY))
      return false;
  if (in_halves)
    return s->taken[0] <= s->round[0] && s->taken[1] <= s->round[1];
  return s->taken[0] == p->tiles[0].state.taken[0] && s->taken[1] == 0;
}

static void parse_row(part_tile *t, const uint8_t *at) {
  t->number = bytes_get_u32(&at);
  t->state.taken[0] = bytes_get_u32(&at);
  t->state.taken[1] = bytes_get_u32(&at);
  t->state.round[0] = bytes_get_u32(&at);
  t->state.round[1] = bytes_get_u32(&at);
  t->state.rays = bytes_get_u64(&at);
  t->state.need[0] = bytes_get_f64(&at);
  t->state.need[1] = bytes_get_f64(&at);
  t->digest = bytes_get_u64(&at);
}

static bool read_table(part *p, part_file *in, arena *mem) {
  shard s = part_shard(p);
  size_t table = p->tile_count * PART_ROW_BYTES;
  uint64_t sums = (uint64_t)shard_pixels(&s) * part_pixel_bytes(p->films);
  uint64_t want = table + 8 + sums, left = file_left(in->f);
  if (left != want)
    return fail(in->err, "%s: has %llu bytes after its head, expected %llu",
                in->path, (unsigned long long)left, (unsigned long long)want);
  uint8_t *bytes = arena_alloc(mem, table, 1);
  if (!take(in, bytes, table) ||
      !check_seal(in, digest_add(DIGEST_START, bytes, table),
                  "its table of tiles is damaged"))
    return false;
  p->tiles = ARENA_NEW(mem, part_tile, p->tile_count);
  for (size_t i = 0; i < p->tile_count; i++) {
    parse_row(&p->tiles[i], bytes + i * PART_ROW_BYTES);
    if (!row_fits(p, i)) return bad(in, "its table of tiles makes no sense");
  }
  return true;
}

bool part_read_head(part *out, const char *path, arena *mem, error *err) {
  part_file in = {file_open(path, err), path, err};
  if (in.f == NULL) return false;
  arena scratch = {0};
  part p;
  bool ok = read_top(&p, &in, &scratch) && read_table(&p, &in, &scratch);
  fclose(in.f);
  if (!ok) {
    arena_free(&scratch);
    return false;
  }
  arena_adopt(mem, &scratch);
  *out = p;
  return true;
}

// A sum of n samples that fit into floats.
static bool sane_sum(double x, uint32_t n) {
  return fabs(x) <= (double)FLT_MAX * n;
}

// The pixels of a tile; no pixel can have more samples than the tile.
static bool get_film(film *f, const film_box *b, uint32_t most,
                     const uint8_t **at) {
  bool ok = true;
  for (int y = b->y0; y < b->y1; y++)
    for (int x = b->x0; x < b->x1; x++) {
      size_t i = (size_t)y * (size_t)f->width + (size_t)x;
      for (int c = 0; c < 3; c++)
        f->sum[i][c] = bytes_get_f64(at);
      for (int c = 0; c < 3 && f->square != NULL; c++) {
        f->square[i][c] = bytes_get_f64(at);
        ok = ok && f->square[i][c] >= 0 && isfinite(f->square[i][c]);
      }
      uint32_t n = f->count[i] = bytes_get_u32(at);
      for (int c = 0; c < 3; c++)
        ok = ok && sane_sum(f->sum[i][c], n);
      ok = ok && n <= most;
    }
  return ok;
}

static vec3 get_vec3(const uint8_t **at) {
  vec3 v;
  v.x = bytes_get_f32(at);
  v.y = bytes_get_f32(at);
  v.z = bytes_get_f32(at);
  return v;
}

static bool get_marks(part *p, const film_box *b, const uint8_t **at) {
  bool ok = true;
  for (int y = b->y0; y < b->y1; y++)
    for (int x = b->x0; x < b->x1; x++) {
      size_t i = (size_t)y * (size_t)part_width(p) + (size_t)x;
      p->marks.whole[i] = get_vec3(at);
      p->marks.half[i] = get_vec3(at);
      ok =
          ok && vec3_finite(p->marks.whole[i]) && vec3_finite(p->marks.half[i]);
    }
  return ok;
}

// The films of a tile from its bytes.
static bool get_tile(part *p, const part_tile *t, const uint8_t *at) {
  shard s = part_shard(p);
  film_box b = shard_box(&s, t->number);
  const uint32_t *taken = t->state.taken;
  uint32_t most = taken[0] > taken[1] ? taken[0] : taken[1];
  bool ok = true;
  for (int i = 0; i < PART_FILMS; i++) {
    if ((p->films >> i & 1) == 0) continue;
    ok = get_film(&p->film[i], &b, most, &at) && ok;
  }
  if (p->films >> PART_MARKS & 1) ok = get_marks(p, &b, &at) && ok;
  return ok;
}

static bool read_tile(part *p, part_file *in, const part_tile *t,
                      uint8_t *bytes) {
  shard s = part_shard(p);
  film_box b = shard_box(&s, t->number);
  size_t pixels = (size_t)(b.x1 - b.x0) * (size_t)(b.y1 - b.y0);
  size_t n = pixels * part_pixel_bytes(p->films);
  if (!take(in, bytes, n)) return false;
  if (digest_add(DIGEST_START, bytes, n) != t->digest)
    return fail(in->err, "%s: tile %u is damaged", in->path, t->number);
  return get_tile(p, t, bytes) ||
         fail(in->err, "%s: the sums of tile %u make no sense", in->path,
              t->number);
}

bool part_read_sums(part *p, const char *path, error *err) {
  part_file in = {file_open(path, err), path, err};
  if (in.f == NULL) return false;
  arena scratch = {0};
  size_t most = part_pixel_bytes(p->films) * SHARD_TILE * SHARD_TILE;
  uint8_t *bytes = arena_alloc(&scratch, most, 1);
  size_t start =
      PART_HEAD_BYTES + strlen(p->key) + 8 + p->tile_count * PART_ROW_BYTES + 8;
  bool ok = fseeko(in.f, (off_t)start, SEEK_SET) == 0;
  if (!ok) bad(&in, "cannot be read");
  for (size_t i = 0; i < p->tile_count && ok; i++)
    ok = read_tile(p, &in, &p->tiles[i], bytes);
  fclose(in.f);
  arena_free(&scratch);
  return ok;
}
