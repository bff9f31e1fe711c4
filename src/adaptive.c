// adaptive.c — the trick: the pixels of a tile are coloured like a chessboard,
// and the black ones get as many samples as the *white* ones say that are
// needed, and the other way round.  A pixel that has not met the lamp yet
// cannot end its own search, so that no mean is biased by the decision.

#include "adaptive.h"

// Samples of a pixel in the first round, two of each half.  Tiles are told
// apart when all have an eighth of what they will need, or more.
enum { PILOT = 4 };
#define PILOT_SHARE 0.125

// How many times as large a round makes the whole picture, at least and most.
#define GROWTH_MIN 1.05
#define GROWTH_MAX 1.3

// The standard errors by which the error has to be below what is asked.
#define SURE 1.0

// No tile gets less than this share of the average: what a tile's few samples
// have missed must stay likely to be found.
#define LEAST_SHARE 0.125

// Samples of a black and of a white pixel: so many there are, at the end of
// this pass, and at the end of the round.
typedef struct tile_state {
  uint32_t taken[2], pass[2], round[2];
  double need[2];  // as the other color sees it: a sample's standard deviation
                   // over the root of its rays
  double pixels[2];  // of each color
  double rays;
} tile_state;

struct adaptive {
  adaptive_settings set;
  halves halves;
  tile_state *tiles;
  size_t tile_count;
  int tiles_across;
  bool asked;          // all tiles, what they need
  halves_estimate is;  // of what there was
  bool known;          // at the last look, since when nothing was planned
};

// The part of the window that a tile is.
static film_box box_of(const adaptive *a, size_t tile) {
  int x = (int)tile % a->tiles_across * RENDER_TILE;
  int y = (int)tile / a->tiles_across * RENDER_TILE;
  int x1 = x + RENDER_TILE, y1 = y + RENDER_TILE;
  return (film_box){x, y, x1 < a->set.width ? x1 : a->set.width,
                    y1 < a->set.height ? y1 : a->set.height};
}

static void count_pixels(adaptive *a, size_t tile) {
  film_box b = box_of(a, tile);
  int all = (b.x1 - b.x0) * (b.y1 - b.y0);
  a->tiles[tile].pixels[0] = (all + 1) / 2;
  a->tiles[tile].pixels[1] = all / 2;
}

adaptive *adaptive_new(const adaptive_settings *s, arena *mem) {
  adaptive *a = ARENA_NEW(mem, adaptive, 1);
  a->set = *s;
  a->halves = halves_new(mem, s->width, s->height);
  a->tiles_across = (s->width + RENDER_TILE - 1) / RENDER_TILE;
  int down = (s->height + RENDER_TILE - 1) / RENDER_TILE;
  a->tile_count = (size_t)a->tiles_across * (size_t)down;
  a->tiles = ARENA_NEW(mem, tile_state, a->tile_count);
  for (size_t i = 0; i < a->tile_count; i++)
    count_pixels(a, i);
  return a;
}

static double samples_of(const tile_state *t) {
  return t->pixels[0] * t->taken[0] + t->pixels[1] * t->taken[1];
}

// Pixels a side of a block whose pixels of a color share the radiance that
// their errors are divided by.
enum { BLOCK = 4 };

// The squared relative error of a color's pixels in a block, by their halves;
// the sum over these pixels and their channels.
static double block_error(const adaptive *a, film_box b, int color) {
  double sum = 0;
  for (int c = 0; c < 3; c++) {
    double squares = 0, radiance = 0, n = 0;
    for (int y = b.y0; y < b.y1; y++)
      for (int x = b.x0 + ((b.x0 + y + color) & 1); x < b.x1; x += 2) {
        size_t i = (size_t)y * (size_t)a->set.width + (size_t)x;
        double m[2];
        halves_means(&a->halves, i, c, m);
        double square = (m[0] - m[1]) * (m[0] - m[1]) / 4;
        squares += square;
        radiance += m[0] * m[1];
        n++;
      }
    if (n > 0) sum += squares / (fmax(radiance / n, 0) + 0.01);
  }
  return sum;
}

// What the pixels of each color say to the other of the spread of a sample, and
// what that costs.
static void ask_tile(adaptive *a, size_t tile) {
  tile_state *t = &a->tiles[tile];
  film_box b = box_of(a, tile);
  double sum[2] = {0, 0}, rays = t->rays / fmax(samples_of(t), 1);
  for (int y = b.y0; y < b.y1; y += BLOCK)
    for (int x = b.x0; x < b.x1; x += BLOCK) {
      film_box block = {x, y, x + BLOCK < b.x1 ? x + BLOCK : b.x1,
                        y + BLOCK < b.y1 ? y + BLOCK : b.y1};
      for (int k = 0; k < 2; k++)
        sum[k] += block_error(a, block, k);
    }
  for (int k = 0; k < 2; k++) {
    double of_mean = sum[1 - k] / fmax(3 * t->pixels[1 - k], 1);
    t->need[k] = sqrt(of_mean * t->taken[1 - k] / fmax(rays, 1));
  }
  // A corner of one pixel is like the tile before.
  if (t->pixels[1] == 0 && tile > 0) t->need[0] = t[-1].need[0];
}

