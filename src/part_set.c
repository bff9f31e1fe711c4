// part_set.c

#include "part_set.h"

#include <stdio.h>
#include <string.h>

bool part_set_read(part_set *out, const char *const *paths, size_t count,
                   arena *mem, error *err) {
  *out = (part_set){paths, ARENA_NEW(mem, part, count), count};
  for (size_t i = 0; i < count; i++)
    if (!part_read_head(&out->parts[i], paths[i], mem, err)) return false;
  return true;
}

static bool same_box(const film_box *a, const film_box *b) {
  return a->x0 == b->x0 && a->y0 == b->y0 && a->x1 == b->x1 && a->y1 == b->y1;
}

// Whether all are parts of the picture that the first is a part of.
static bool check_kinship(const part_set *s, report *why) {
  const part *a = &s->parts[0];
  bool fits = true;
  for (size_t i = 1; i < s->count; i++) {
    const part *p = &s->parts[i];
    char text[256] = "its films differ";
    bool keys = part_keys_differ(p->key, a->key, text, sizeof text);
    if (!keys && p->spp != a->spp)
      snprintf(text, sizeof text, "spp is %u, not %u", p->spp, a->spp);
    if (!keys && p->spp == a->spp && p->width == a->width &&
        p->height == a->height && same_box(&p->window, &a->window) &&
        p->films == a->films && p->aovs == a->aovs &&
        p->radiance == a->radiance)
      continue;
    report_warn(why, "%s: is of another picture than %s: its %s", s->paths[i],
                s->paths[0], text);
    fits = false;
  }
  return fits;
}

static bool check_finished(const part_set *s, report *why) {
  bool fits = true;
  for (size_t i = 0; i < s->count; i++) {
    if (s->parts[i].complete) continue;
    report_warn(why, "%s: is not finished; render it again with --resume",
                s->paths[i]);
    fits = false;
  }
  return fits;
}

// Who has each tile of the window: its place among the parts plus one, 0 when
// nobody has.
static uint32_t *find_owners(const part_set *s, report *why, arena *mem) {
  shard all = {part_width(&s->parts[0]), part_height(&s->parts[0]), 0, 1};
  uint32_t *owner = ARENA_NEW(mem, uint32_t, shard_tiles(&all));
  for (size_t i = 0; i < s->count; i++) {
    const part *p = &s->parts[i];
    size_t doubles = 0;
    uint32_t other = 0;
    for (size_t k = 0; k < p->tile_count; k++) {
      uint32_t *o = &owner[p->tiles[k].number];
      if (*o != 0) doubles++, other = *o;
      if (*o == 0) *o = (uint32_t)i + 1;
    }
    if (doubles > 0)
      report_warn(why, "%s: %zu of its %zu tiles are in %s, too", s->paths[i],
                  doubles, p->tile_count, s->paths[other - 1]);
  }
  return owner;
}

// What nobody has, by the shards of the first part.
static void tell_holes(const part_set *s, const uint32_t *owner, report *why) {
  shard hand = part_shard(&s->parts[0]);
  for (int name = 1; name <= hand.count; name++) {
    hand.index = name % hand.count;
    size_t n = shard_tiles(&hand), missing = 0;
    for (size_t k = 0; k < n; k++)
      missing += owner[shard_tile(&hand, k)] == 0;
    if (missing > 0)
      report_warn(why, "%zu of the %zu tiles of shard %d/%d are missing",
                  missing, n, name, hand.count);
  }
}

bool part_set_fits(const part_set *s, report *why) {
  int before = why->warnings;
  if (!check_kinship(s, why)) return false;
  check_finished(s, why);
  arena scratch = {0};
  tell_holes(s, find_owners(s, why, &scratch), why);
  arena_free(&scratch);
  return why->warnings == before;
}

bool part_set_join(part *out, const part_set *s, arena *mem, error *err) {
  part p = s->parts[0];
  p.shard = 0, p.shards = 1;
  p.tally = (tally){0};
  part_deal(&p, mem);
  part_films_new(&p, mem);
  for (size_t i = 0; i < s->count; i++) {
    part one = s->parts[i];
    memcpy(one.film, p.film, sizeof p.film);
    one.marks = p.marks;
    if (!part_read_sums(&one, s->paths[i], err)) return false;
    for (size_t k = 0; k < one.tile_count; k++)
      p.tiles[one.tiles[k].number] = one.tiles[k];
    tally_add(&p.tally, &one.tally);
  }
  *out = p;
  return true;
}
