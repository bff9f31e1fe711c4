// test_part.c — parts of pictures: dealt fairly, written and read bit by bit,
// never believed.

#include "bytes.h"
#include "digest.h"
#include "part_set.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmocka.h>

static char folder[64];

static const char *path_of(arena *mem, const char *name) {
  return arena_format(mem, "%s/%s", folder, name);
}

// Every tile of the window goes to one run, and runs have equally many tiles,
// or one more.
static void dealt_fairly(void **state) {
  (void)state;
  const int sides[] = {1, 15, 16, 17, 100, 128, 640, 1281};
  for (int a = 0; a < 8; a++)
    for (int b = 0; b < 8; b++)
      for (int n = 1; n <= 41; n += 1 + n / 9) {
        shard s = {sides[a], sides[b], 0, 1};
        size_t all = shard_tiles(&s), pixels = 0;
        uint8_t *seen = calloc(all, 1);
        s.count = n;
        for (s.index = 0; s.index < n; s.index++) {
          size_t tiles = shard_tiles(&s), last = 0;
          assert_true(tiles == all / (size_t)n || tiles == all / (size_t)n + 1);
          for (size_t k = 0; k < tiles; k++) {
            size_t t = shard_tile(&s, k);
            assert_true(t < all && (k == 0 || t > last));
            assert_int_equal(seen[t]++, 0);
            last = t;
          }
          pixels += shard_pixels(&s);
        }
        assert_int_equal(pixels, sides[a] * sides[b]);
        free(seen);
      }
}

// A number that differs from place to place.
static double noise(uint64_t i) {
  i = (i + 1) * UINT64_C(0x9e3779b97f4a7c15);
  return (double)(i >> 40) / 1000;
}

enum { COLOR = 1 << PART_COLOR, MARKED = COLOR | 1 << PART_MARKS };
enum { HALVES = 1 << PART_EVEN | 1 << PART_ODD };

// A part of a picture of 40x20 with something in every number.
static part make_part(arena *mem, int index, int count, unsigned films) {
  part p = {.width = 60,
            .height = 30,
            .window = {7, 3, 47, 23},
            .shard = index,
            .shards = count,
            .spp = 5,
            .complete = true,
            .radiance = true,
            .exposure = 0.5f,
            .films = films,
            .key = "version 9\nseed 3\ngeometry 17\n",
            .tally = {{.rays = 10, .cut = 1}, 20, 2, 3, 4}};
  if (films >> PART_NORMAL & 1) p.aovs |= RENDER_AOV_NORMAL;
  if (films >> PART_DEPTH & 1) p.aovs |= RENDER_AOV_DEPTH;
  part_deal(&p, mem);
  part_films_new(&p, mem);
  size_t n = (size_t)part_width(&p) * (size_t)part_height(&p);
  for (int f = 0; f < PART_FILMS; f++)
    for (size_t i = 0; i < n && p.film[f].sum != NULL; i++) {
      p.film[f].count[i] = 1 + (uint32_t)i % 2;
      for (int c = 0; c < 3; c++)
        p.film[f].sum[i][c] = noise(3 * i + (size_t)c) - 5000;
      for (int c = 0; c < 3 && p.film[f].square != NULL; c++)
        p.film[f].square[i][c] = noise(5 * i + (size_t)c);
    }
  for (size_t i = 0; i < n && p.marks.whole != NULL; i++) {
    p.marks.whole[i] = vec3_all((float)noise(i));
    p.marks.half[i] = vec3_all((float)noise(n + i));
  }
  for (size_t i = 0; i < p.tile_count; i++)
    p.tiles[i].state = films >> PART_EVEN & 1
                           ? (adaptive_tile){{2, 2 + (uint32_t)i},
                                             {3, 9},
                                             77 + i,
                                             {0.5 * (double)i, 3}}
                           : (adaptive_tile){{2, 0}, {0, 0}, 0, {0, 0}};
  return p;
}

static void same_film(const film *a, const film *b, size_t i) {
  assert_memory_equal(a->sum[i], b->sum[i], sizeof a->sum[i]);
  assert_int_equal(a->count[i], b->count[i]);
  if (a->square != NULL)
    assert_memory_equal(a->square[i], b->square[i], sizeof a->square[i]);
}