static double samples_taken(const adaptive *a) {
  double sum = 0;
  for (size_t i = 0; i < a->tile_count; i++)
    sum += samples_of(&a->tiles[i]);
  return sum;
}

static double all_pixels(const adaptive *a) {
  return (double)a->set.width * (double)a->set.height;
}

// The number of samples of a pixel for a price: with a variance of v and c
// rays, one sample more takes v / n^2 off the error, so that n = price sqrt(v /
// c) spends every ray where it buys most.  Of the pilot's doubles, on which a
// sequence is most even, the nearest.
static uint32_t fair_number(const tile_state *t, int color, double price,
                            double least) {
  uint32_t n = t->taken[color];
  return fmax(price * t->need[color], least) < n * sqrt(2) ? n : 2 * n;
}

// Set the ends of the round for a price; how many samples the picture has then.
static double set_round(adaptive *a, double price, double least) {
  double sum = 0;
  for (size_t i = 0; i < a->tile_count; i++) {
    tile_state *t = &a->tiles[i];
    for (int k = 0; k < 2; k++) {
      t->round[k] = fair_number(t, k, price, least);
      sum += t->pixels[k] * t->round[k];
    }
  }
  return sum;
}

// Give what the higher of two prices that are almost one buys to as many tiles,
// in order, as there is room for.  How many samples the picture has then.
static double fill_round(adaptive *a, double goal, double sum, double price) {
  for (size_t i = 0; i < a->tile_count; i++) {
    tile_state *t = &a->tiles[i];
    for (int k = 0; k < 2; k++) {
      uint32_t n = fair_number(t, k, price, 0);
      double more = n > t->round[k] ? t->pixels[k] * (n - t->round[k]) : 0;
      if (more == 0 || sum + more > goal) continue;
      t->round[k] = n;
      sum += more;
    }
  }
  return sum;
}

// A round that brings the picture to at most `goal` samples: the price is found
// by halving an interval.  False where there is no such round.
static bool plan_round(adaptive *a, double goal) {
  double least = LEAST_SHARE * goal / all_pixels(a);
  double low = 0, high = 1;
  while (set_round(a, high, least) < goal && high < 1e12)
    low = high, high *= 2;
  for (int i = 0; i < 50; i++) {
    double mid = (low + high) / 2;
    if (set_round(a, mid, least) < goal)
      low = mid;
    else
      high = mid;
  }
  double taken = samples_taken(a), sum = set_round(a, low, least);
  sum = fill_round(a, goal, sum, high);
  return sum > taken;
}

// Where no price helps, as none needs anything or the next step would be too
// long, everything grows alike, by a quarter or less.
static bool plan_alike(adaptive *a, double taken, double most) {
  double pixels = all_pixels(a), step = fmax(floor(taken / pixels / 8), 1);
  step = 2 * fmin(step, floor((most - taken) / pixels / 2));
  for (size_t i = 0; i < a->tile_count; i++)
    for (int k = 0; k < 2; k++)
      a->tiles[i].round[k] = a->tiles[i].taken[k] + (uint32_t)fmax(step, 0);
  return step > 0;
}

// A round after which all tiles have n samples a pixel.
static bool plan_even(adaptive *a, uint32_t n) {
  for (size_t i = 0; i < a->tile_count; i++)
    a->tiles[i].round[0] = a->tiles[i].round[1] = n;
  return true;
}

// Whether the pass was the last of its round: only then may the error be
// enough, however rounds are cut into passes.
static bool round_ends(const adaptive *a) {
  for (size_t i = 0; i < a->tile_count; i++)
    for (int k = 0; k < 2; k++)
      if (a->tiles[i].pass[k] != a->tiles[i].round[k]) return false;
  return true;
}

// The error that the picture does not exceed in five cases of six.
static double look(adaptive *a, pool *threads) {
  bool judged = a->set.jury != NULL && round_ends(a);
  if (!a->known && judged)
    a->is = jury_error(a->set.jury, &a->halves, a->set.error, threads);
  else if (!a->known)
    a->is = halves_error(&a->halves, NULL, threads);
  a->known = true;
  return a->is.error * (1 + SURE * a->is.doubt);
}

// The largest step of one color of a tile.
static double largest_step(const adaptive *a) {
  double most = 0;
  for (size_t i = 0; i < a->tile_count; i++)
    for (int k = 0; k < 2; k++)
      most = fmax(most, a->tiles[i].pixels[k] * a->tiles[i].taken[k]);
  return most;
}

// How many samples the picture will need, if the error falls at least as the
// root of their number, and as time and --spp allow.
static double samples_needed(adaptive *a, double taken, double all) {
  if (!(a->set.error > 0)) return all;
  return fmin(all, taken * pow(look(a, NULL) / a->set.error, 1.5));
}

// And after the next round, which is to be neither short nor long.
static double next_goal(adaptive *a, double taken, double most) {
  double goal = fmax(samples_needed(a, taken, most), GROWTH_MIN * taken);
  goal = fmax(fmin(goal, GROWTH_MAX * taken), taken + largest_step(a));
  return fmin(goal, most);
}

