// aim_learn.c

#include "aim_learn.h"

#include "aim_build.h"
#include "light_emission.h"

// Other numbers than those of the picture and of path_learn.
#define OTHER_SEED UINT64_C(0x61696d)

// Photons tried for each pixel, but no more than so many; and how many of those
// that are tried first must come down.
enum { PHOTONS_PER_PIXEL = 2, MOST_PHOTONS = 1 << 18, LEAST_PHOTONS = 64 };

// The share that is tried first where there are enough, and else.
enum { FIRST_SHARE = 16, FIRST_OF_FEW = 8, ENOUGH = 9000 };

// Batches of paths that look how bright the picture is, and what it would gain.
enum { LOOKS = 2 };

// The share of the square of the brightness of a picture by which the mean
// square of its samples must shrink.
#define WORTH 0.02

// What a ray costs: the variance that one more must take away is so many times
// the square of the brightness of the picture.
#define PRICE 5.0f

typedef struct look_job {
  const path_tracer *by;
  const path_film *lesson;
  void *rooms[LOOKS];
  double roots[LOOKS], gains[LOOKS];
} look_job;

// Paths evenly over the film.
static void look(void *context, size_t item, int worker) {
  (void)worker;
  look_job *job = context;
  path_tracer one = *job->by;
  one.seed ^= OTHER_SEED;
  one.gain = &job->gains[item];
  integrator by = path_integrator(&one);
  path_start starts[INTEGRATOR_BATCH];
  vec3 colors[INTEGRATOR_BATCH];
  path_stats stats = {0};
  for (size_t i = 0; i < INTEGRATOR_BATCH; i++)
    starts[i] = path_learn_start(job->lesson, &by, item * INTEGRATOR_BATCH + i,
                                 LOOKS * INTEGRATOR_BATCH);
  by.radiance(by.self, starts, INTEGRATOR_BATCH, colors, &stats,
              job->rooms[item]);
  for (size_t i = 0; i < INTEGRATOR_BATCH; i++)
    job->roots[item] += sqrt((double)light_mean(colors[i]));
}

// The brightness, by the mean of roots, which a few bright samples do not
// change; and what aimed rays take away from the mean square of a sample.
typedef struct sight {
  double brightness, gain;
} sight;

static sight look_around(const path_tracer *by, const path_film *lesson,
                         pool *threads) {
  arena scratch = {0};
  look_job job = {.by = by, .lesson = lesson};
  integrator all = path_integrator(by);
  for (int i = 0; i < LOOKS; i++)
    job.rooms[i] = all.room(all.self, &scratch);
  pool_run(threads, LOOKS, look, &job);
  sight s = {0, 0};
  for (int i = 0; i < LOOKS; i++) {
    s.brightness += job.roots[i] / (LOOKS * INTEGRATOR_BATCH);
    s.gain += job.gains[i] / (LOOKS * INTEGRATOR_BATCH);
  }
  s.brightness *= s.brightness;
  arena_free(&scratch);
  return s;
}

typedef struct study {
  const path_tracer *by;
  const path_film *lesson;
  const aim_mirrors *mirrors;
  double brightness;
  pool *threads;
} study;

static size_t first_of(size_t tries) {
  size_t few = tries / FIRST_OF_FEW;
  if (few > ENOUGH) few = ENOUGH;
  return tries / FIRST_SHARE > few ? tries / FIRST_SHARE : few;
}

static aim_map *map_of(const study *s, const aim_photons *photons, arena *mem) {
  const scene *of = s->by->world->scene;
  aim_map *m = ARENA_NEW(mem, aim_map, 1);
  aim_build(m, photons, of->lo, of->hi, mem);
  m->keen = 1 / (sqrtf(PRICE) * (float)s->brightness);
  return m;
}

static bool pays(const study *s, const aim_map *map) {
  path_tracer by = *s->by;
  by.aim = map;
  double gain = look_around(&by, s->lesson, s->threads).gain;
  return gain >= WORTH * s->brightness * s->brightness;
}

// What so many tries teach; NULL where it would not pay.
static const aim_map *study_all(const study *s, size_t tries, arena *mem,
                                arena *scratch) {
  const uint64_t seed = s->by->seed ^ OTHER_SEED;
  const size_t few = first_of(tries);
  const aim_tries first = {seed, 0, few}, rest = {seed, few, tries};
  aim_photons all = aim_photons_of(s->mirrors, &first, scratch, s->threads);
  if (all.count < LEAST_PHOTONS) return NULL;
  if (!pays(s, map_of(s, &all, scratch))) return NULL;
  all = aim_photons_more(s->mirrors, &all, &rest, scratch, s->threads);
  return map_of(s, &all, mem);
}

const aim_map *aim_learn(const path_tracer *by, const path_film *lesson,
                         arena *mem, pool *threads) {
  const path_world *w = by->world;
  bool chains = w->max_depth == 0 || w->max_depth > 2;
  if (!chains || w->lamps_only) return NULL;
  arena scratch = {0};
  study s = {.by = by, .lesson = lesson, .threads = threads};
  s.mirrors = aim_mirrors_of(w, by->lights, &scratch);
  if (s.mirrors != NULL)
    s.brightness = look_around(by, lesson, threads).brightness;
  size_t n = (size_t)lesson->width * (size_t)lesson->height;
  n = n < MOST_PHOTONS / PHOTONS_PER_PIXEL ? n * PHOTONS_PER_PIXEL
                                           : MOST_PHOTONS;
  const aim_map *map = NULL;
  if (s.brightness > 0) map = study_all(&s, n, mem, &scratch);
  arena_free(&scratch);
  return map;
}