// The sums of p's tiles are the same bits in q.
static void same_sums(const part *p, const part *q) {
  shard s = part_shard(p);
  for (size_t k = 0; k < p->tile_count; k++) {
    film_box b = shard_box(&s, p->tiles[k].number);
    for (int y = b.y0; y < b.y1; y++)
      for (int x = b.x0; x < b.x1; x++) {
        size_t i = (size_t)y * (size_t)s.width + (size_t)x;
        for (int f = 0; f < PART_FILMS; f++)
          if (p->film[f].sum != NULL) same_film(&p->film[f], &q->film[f], i);
        if (p->marks.whole == NULL) continue;
        assert_memory_equal(&p->marks.whole[i], &q->marks.whole[i], 12);
        assert_memory_equal(&p->marks.half[i], &q->marks.half[i], 12);
      }
  }
}

// Written and read, everything is the same bits, for every set of films.
static void comes_back(void **state) {
  (void)state;
  const unsigned sets[] = {COLOR, MARKED, HALVES,
                           COLOR | 1 << PART_NORMAL | 1 << PART_DEPTH};
  for (int k = 0; k < 4; k++) {
    arena mem = {0};
    error err;
    const char *path = path_of(&mem, "x.part");
    part p = make_part(&mem, k % 2, 1 + k % 2, sets[k]), q;
    assert_true(part_write(&p, path, &err));
    assert_true(part_read_head(&q, path, &mem, &err));
    assert_string_equal(q.key, p.key);
    assert_true(q.tile_count == p.tile_count && q.films == p.films);
    assert_true(q.spp == 5 && q.complete && q.radiance && q.exposure == 0.5f);
    assert_memory_equal(&q.tally, &p.tally, sizeof p.tally);
    assert_memory_equal(q.tiles, p.tiles, p.tile_count * sizeof *p.tiles);
    part_films_new(&q, &mem);
    assert_true(part_read_sums(&q, path, &err));
    same_sums(&p, &q);
    arena_free(&mem);
  }
}

typedef struct blob {
  uint8_t *bytes;
  size_t size;
} blob;

static blob blob_of(arena *mem, const char *path) {
  FILE *f = fopen(path, "rb");
  assert_non_null(f);
  fseek(f, 0, SEEK_END);
  blob b = {NULL, (size_t)ftell(f)};
  b.bytes = arena_alloc(mem, b.size, 1);
  rewind(f);
  assert_true(fread(b.bytes, 1, b.size, f) == b.size);
  fclose(f);
  return b;
}

static void write_blob(const char *path, blob b) {
  remove(path);
  FILE *f = fopen(path, "wb");
  assert_non_null(f);
  assert_true(fwrite(b.bytes, 1, b.size, f) == b.size);
  fclose(f);
}

// Whether the file is taken for a part, with a reason when it is not.
static bool is_believed(const char *path) {
  arena mem = {0};
  error err = {{0}};
  part p;
  bool ok = part_read_head(&p, path, &mem, &err);
  if (ok) {
    part_films_new(&p, &mem);
    ok = part_read_sums(&p, path, &err);
  }
  assert_true(ok || strstr(err.text, "bad.part: ") != NULL);
  arena_free(&mem);
  return ok;
}

// Cut short anywhere, or with any one byte changed, or a byte too long, it is
// refused.
static void damage_is_found(void **state) {
  (void)state;
  arena mem = {0};
  error err;
  const char *path = path_of(&mem, "bad.part");
  part p = make_part(&mem, 0, 1, COLOR);
  p.window = (film_box){7, 3, 12, 9};
  part_deal(&p, &mem);
  p.tiles[0].state.taken[0] = 2;
  part_films_new(&p, &mem);
  assert_true(part_write(&p, path, &err));
  blob whole = blob_of(&mem, path);
  assert_true(is_believed(path));
  for (size_t n = 0; n < whole.size; n++) {
    write_blob(path, (blob){whole.bytes, n});
    assert_false(is_believed(path));
  }
  for (size_t i = 0; i < whole.size; i++) {
    whole.bytes[i] ^= (uint8_t)(1 << i % 8);
    write_blob(path, whole);
    assert_false(is_believed(path));
    whole.bytes[i] ^= (uint8_t)(1 << i % 8);
  }
  blob longer = {arena_alloc(&mem, whole.size + 1, 1), whole.size + 1};
  memcpy(longer.bytes, whole.bytes, whole.size);
  write_blob(path, longer);
  assert_false(is_believed(path));
  arena_free(&mem);
}