// Begin the next round; false when the picture is good enough, or has all the
// samples that it may have.
static bool next_round(adaptive *a, const render_budget *b) {
  double taken = samples_taken(a);
  double most = fmin(taken + b->left, a->set.most * all_pixels(a));
  if (!(taken > 0))
    return plan_even(a, a->set.most < 2 ? 1 : a->set.most < PILOT ? 2 : PILOT);
  bool known = a->set.error > 0 && a->tiles[0].taken[0] > 1;
  if (known && look(a, NULL) <= a->set.error) return false;
  if (!a->asked && taken <= PILOT_SHARE * samples_needed(a, taken, most))
    return plan_even(a, 2 * a->tiles[0].taken[0]);
  for (size_t i = 0; i < a->tile_count && !a->asked; i++)
    ask_tile(a, i);
  a->asked = true;
  return plan_round(a, next_goal(a, taken, most)) || plan_alike(a, taken, most);
}

// What is missing until the end of the round, in samples.
static double round_left(const adaptive *a) {
  double sum = 0;
  for (size_t i = 0; i < a->tile_count; i++) {
    const tile_state *t = &a->tiles[i];
    for (int k = 0; k < 2; k++)
      sum += t->pixels[k] * (t->round[k] - t->taken[k]);
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
    double golden = 0.61803399 * (double)i;
    double odd = share < 1 ? golden - floor(golden) : 0;
    for (int k = 0; k < 2; k++) {
      double more = floor(share * (t->round[k] - t->taken[k]) + odd);
      t->pass[k] = t->taken[k] + (uint32_t)more;
      sum += more * t->pixels[k];
    }
  }
  return sum;
}

// The first pass: one sample, so that there is a picture at all.
static double set_first(adaptive *a) {
  for (size_t i = 0; i < a->tile_count; i++)
    a->tiles[i].pass[0] = a->tiles[i].pass[1] = 1;
  return all_pixels(a);
}

// A pass is a part of the round.
static double adaptive_plan(void *self, const render_budget *b) {
  adaptive *a = self;
  for (size_t i = 0; i < a->tile_count; i++)
    for (int k = 0; k < 2; k++)
      a->tiles[i].taken[k] = a->tiles[i].pass[k];
  if (!(round_left(a) > 0) && !next_round(a, b)) return 0;
  a->known = false;
  bool first = !(samples_taken(a) > 0);
  double share = fmin(b->pass / round_left(a), 1);
  double samples = first ? set_first(a) : set_pass(a, share);
  return samples > 0 ? samples : set_pass(a, 1);
}

// Both colors together while they get the same, then the black pixels' samples
// and the white ones'.
static bool adaptive_next(void *self, size_t tile, uint32_t *at,
                          render_turn *turn) {
  const tile_state *t = &((adaptive *)self)->tiles[tile];
  uint32_t k = (*at)++, black = t->pass[0] - t->taken[0];
  bool alike = t->taken[0] == t->taken[1] && t->pass[0] == t->pass[1];
  if (k < black)
    *turn = (render_turn){t->taken[0] + k, alike ? RENDER_BOTH_COLORS : 0};
  else
    *turn = (render_turn){t->taken[1] + k - black, 1};
  return k < black || (!alike && k - black < t->pass[1] - t->taken[1]);
}

static void adaptive_add(void *self, size_t pixel, uint32_t sample,
                         vec3 color) {
  halves_add(&((adaptive *)self)->halves, pixel, sample, color);
}

static void adaptive_spend(void *self, size_t tile, uint64_t rays) {
  ((adaptive *)self)->tiles[tile].rays += (double)rays;
}

static double adaptive_error(void *self, pool *threads) {
  look(self, threads);
  return ((adaptive *)self)->is.error;
}

static vec3 adaptive_mean(const void *self, size_t pixel) {
  return halves_mean(&((const adaptive *)self)->halves, pixel);
}

static vec3 adaptive_variance(const void *self, size_t pixel) {
  return halves_variance(&((const adaptive *)self)->halves, pixel);
}

render_guide adaptive_guide(adaptive *a) {
  return (render_guide){.self = a,
                        .plan = adaptive_plan,
                        .next = adaptive_next,
                        .add = adaptive_add,
                        .spend = adaptive_spend,
                        .error = adaptive_error,
                        .mean = adaptive_mean,
                        .variance = adaptive_variance};
}

void adaptive_tiles(const adaptive *a, adaptive_tile *out) {
  for (size_t i = 0; i < a->tile_count; i++) {
    const tile_state *t = &a->tiles[i];
    out[i] = (adaptive_tile){{t->pass[0], t->pass[1]},
                             {t->round[0], t->round[1]},
                             (uint64_t)t->rays,
                             {t->need[0], t->need[1]}};
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
    for (int k = 0; k < 2; k++) {
      t->need[k] = tiles[i].need[k];
      a->asked = a->asked || t->need[k] > 0;
    }
  }
}
