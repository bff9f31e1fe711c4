// path_learn.c

#include "path_learn.h"

#include <string.h>

// Other numbers than those of the picture.
#define OTHER_SEED UINT64_C(0x6c6561726e)

// A path for so many pixels at most, but no more than so many paths; and so
// many questions at each of its vertices.
enum { PIXELS_PER_PATH = 8, MOST_PATHS = 3 << 15, QUESTIONS = 8 };

// Paths of an item of work: few, so that all threads have some of a trial.
enum { CLASS = 256 };

// Of ROUNDS, the first is a trial: others follow if the gain by then is WORTH.
// ENOUGH of them will do unless the gain has grown by GROWN since.
enum { ROUNDS = 12, ENOUGH = 8 };
#define WORTH 1.16
#define GROWN 1.4

// From fewer questions nothing is learned.
enum { LEAST_RECORDS = 1000 };

// What the threads share: a worker's room and a log for each batch.
typedef struct school_job {
  const path_tracer *by;
  const path_film *lesson;
  path_log *logs, all;
  void **rooms;  // NULL: not yet made
  arena *mem;    // for them
  pool *threads;
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

// Every round looks at all of the picture.
static uint64_t dealt(uint64_t i, uint64_t paths) {
  uint64_t round = paths / ROUNDS;
  return i % round * ROUNDS + i / round;
}

static void walk(void *context, size_t item, int worker) {
  const school_job *job = context;
  path_tracer one = *job->by;
  one.log = &job->logs[item];
  one.seed ^= OTHER_SEED;
  integrator by = path_integrator(&one);
  path_start starts[CLASS];
  vec3 colors[CLASS];
  path_stats stats = {0};
  size_t first = job->from + item * CLASS, n = job->to - first;
  if (n > CLASS) n = CLASS;
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
static void hold_lesson(school_job *job, size_t to) {
  arena scratch = {0};
  job->to = to;
  size_t n = (to - job->from + CLASS - 1) / CLASS;
  job->logs = ARENA_NEW(&scratch, path_log, n);
  pool_run(job->threads, n, walk, job);
  join(&job->all, job->logs, n);
  job->from = to;
  arena_free(&scratch);
}

static void make_rooms(school_job *job) {
  if (job->rooms != NULL) return;
  int n = job->threads == NULL ? 1 : pool_threads(job->threads);
  integrator by = path_integrator(job->by);
  job->rooms = ARENA_NEW(job->mem, void *, (size_t)n);
  for (int i = 0; i < n; i++)
    job->rooms[i] = by.room(by.self, job->mem);
}

// What so many rounds have taught, and what that gains.
static double learn(school_job *job, size_t rounds, light_memory *out,
                    arena *mem) {
  hold_lesson(job, job->paths / ROUNDS * rounds);
  *out = *job->by->lights->memory;
  return light_memory_learn(out, job->all.items, job->all.count, mem,
                            job->threads);
}

// Whether a memory pays; then it is what the lesson has taught.
static bool learn_all(school_job *job, light_memory *out, arena *mem) {
  arena scratch = {0};
  double trial = learn(job, 1, out, &scratch);
  arena_free(&scratch);
  if (trial < WORTH || job->all.count < LEAST_RECORDS) return false;
  double gain = learn(job, ENOUGH, out, mem);
  if (gain >= GROWN * trial) learn(job, ROUNDS, out, mem);
  return true;
}

// One lesson, for a memory that has learned nothing.
static bool study(light_set *lights, light_memory *memory, school_job *job,
                  arena *mem) {
  if (memory == NULL) return false;
  make_rooms(job);
  light_memory learned;
  lights->memory = memory;
  job->from = 0;
  job->all = (path_log){0};
  bool pays = learn_all(job, &learned, mem);
  if (pays) *memory = learned;
  lights->memory = pays ? memory : NULL;
  array_free(job->all.items);
  return pays;
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
  school_job job = {
      .by = &pupil, .lesson = lesson, .mem = &scratch, .threads = threads};
  job.paths = (size_t)lesson->width * (size_t)lesson->height / PIXELS_PER_PATH;
  if (job.paths > MOST_PATHS) job.paths = MOST_PATHS;
  job.paths -= job.paths % ROUNDS;
  light_memory *near = light_set_cut(lights, lo, hi, mem);
  bool learned = study(lights, near, &job, mem);
  if (!learned) {
    light_memory *sky = light_set_cut_sky(lights, lo, hi, mem, threads);
    learned = study(lights, sky, &job, mem);
  }
  arena_free(&scratch);
  return learned;
}