// Whether a part is written and not believed: its digests are right.
static bool is_refused(part *p, arena *mem) {
  error err;
  const char *path = path_of(mem, "bad.part");
  assert_true(part_write(p, path, &err));
  return !is_believed(path);
}

// A file with digests that fit may still hold nonsense.
static void nonsense_is_refused(void **state) {
  (void)state;
  arena mem = {0};
  part good = make_part(&mem, 0, 2, COLOR);
  assert_false(is_refused(&good, &mem));
  part p = good;
  p.tiles[0].number = 1;  // of the other shard
  assert_true(is_refused(&p, &mem));
  p.tiles[0].number = 0;
  p.tiles[1].state.taken[0] = 3;  // more samples than in other tiles
  assert_true(is_refused(&p, &mem));
  p.tiles[1].state.taken[0] = 2;
  p.film[PART_COLOR].count[0] = 9;  // more samples than the tile
  assert_true(is_refused(&p, &mem));
  p.film[PART_COLOR].count[0] = 1;
  p.film[PART_COLOR].sum[0][1] = (double)NAN;
  assert_true(is_refused(&p, &mem));
  p.film[PART_COLOR].sum[0][1] = 1e39;  // no sum of one float
  assert_true(is_refused(&p, &mem));
  p.film[PART_COLOR].sum[0][1] = 0;
  p.film[PART_COLOR].square[0][2] = -1;
  assert_true(is_refused(&p, &mem));
  p.film[PART_COLOR].square[0][2] = 0;
  assert_false(is_refused(&p, &mem));
  part q = good;
  q.key = "version 9\nseed \x1b[2J\n";
  assert_true(is_refused(&q, &mem));
  q = good;
  q.exposure = INFINITY;
  assert_true(is_refused(&q, &mem));
  q = good;
  q.aovs = RENDER_AOV_ALBEDO;  // without its film
  assert_true(is_refused(&q, &mem));
  q = good;
  q.tally.non_finite = 21;  // of 20
  assert_true(is_refused(&q, &mem));
  arena_free(&mem);
}

// A small file that speaks of a window of four billion pixels is refused
// before memory is taken for it, though its head is sealed.
static void size_is_not_believed(void **state) {
  (void)state;
  arena mem = {0};
  error err;
  struct rusage before, after;
  const char *path = path_of(&mem, "bad.part");
  part p = make_part(&mem, 0, 1, COLOR);
  assert_true(part_write(&p, path, &err));
  blob b = blob_of(&mem, path);
  const uint32_t sides[6] = {65535, 65535, 0, 0, 65535, 65535};
  uint8_t *at = b.bytes + 12;
  for (int i = 0; i < 6; i++)
    bytes_put_u32(&at, sides[i]);
  at = b.bytes + PART_HEAD_BYTES - 8;
  bytes_put_u64(&at, 4096 * 4096);
  size_t sealed = PART_HEAD_BYTES + strlen(p.key);
  at = b.bytes + sealed;
  bytes_put_u64(&at, digest_add(DIGEST_START, b.bytes, sealed));
  write_blob(path, b);
  getrusage(RUSAGE_SELF, &before);
  assert_false(part_read_head(&p, path, &mem, &err));
  assert_non_null(
      strstr(err.text, "bytes after its head, expected 224203898940"));
  getrusage(RUSAGE_SELF, &after);
  assert_true(after.ru_maxrss - before.ru_maxrss < 1000);
  arena_free(&mem);
}

