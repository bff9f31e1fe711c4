// adaptive.c — the trick: each half of a tile's samples is as many as the
// *other* half says that are needed.  A half that has not met the lamp yet
// cannot end its own search, so that neither mean is biased by the decision.

#include "adaptive.h"

#include "halves.h"

// Samples of each half in the first round, from which tiles are told apart.
enum { PILOT = 8 };

// How much a round may add to the whole picture, and to one tile.
#define GROWTH_MIN 1.1
#define GROWTH_MAX 1.6
#define TILE_GROWTH 3.0

// No tile gets less than this share of the average: what a tile's few samples
// have missed must stay likely to be found.
#define LEAST_SHARE 0.125

// Samples of each half: so many there are, at the end of this pass, and at the
// end of the round.
typedef struct tile_state {
  uint32_t taken[2], pass[2], round[2];
  double need[2];  // for the other half: a sample's standard deviation over
                   // the root of its rays
  double pixels, rays;
} tile_state;

struct adaptive {
  adaptive_settings set;
  halves halves;
  tile_state *tiles;
  size_t tile_count;
  int tiles_across;
  double error;  // after the last round
};

adaptive *adaptive_new(const adaptive_settings *s, arena *mem) {
  adaptive *a = ARENA_NEW(mem, adaptive, 1);
  a->set = *s;
  a->halves = halves_new(mem, s->width, s->height);
  a->tiles_across = (s->width + RENDER_TILE - 1) / RENDER_TILE;
  int down = (s->height + RENDER_TILE - 1) / RENDER_TILE;
  a->tile_count = (size_t)a->tiles_across * (size_t)down;
  a->tiles = ARENA_NEW(mem, tile_state, a->tile_count);
  return a;
}

// The part of the window that a tile is.
static film_box box_of(const adaptive *a, size_t tile) {
  int x = (int)tile % a->tiles_across * RENDER_TILE;
  int y = (int)tile / a->tiles_across * RENDER_TILE;
  int x1 = x + RENDER_TILE, y1 = y + RENDER_TILE;
  return (film_box){x, y, x1 < a->set.width ? x1 : a->set.width,
                    y1 < a->set.height ? y1 : a->set.height};
}

// What each half of a tile says to the other of the spread of a sample, and
// what that costs.
static void ask_tile(adaptive *a, size_t tile) {
  tile_state *t = &a->tiles[tile];
  film_box box = box_of(a, tile);
  t->pixels = (double)(box.x1 - box.x0) * (double)(box.y1 - box.y0);
  for (int k = 0; k < 2; k++) {
    const film *other = &a->halves.half[1 - k];
    double of_mean = film_box_error(other, &box) / (3 * t->pixels);
    double samples = t->pixels * (double)(t->taken[0] + t->taken[1]);
    double variance = of_mean * (double)t->taken[1 - k];
    t->need[k] = sqrt(variance / fmax(t->rays / fmax(samples, 1), 1));
  }
}

static double samples_taken(const adaptive *a) {
  double sum = 0;
  for (size_t i = 0; i < a->tile_count; i++) {
    const tile_state *t = &a->tiles[i];
    sum += t->pixels * (double)(t->taken[0] + t->taken[1]);
  }
  return sum;
}

static double all_pixels(const adaptive *a) {
  return (double)a->set.width * (double)a->set.height;
}

// The number of samples of one half of a tile for a price: with a variance of
// v and c rays, one sample more takes v / n^2 off the error, so that n = price
// sqrt(v / c) spends every ray where it buys most.
static uint32_t fair_number(const tile_state *t, int half, double price,
                            double least) {
  double taken = (double)t->taken[half];
  double n = fmin(fmax(price * t->need[half], least), TILE_GROWTH * taken);
  return (uint32_t)(fmax(n, taken) + 0.5);
}

// Set the ends of the round for a price; how many samples the picture has then.
static double set_round(adaptive *a, double price, double least) {
  double sum = 0;
  for (size_t i = 0; i < a->tile_count; i++) {
    tile_state *t = &a->tiles[i];
    for (int k = 0; k < 2; k++) {
      t->round[k] = fair_number(t, k, price, least);
      sum += t->pixels * (double)t->round[k];
    }
  }
  return sum;
}

// A round that brings the picture to about `goal` samples: the price is found
// by halving an interval.  False where there is no such round.
static bool plan_round(adaptive *a, double goal) {
  double least = LEAST_SHARE * goal / (2 * all_pixels(a));
  double low = 0, high = 1;
  for (size_t i = 0; i < a->tile_count; i++)
    ask_tile(a, i);
  while (set_round(a, high, least) < goal && high < 1e12)
    low = high, high *= 2;
  for (int i = 0; i < 30; i++) {
    double mid = (low + high) / 2;
    if (set_round(a, mid, least) < goal)
      low = mid;
    else
      high = mid;
  }
  // Where no price helps, as all tiles grow as fast as they may or none needs
  // anything, everything grows alike.
  double taken = samples_taken(a);
  if (set_round(a, high, least) > taken) return true;
  if (taken + 2 * all_pixels(a) > goal) return false;
  for (size_t i = 0; i < a->tile_count; i++)
    for (int k = 0; k < 2; k++)
      a->tiles[i].round[k] = a->tiles[i].taken[k] + 1;
  return true;
}

static void plan_first(adaptive *a) {
  double half = fmin(PILOT, fmax(floor(a->set.most / 2), 1));
  for (size_t i = 0; i < a->tile_count; i++) {
    ask_tile(a, i);
    a->tiles[i].round[0] = a->tiles[i].round[1] = (uint32_t)half;
  }
  if (a->set.most < 2)
    for (size_t i = 0; i < a->tile_count; i++)
      a->tiles[i].round[1] = 0;
}

