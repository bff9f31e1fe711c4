// path_group.c

#include "path_group.h"

#include "rng.h"

#include <string.h>

enum { SLOTS = 2 * INTEGRATOR_BATCH };

// A group: its block, by the number and the place of the first pixel, which one
// of that block it is, and the sample.
typedef struct group {
  uint64_t first;
  int x, y;
  uint32_t which, sample;
  uint64_t name;
} group;

// Deal the pixels of a block out to groups, differently for each block and
// sample: number `at` gets another number, whose first digits are the group and
// whose last are the seat.  A group has pixels of one color of a chessboard:
// chapter 15 decides by those of one color how many samples the others get, so
// these must know nothing of each other.
static uint32_t deal(const group *g, uint32_t at) {
  enum { ALL = GROUP * BLOCK_GROUPS / 2 };
  uint32_t color = (at ^ at / BLOCK_WIDTH) % 2;
  uint64_t key = rng_mix(rng_mix(g->first) + g->sample);
  at /= 2;
  for (int round = 0; round < 3; round++, key >>= 16) {
    at = (at * (uint32_t)(key | 1) + (uint32_t)(key >> 8)) % ALL;
    at ^= at >> 2;
  }
  return color * ALL + at;
}

// The group of a start, and its seat.  Pixels beyond the film are those of
// another film of that size.
static group group_of(const path_film *f, const path_start *s, uint32_t *seat) {
  uint64_t w = (uint64_t)f->width, in = s->pixel % (w * (uint64_t)f->height);
  int x = (int)(in % w), y = (int)(in / w);
  group g = {.sample = s->sample};
  g.x = x / BLOCK_WIDTH * BLOCK_WIDTH, g.y = y / BLOCK_HEIGHT * BLOCK_HEIGHT;
  g.first = s->pixel - in + (uint64_t)g.y * w + (uint64_t)g.x;
  uint32_t at = deal(&g, (uint32_t)((y - g.y) * BLOCK_WIDTH + x - g.x));
  g.which = at / GROUP, *seat = at % GROUP;
  g.name = (g.first * BLOCK_GROUPS + g.which) << 32 | g.sample;
  return g;
}

// A place for each pixel of a group that is on the film.
static void seat_all(path_groups *to, const path_film *f, const group *g) {
  to->name[to->count / GROUP] = g->name;
  for (int i = 0; i < GROUP * BLOCK_GROUPS; i++) {
    uint32_t at = deal(g, (uint32_t)i);
    if (at / GROUP != g->which) continue;
    int right = i % BLOCK_WIDTH, down = i / BLOCK_WIDTH;
    bool here = g->x + right < f->width && g->y + down < f->height;
    uint64_t pixel =
        g->first + (uint64_t)down * (uint64_t)f->width + (uint64_t)right;
    path_start *s = &to->starts[to->count + at % GROUP];
    *s = (path_start){.pixel = here ? pixel : GROUP_NO_PIXEL,
                      .sample = g->sample};
    to->asked[to->count + at % GROUP] = GROUP_NOBODY;
  }
  to->count += GROUP;
}

// Rays for those who were not asked for.
static void start_others(path_groups *to, const path_film *f,
                         const integrator *by) {
  uint64_t w = (uint64_t)f->width, all = w * (uint64_t)f->height;
  for (size_t i = 0; i < to->count; i++) {
    path_start *s = &to->starts[i];
    if (to->asked[i] != GROUP_NOBODY || s->pixel == GROUP_NO_PIXEL) continue;
    vec2 in = by->place(by->self, s->pixel, s->sample);
    float x = (float)(s->pixel % all % w) + in.x;
    s->ray = camera_ray(f->view, x, (float)(s->pixel % all / w) + in.y);
  }
}

// Where the members of a group begin, in the table: its own place, or an empty
// one.
static uint32_t *slot_of(path_groups *to, const group *g) {
  size_t slot = rng_mix(g->name) % SLOTS;
  while (to->first_of[slot] != GROUP_NOBODY &&
         to->name[to->first_of[slot] / GROUP] != g->name)
    slot = (slot + 1) % SLOTS;
  return &to->first_of[slot];
}

size_t path_groups_seat(path_groups *to, const path_film *film,
                        const integrator *by, const path_start *starts,
                        size_t n) {
  size_t i;
  memset(to->first_of, 0xff, sizeof to->first_of);
  to->count = 0;
  for (i = 0; i < n; i++) {
    uint32_t seat;
    group g = group_of(film, &starts[i], &seat);
    uint32_t *slot = slot_of(to, &g);
    if (*slot == GROUP_NOBODY) {
      if (to->count + GROUP > INTEGRATOR_BATCH) break;
      *slot = (uint32_t)to->count;
      seat_all(to, film, &g);
    }
    to->starts[*slot + seat] = starts[i];
    to->asked[*slot + seat] = (uint32_t)i;
  }
  start_others(to, film, by);
  return i;
}

// Other numbers than those of the pixels.
#define GROUP_SEED UINT64_C(0x67726f7570)

sampler path_groups_numbers(const path_groups *g, size_t i, sampler_kind kind,
                            uint64_t seed) {
  enum { COLOR_GROUPS = BLOCK_GROUPS / 2 };
  uint64_t which = g->name[i / GROUP] >> 32;
  uint32_t run = (uint32_t)g->name[i / GROUP] * COLOR_GROUPS;
  run += (uint32_t)(which % COLOR_GROUPS);
  return sampler_of(kind, seed ^ GROUP_SEED, which / COLOR_GROUPS,
                    run * GROUP + (uint32_t)(i % GROUP));
}