// The first line that differs is named, with both values.
static void keys_are_compared(void **state) {
  (void)state;
  char text[100];
  assert_false(part_keys_differ("a 1\nb 2\n", "a 1\nb 2\n", text, 100));
  assert_true(part_keys_differ("a 1\nb 2\n", "a 1\nb 37\n", text, 100));
  assert_string_equal(text, "b is 2, not 37");
  assert_true(part_keys_differ("a 1\nb 2\n", "a 1\nc 2\n", text, 100));
  assert_string_equal(text, "b 2 is there, not c 2");
  assert_true(part_keys_differ("a 1\n", "a 1\nb 2\n", text, 100));
  assert_true(part_keys_differ("a", "a 1", text, 100));
  assert_true(part_keys_differ("", "a 1", text, 100));
}

static const char *const NAMES[] = {"0.part", "1.part", "2.part", "3.part"};

// Write the given shards of `count`; their set.
static part_set write_set(arena *mem, const int *shards, size_t n, int count) {
  const char **paths = ARENA_NEW(mem, const char *, n);
  part_set set;
  error err;
  for (size_t i = 0; i < n; i++) {
    part p = make_part(mem, shards[i], count, COLOR);
    paths[i] = path_of(mem, NAMES[i]);
    assert_true(part_write(&p, paths[i], &err));
  }
  assert_true(part_set_read(&set, paths, n, mem, &err));
  return set;
}

static bool complains(const part_set *set, const char *of, arena *mem) {
  report why = {.mem = mem};
  if (part_set_fits(set, &why)) return false;
  for (const report_line *l = why.first; l != NULL; l = l->next)
    if (strstr(l->text, of) != NULL) return true;
  return false;
}

// Three shards in any order are the whole; two are not, nor is one twice, nor
// one of another seed, nor one that was stopped.
static void sets_are_checked(void **state) {
  (void)state;
  arena mem = {0};
  error err;
  report why = {.mem = &mem};
  part whole = make_part(&mem, 0, 1, COLOR), joined;
  part_set set = write_set(&mem, (const int[]){2, 0, 1}, 3, 3);
  assert_true(part_set_fits(&set, &why));
  assert_true(part_set_join(&joined, &set, &mem, &err));
  same_sums(&whole, &joined);
  assert_int_equal(joined.tile_count, whole.tile_count);
  assert_int_equal(joined.tally.samples, 60);
  set.parts[1].key = "version 9\nseed 4\ngeometry 17\n";
  assert_true(complains(&set, "seed is 4, not 3", &mem));
  set.parts[1].key = set.parts[0].key;
  set.parts[1].complete = false;
  assert_true(complains(&set, "1.part: is not finished", &mem));
  set = write_set(&mem, (const int[]){0, 1}, 2, 3);
  assert_true(
      complains(&set, "2 of the 2 tiles of shard 2/3 are missing", &mem));
  set = write_set(&mem, (const int[]){0, 1, 2, 1}, 4, 3);
  assert_true(complains(&set, "3.part: 2 of its 2 tiles are in", &mem));
  set = write_set(&mem, (const int[]){0, 1, 1}, 3, 3);
  assert_true(complains(&set, "2.part: 2 of its 2 tiles are in", &mem));
  assert_true(
      complains(&set, "2 of the 2 tiles of shard 2/3 are missing", &mem));
  arena_free(&mem);
}

static int make_folder(void **state) {
  (void)state;
  strcpy(folder, "/tmp/facet-part-XXXXXX");
  return mkdtemp(folder) == NULL;
}

static int remove_folder(void **state) {
  (void)state;
  arena mem = {0};
  remove(path_of(&mem, "x.part"));
  remove(path_of(&mem, "bad.part"));
  for (int i = 0; i < 4; i++)
    remove(path_of(&mem, NAMES[i]));
  arena_free(&mem);
  return rmdir(folder);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(dealt_fairly),
      cmocka_unit_test(comes_back),
      cmocka_unit_test(damage_is_found),
      cmocka_unit_test(nonsense_is_refused),
      cmocka_unit_test(size_is_not_believed),
      cmocka_unit_test(keys_are_compared),
      cmocka_unit_test(sets_are_checked),
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
