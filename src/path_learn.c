// path_learn.c

#include "path_learn.h"

#include <string.h>

// Other numbers than those of the picture.
#define OTHER_SEED UINT64_C(0x6c6561726e)

// A path for so many pixels, but no more than so many paths; and so many
// questions at each of its vertices.
enum { PIXELS_PER_PATH = 4, MOST_PATHS = 1 << 16, QUESTIONS = 8 };

// The lesson goes on after one path of FIRST_SHARE only if the gain by then is
// WORTH, and after one of TRIAL_SHARE only if there is HOPE.
enum { FIRST_SHARE = 6, TRIAL_SHARE = 24 };
#define WORTH 1.17
#define HOPE 1.09

// From fewer questions nothing is learned.
enum { LEAST_RECORDS = 1000 };

// What the threads share: a worker's room and a log for each batch.
typedef struct school_job {
  const path_tracer *by;
  const path_film *lesson;
  path_log *logs;
  void **rooms;            // NULL: not yet made
  arena *mem;              // for them
  size_t paths, from, to;  // all of them; those of this lesson
} school_job;

path_start path_learn_start(const path_film *l, const integrator *by,
                            uint64_t i, uint64_t paths) {
  uint64_t pixels = (uint64_t)l->width * (uint64_t)l->height;
  uint64_t pixel = i * pixels / paths;
  vec2 at = by->place(by->self, i, 0);
  float x = (float)(pixel % (uint64_t)l->width) + at.x;
  float y = (float)(pixel / (uint64_t)l->width) + at.y;
  return (path_start){camera_ray(l->view, x, y), i, 0};
}

// Every part of the lesson looks at all of the picture: paths are dealt out in
// TRIAL_SHARE rounds.
static uint64_t dealt(uint64_t i, uint64_t paths) {
  uint64_t round = paths / TRIAL_SHARE;
  return i % round * TRIAL_SHARE + i / round;
}

static void walk(void *context, size_t item, int worker) {
  const school_job *job = context;
  path_tracer one = *job->by;
  one.log = &job->logs[item];
  one.seed ^= OTHER_SEED;
  integrator by = path_integrator(&one);
  path_start starts[INTEGRATOR_BATCH];
  vec3 colors[INTEGRATOR_BATCH];
  path_stats stats = {0};
  size_t first = job->from + item * INTEGRATOR_BATCH, n = job->to - first;
  if (n > INTEGRATOR_BATCH) n = INTEGRATOR_BATCH;
  for (size_t i = 0; i < n; i++)
    starts[i] = path_learn_start(job->lesson, &by, dealt(first + i, job->paths),
                                 job->paths);
  by.radiance(by.self, starts, n, colors, &stats, job->rooms[worker]);
}

// One log of all.
static void join(path_log *all, const path_log *logs, size_t n) {
  for (size_t i = 0; i < n; i++) {
    size_t count = logs[i].count;
    all->items = array_grow(all->items, &all->room, all->count + count,
                            sizeof *all->items);
    if (count > 0)
      memcpy(all->items + all->count, logs[i].items,
             count * sizeof *all->items);
    all->count += count;
    array_free(logs[i].items);
  }
}

// The next paths, up to number `to`.
static void hold_lesson(school_job *job, size_t to, path_log *all,
                        pool *threads) {
  arena scratch = {0};
  job->to = to;
  size_t n = (to - job->from + INTEGRATOR_BATCH - 1) / INTEGRATOR_BATCH;
  job->logs = ARENA_NEW(&scratch, path_log, n);
  pool_run(threads, n, walk, job);
  join(all, job->logs, n);
  job->from = to;
  arena_free(&scratch);
}

static void make_rooms(school_job *job, const pool *threads) {
  if (job->rooms != NULL) return;
  int n = threads == NULL ? 1 : pool_threads(threads);
  integrator by = path_integrator(job->by);
  job->rooms = ARENA_NEW(job->mem, void *, (size_t)n);
  for (int i = 0; i < n; i++)
    job->rooms[i] = by.room(by.self, job->mem);
}

// What a memory would be worth by the paths up to number `to`.
static double gain_of(school_job *job, size_t to, path_log *all,
                      pool *threads) {
  arena scratch = {0};
  hold_lesson(job, to, all, threads);
  light_memory first = *job->by->lights->memory;
  double gain = light_memory_learn(&first, all->items, all->count, &scratch);
  arena_free(&scratch);
  return gain;
}

static bool pays(school_job *job, path_log *all, pool *threads) {
  double gain = gain_of(job, job->paths / TRIAL_SHARE, all, threads);
  if (gain < HOPE && all->count >= LEAST_RECORDS) return false;
  gain = gain_of(job, job->paths / FIRST_SHARE, all, threads);
  return gain >= WORTH && all->count >= LEAST_RECORDS;
}

// One lesson, for a memory that has learned nothing.
static bool study(light_set *lights, light_memory *memory, school_job *job,
                  arena *mem, pool *threads) {
  if (memory == NULL) return false;
  make_rooms(job, threads);
  path_log all = {0};
  lights->memory = memory;
  job->from = 0;
  if (pays(job, &all, threads)) {
    hold_lesson(job, job->paths, &all, threads);
    light_memory_learn(memory, all.items, all.count, mem);
  } else {
    lights->memory = NULL;
  }
  array_free(all.items);
  return lights->memory != NULL;
}

bool path_learn(light_set *lights, const path_tracer *by,
                const path_film *lesson, arena *mem, pool *threads) {
  const mesh *m = &lights->scene->mesh;
  vec3 lo = vec3_all(INFINITY), hi = vec3_all(-INFINITY);
  for (size_t i = 0; i < m->position_count; i++) {
    lo = vec3_min(lo, m->positions[i]);
    hi = vec3_max(hi, m->positions[i]);
  }
  arena scratch = {0};
  path_tracer pupil = *by;
  pupil.questions = QUESTIONS;
  school_job job = {.by = &pupil, .lesson = lesson, .mem = &scratch};
  job.paths = (size_t)lesson->width * (size_t)lesson->height / PIXELS_PER_PATH;
  if (job.paths > MOST_PATHS) job.paths = MOST_PATHS;
  job.paths -= job.paths % TRIAL_SHARE;
  light_memory *near = light_set_cut(lights, lo, hi, mem);
  bool learned = study(lights, near, &job, mem, threads);
  if (!learned) {
    light_memory *sky = light_set_cut_sky(lights, lo, hi, mem, threads);
    learned = study(lights, sky, &job, mem, threads);
  }
  arena_free(&scratch);
  return learned;
}
