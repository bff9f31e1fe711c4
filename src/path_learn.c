// path_learn.c

#include "path_learn.h"

// Other numbers than those of the picture.
#define OTHER_SEED UINT64_C(0x6c6561726e)

// What the threads share; a worker's room and a log for each batch.
typedef struct lesson_job {
  const path_tracer *by;
  const path_lesson *lesson;
  path_log *logs;
  void **rooms;
} lesson_job;

// Path i of n starts at one of the pixels, all of them in order.
static path_start start_of(const lesson_job *job, const integrator *by,
                           size_t i) {
  const path_lesson *l = job->lesson;
  uint64_t pixels = (uint64_t)l->width * (uint64_t)l->height;
  uint64_t pixel = (uint64_t)i * pixels / l->paths;
  vec2 at = by->place(by->self, i, 0);
  float x = (float)(pixel % (uint64_t)l->width) + at.x;
  float y = (float)(pixel / (uint64_t)l->width) + at.y;
  return (path_start){camera_ray(l->view, x, y), i, 0};
}

static void walk(void *context, size_t item, int worker) {
  const lesson_job *job = context;
  path_tracer one = *job->by;
  one.log = &job->logs[item];
  one.seed ^= OTHER_SEED;
  integrator by = path_integrator(&one);
  path_start starts[INTEGRATOR_BATCH];
  vec3 colors[INTEGRATOR_BATCH];
  path_stats stats = {0};
  size_t first = item * INTEGRATOR_BATCH, n = job->lesson->paths - first;
  if (n > INTEGRATOR_BATCH) n = INTEGRATOR_BATCH;
  for (size_t i = 0; i < n; i++)
    starts[i] = start_of(job, &by, first + i);
  by.radiance(by.self, starts, n, colors, &stats, job->rooms[worker]);
}

static light_record *join(path_log *logs, size_t n, arena *mem, size_t *count) {
  *count = 0;
  for (size_t i = 0; i < n; i++)
    *count += logs[i].count;
  light_record *all = ARENA_NEW(mem, light_record, *count), *at = all;
  for (size_t i = 0; i < n; i++) {
    for (size_t k = 0; k < logs[i].count; k++)
      *at++ = logs[i].items[k];
    array_free(logs[i].items);
  }
  return all;
}

bool path_learn(light_set *lights, const path_tracer *by,
                const path_lesson *lesson, arena *mem, pool *threads) {
  const mesh *m = &lights->scene->mesh;
  vec3 lo = vec3_all(INFINITY), hi = vec3_all(-INFINITY);
  for (size_t i = 0; i < m->position_count; i++) {
    lo = vec3_min(lo, m->positions[i]);
    hi = vec3_max(hi, m->positions[i]);
  }
  light_memory *memory = ARENA_NEW(mem, light_memory, 1);
  if (!light_memory_new(memory, &lights->near, lo, hi, mem)) return false;
  lights->memory = memory;
  arena scratch = {0};
  size_t batches = (lesson->paths + INTEGRATOR_BATCH - 1) / INTEGRATOR_BATCH;
  int workers = threads == NULL ? 1 : pool_threads(threads);
  lesson_job job = {by, lesson, ARENA_NEW(&scratch, path_log, batches),
                    ARENA_NEW(&scratch, void *, (size_t)workers)};
  integrator walker = path_integrator(by);
  for (int i = 0; i < workers; i++)
    job.rooms[i] = walker.room(walker.self, &scratch);
  pool_run(threads, batches, walk, &job);
  size_t count;
  light_record *records = join(job.logs, batches, &scratch, &count);
  light_memory_learn(memory, records, count, mem);
  arena_free(&scratch);
  return true;
}
