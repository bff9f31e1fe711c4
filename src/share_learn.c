// share_learn.c — the trick: two independent samples of a pixel differ by as
// much as they are wrong, whatever is right.

#include "share_learn.h"

#include "light_emission.h"

// Other numbers than those of the picture and of the other lessons.
#define OTHER_SEED UINT64_C(0x7368617265)

// Samples of the pixels of so many groups, each twice, by paths that share and
// by such that do not; of a few groups first, which are the first of all.
enum { GROUPS = 64, FEW = 16, PIXELS = GROUPS * GROUP, TWICE = 2, WAYS = 2 };

// Variance times rays must shrink by this factor: errors that neighbours have
// in common are seen more easily, and less is known of them.
#define WORTH 1.6

// By this for those few, or there is no hope.
#define HOPE 1.3

typedef struct share_trial {
  const path_tracer *by;
  const path_film *film;
  size_t from, pixels;  // the next to walk; up to here
  vec3 colors[WAYS][TWICE][PIXELS];
  uint64_t rays[WAYS][TWICE];
} share_trial;

// Pixels of blocks evenly over the film.  Source: Roberts 2018, as in
// path_ready.c.
static void start_all(const share_trial *t, const integrator *by,
                      path_start *starts) {
  const path_film *f = t->film;
  enum { BLOCK = BLOCK_WIDTH * BLOCK_HEIGHT };
  for (uint64_t i = t->from; i < t->pixels; i++) {
    double n = (double)(i / BLOCK) + 0.5;
    uint64_t x = (uint64_t)(fmod(n * 0.7548776662, 1) * f->width);
    uint64_t y = (uint64_t)(fmod(n * 0.5698402910, 1) * f->height);
    x = x / BLOCK_WIDTH * BLOCK_WIDTH + i % BLOCK_WIDTH;
    y = y / BLOCK_HEIGHT * BLOCK_HEIGHT + i % BLOCK / BLOCK_WIDTH;
    x = x < (uint64_t)f->width ? x : (uint64_t)f->width - 1;
    y = y < (uint64_t)f->height ? y : (uint64_t)f->height - 1;
    uint64_t pixel = y * (uint64_t)f->width + x;
    vec2 in = by->place(by->self, pixel, 0);
    ray r = camera_ray(f->view, (float)x + in.x, (float)y + in.y);
    starts[i] = (path_start){r, pixel, 0};
  }
}

static void walk(void *context, size_t item, int worker) {
  (void)worker;
  share_trial *t = context;
  size_t way = item / TWICE, turn = item % TWICE;
  arena scratch = {0};
  path_tracer one = *t->by;
  one.seed = (one.seed ^ OTHER_SEED) * TWICE + turn;
  one.film = way == 0 ? NULL : t->film;
  one.gain = NULL;
  integrator by = path_integrator(&one);
  path_start starts[PIXELS];
  path_stats stats = {0};
  start_all(t, &by, starts);
  by.radiance(by.self, starts + t->from, t->pixels - t->from,
              t->colors[way][turn] + t->from, &stats,
              by.room(by.self, &scratch));
  t->rays[way][turn] += stats.rays;
  arena_free(&scratch);
}

// Half the squares of relative differences, which no bright speck can make
// larger than its pixel, times the rays.  Those between neighbours cost half as
// much as others, for nothing is shaded at their ends.
static double price(const share_trial *t, int way, double bright) {
  double sum = 0, rays = 0;
  for (size_t i = 0; i < t->pixels; i++) {
    double a = (double)light_mean(t->colors[way][0][i]);
    double b = (double)light_mean(t->colors[way][1][i]);
    sum += (a - b) * (a - b) / ((a + b) * (a + b) + bright * bright);
  }
  for (int i = 0; i < TWICE; i++)
    rays += (double)(t->rays[0][i] + t->rays[way][i]);
  return sum * rays / 2;
}

// Of two samples together.  Roots are averaged, for a lamp in the picture must
// not make all else look dark.
static double brightness(const share_trial *t) {
  double sum = 0;
  for (int way = 0; way < WAYS; way++)
    for (size_t i = 0; i < t->pixels; i++)
      for (int turn = 0; turn < TWICE; turn++)
        sum += sqrt((double)light_mean(t->colors[way][turn][i]));
  double root = sum / (WAYS * TWICE * (double)t->pixels);
  return TWICE * root * root;
}

// How much less the price is of paths that share, by so many groups.
static double gain_of(share_trial *t, int groups, pool *threads) {
  t->from = t->pixels, t->pixels = (size_t)groups * GROUP;
  pool_run(threads, (size_t)WAYS * TWICE, walk, t);
  double bright = brightness(t);
  double alone = price(t, 0, bright), together = price(t, 1, bright);
  return together > 0 ? alone / together : 0;
}

bool share_learn(const path_tracer *by, const path_film *film, pool *threads) {
  const path_world *w = by->world;
  bool chains = w->max_depth == 0 || w->max_depth > 2;
  if (!chains || w->lamps_only) return false;
  arena scratch = {0};
  share_trial *t = ARENA_NEW(&scratch, share_trial, 1);
  t->by = by, t->film = film;
  bool pays =
      gain_of(t, FEW, threads) >= HOPE && gain_of(t, GROUPS, threads) >= WORTH;
  arena_free(&scratch);
  return pays;
}