// By how much the picture's samples should grow: as the error asks, which
// falls as their root, within limits, and as time and --spp allow.
static double growth(const adaptive *a, double taken, const render_budget *b) {
  double g = GROWTH_MAX;
  if (a->set.error > 0) {
    double off = a->error / a->set.error;
    g = fmin(fmax(1.02 * off * off, GROWTH_MIN), GROWTH_MAX);
  }
  g = fmin(g, 1 + b->left / taken);
  return fmin(g, a->set.most * all_pixels(a) / taken);
}

// Begin the next round; false when the picture is good enough, or has all the
// samples that it may have.
static bool next_round(adaptive *a, const render_budget *b) {
  double taken = samples_taken(a);
  if (!(taken > 0)) {
    plan_first(a);
    return true;
  }
  a->error = halves_error(&a->halves, NULL);
  bool known = a->error > 0 || a->tiles[0].taken[1] > 0;
  if (a->set.error > 0 && known && a->error <= a->set.error) return false;
  double g = growth(a, taken, b);
  if (g * taken < taken + all_pixels(a) / 4) return false;
  return plan_round(a, g * taken);
}

// What is missing until the end of the round, in samples.
static double round_left(const adaptive *a) {
  double sum = 0;
  for (size_t i = 0; i < a->tile_count; i++) {
    const tile_state *t = &a->tiles[i];
    for (int k = 0; k < 2; k++)
      sum += t->pixels * (double)(t->round[k] - t->taken[k]);
  }
  return sum;
}

// Set the end of the pass to a share of what each tile is to get: a whole
// number, of tiles that get the same not always the same.  How many samples
// that is.
static double set_pass(adaptive *a, double share) {
  double sum = 0;
  for (size_t i = 0; i < a->tile_count; i++) {
    tile_state *t = &a->tiles[i];
    for (int k = 0; k < 2; k++) {
      double golden = 0.61803399 * (double)(2 * i + (size_t)k);
      double odd = share < 1 ? golden - floor(golden) : 0;
      double more = floor(share * (double)(t->round[k] - t->taken[k]) + odd);
      t->pass[k] = t->taken[k] + (uint32_t)more;
      sum += more * t->pixels;
    }
  }
  return sum;
}

// The first pass: one sample, so that there is a picture at all.
static double set_first(adaptive *a) {
  for (size_t i = 0; i < a->tile_count; i++)
    a->tiles[i].pass[0] = 1;
  return all_pixels(a);
}

// A pass is a part of the round.
static double adaptive_plan(void *self, const render_budget *b) {
  adaptive *a = self;
  for (size_t i = 0; i < a->tile_count; i++)
    for (int k = 0; k < 2; k++)
      a->tiles[i].taken[k] = a->tiles[i].pass[k];
  if (!(round_left(a) > 0) && !next_round(a, b)) return 0;
  bool first = !(samples_taken(a) > 0);
  double share = fmin(b->pass / round_left(a), 1);
  double samples = first ? set_first(a) : set_pass(a, share);
  return samples > 0 ? samples : set_pass(a, 1);
}

static bool adaptive_next(void *self, size_t tile, uint32_t *at,
                          uint32_t *sample) {
  const tile_state *t = &((adaptive *)self)->tiles[tile];
  uint32_t first = t->pass[0] - t->taken[0], k = (*at)++;
  if (k < first)
    *sample = 2 * (t->taken[0] + k);
  else
    *sample = 2 * (t->taken[1] + k - first) + 1;
  return k < first + t->pass[1] - t->taken[1];
}

static void adaptive_add(void *self, size_t pixel, uint32_t sample,
                         vec3 color) {
  halves_add(&((adaptive *)self)->halves, pixel, sample, color);
}

static void adaptive_spend(void *self, size_t tile, uint64_t rays) {
  ((adaptive *)self)->tiles[tile].rays += (double)rays;
}

static double adaptive_error(void *self, pool *threads) {
  return halves_error(&((adaptive *)self)->halves, threads);
}

static vec3 adaptive_mean(const void *self, size_t pixel) {
  return halves_mean(&((const adaptive *)self)->halves, pixel);
}

static vec3 adaptive_variance(const void *self, size_t pixel) {
  return halves_variance(&((const adaptive *)self)->halves, pixel);
}

render_guide adaptive_guide(adaptive *a) {
  return (render_guide){a,
                        adaptive_plan,
                        adaptive_next,
                        adaptive_add,
                        adaptive_spend,
                        adaptive_error,
                        adaptive_mean,
                        adaptive_variance};
}

void adaptive_tiles(const adaptive *a, adaptive_tile *out) {
  for (size_t i = 0; i < a->tile_count; i++) {
    const tile_state *t = &a->tiles[i];
    out[i] = (adaptive_tile){{t->pass[0], t->pass[1]},
                             {t->round[0], t->round[1]},
                             (uint64_t)t->rays};
  }
}

const halves *adaptive_sums(const adaptive *a) {
  return &a->halves;
}

void adaptive_go_on(adaptive *a, const adaptive_tile *tiles, const halves *h) {
  for (int k = 0; k < 2; k++)
    film_copy(&a->halves.half[k], &h->half[k]);
  for (size_t i = 0; i < a->tile_count; i++) {
    tile_state *t = &a->tiles[i];
    for (int k = 0; k < 2; k++) {
      t->taken[k] = t->pass[k] = tiles[i].taken[k];
      t->round[k] = tiles[i].round[k];
    }
    t->rays = (double)tiles[i].rays;
    ask_tile(a, i);
  }
}
