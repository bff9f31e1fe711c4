// rays.c — ray sets: read, written, traced against the clock.

#include "rays.h"

#include "clock.h"
#include "file.h"

#include <stdlib.h>
#include <string.h>

// In the order of ray_kind.
static const char *const KIND_NAMES[RAYS_KINDS] = {
    "primary", "ao", "aod", "bounce", "random",
};

const char *rays_kind_name(ray_kind kind) {
  return KIND_NAMES[kind];
}

bool rays_kind_of(ray_kind *out, const char *name) {
  for (int k = 0; k < RAYS_KINDS; k++) {
    if (strcmp(KIND_NAMES[k], name) != 0) continue;
    *out = (ray_kind)k;
    return true;
  }
  return false;
}

// Rays that one work item traces.
enum { TRACE_CHUNK = 4096 };

// What the threads share while a set is traced.
typedef struct trace_job {
  hit *hits;
  const ray_set *set;
  tracer tree;
} trace_job;

// Rays begin..end-1, together where the tree has an answer to many at once.
static void trace_closest(const trace_job *job, size_t begin, size_t end) {
  const tracer *t = &job->tree;
  const ray *rays = job->set->rays;
  if (t->closest_many != NULL) {
    t->closest_many(t->tree, rays + begin, NULL, job->hits + begin,
                    end - begin);
    return;
  }
  for (size_t i = begin; i < end; i++) {
    job->hits[i] = (hit){.t = rays[i].tmax, .triangle = HIT_NONE};
    t->closest(t->tree, &rays[i], &job->hits[i]);
  }
}

static void trace_any(const trace_job *job, size_t begin, size_t end) {
  const tracer *t = &job->tree;
  const ray *rays = job->set->rays;
  bool blocked[TRACE_CHUNK];
  if (t->any_many != NULL)
    t->any_many(t->tree, rays + begin, blocked, end - begin);
  else
    for (size_t i = begin; i < end; i++)
      blocked[i - begin] = t->any(t->tree, &rays[i]);
  for (size_t i = begin; i < end; i++)
    job->hits[i] =
        (hit){.t = rays[i].tmax, .triangle = blocked[i - begin] ? 0 : HIT_NONE};
}

static void trace_chunk(void *context, size_t item, int worker) {
  (void)worker;
  const trace_job *job = context;
  size_t begin = item * TRACE_CHUNK, end = begin + TRACE_CHUNK;
  if (end > job->set->count) end = job->set->count;
  if (job->set->any)
    trace_any(job, begin, end);
  else
    trace_closest(job, begin, end);
}

static int by_seconds(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

double rays_trace(hit *hits, const ray_set *s, tracer tree, pool *threads,
                  int repeat) {
  trace_job job = {hits, s, tree};
  arena scratch = {0};
  size_t n = repeat > 0 ? (size_t)repeat : 0;
  double *seconds = ARENA_NEW(&scratch, double, n + 1);
  for (size_t k = 0; k < n + 1; k++) {
    double start = clock_seconds();
    pool_run(threads, (s->count + TRACE_CHUNK - 1) / TRACE_CHUNK, trace_chunk,
             &job);
    seconds[k] = clock_seconds() - start;
  }
  // The first run filled the caches; it counts only where it is alone.
  double *run = n > 0 ? seconds + 1 : seconds;
  size_t m = n > 0 ? n : 1;
  qsort(run, m, sizeof *run, by_seconds);
  double median = 0.5 * (run[(m - 1) / 2] + run[m / 2]);
  arena_free(&scratch);
  return median;
}

size_t rays_count_hits(const hit *hits, size_t n) {
  size_t count = 0;
  for (size_t i = 0; i < n; i++)
    count += hits[i].triangle != HIT_NONE;
  return count;
}

// A file of rays or hits begins with four letters, u32 flags, u64 count.
enum { HEAD_BYTES = 16, RAY_BYTES = 32, HIT_BYTES = 8, FLAG_ANY = 1 };

// Little-endian numbers, whatever the machine's order.
static void put_u32(unsigned char *to, uint32_t v) {
  for (int i = 0; i < 4; i++)
    to[i] = (unsigned char)(v >> 8 * i);
}

static uint32_t get_u32(const unsigned char *from) {
  uint32_t v = 0;
  for (int i = 0; i < 4; i++)
    v |= (uint32_t)from[i] << 8 * i;
  return v;
}

static void put_float(unsigned char *to, float f) {
  uint32_t v;
  memcpy(&v, &f, sizeof v);
  put_u32(to, v);
}

static float get_float(const unsigned char *from) {
  uint32_t v = get_u32(from);
  float f;
  memcpy(&f, &v, sizeof f);
  return f;
}

static ray get_ray(const unsigned char *b) {
  return (ray){{get_float(b), get_float(b + 4), get_float(b + 8)},
               {get_float(b + 16), get_float(b + 20), get_float(b + 24)},
               get_float(b + 12),
               get_float(b + 28)};
}

static void put_ray(unsigned char *b, const ray *r) {
  const float f[8] = {r->o.x, r->o.y, r->o.z, r->tmin,
                      r->d.x, r->d.y, r->d.z, r->tmax};
  for (int i = 0; i < 8; i++)
    put_float(b + 4 * i, f[i]);
}

static void write_head(FILE *f, const char *magic, const ray_set *s) {
  unsigned char head[HEAD_BYTES];
  memcpy(head, magic, 4);
  put_u32(head + 4, s->any ? FLAG_ANY : 0);
  put_u32(head + 8, (uint32_t)((uint64_t)s->count & UINT32_MAX));
  put_u32(head + 12, (uint32_t)((uint64_t)s->count >> 32));
  fwrite(head, 1, sizeof head, f);
}

// The count of a ray file whose length agrees with it.
static bool read_head(ray_set *s, FILE *f, const char *path, error *err) {
  unsigned char head[HEAD_BYTES];
  uint64_t left = file_left(f);
  if (fread(head, 1, sizeof head, f) != sizeof head ||
      memcmp(head, "RAYS", 4) != 0)
    return fail(err, "%s: no ray file, expected one that begins with RAYS",
                path);
  uint64_t count = get_u32(head + 8) | (uint64_t)get_u32(head + 12) << 32;
  uint64_t bytes = left - HEAD_BYTES;
  if (bytes % RAY_BYTES != 0 || bytes / RAY_BYTES != count)
    return fail(err, "%s: %llu bytes of rays, expected %llu rays of %d bytes",
                path, (unsigned long long)bytes, (unsigned long long)count,
                RAY_BYTES);
  s->count = (size_t)count;
  s->any = (get_u32(head + 4) & FLAG_ANY) != 0;
  return true;
}

bool rays_load(ray_set *out, const char *path, arena *mem, error *err) {
  ray_set s = {0};
  FILE *f = file_open(path, err);
  if (f == NULL) return false;
  bool ok = read_head(&s, f, path, err);
  if (ok) s.rays = ARENA_NEW(mem, ray, s.count);
  for (size_t i = 0; ok && i < s.count; i++) {
    unsigned char b[RAY_BYTES];
    ok = fread(b, 1, sizeof b, f) == sizeof b ||
         fail(err, "%s: cannot read ray %zu", path, i);
    if (ok) s.rays[i] = get_ray(b);
  }
  fclose(f);
  if (ok) *out = s;
  return ok;
}

bool rays_save(const ray_set *s, const char *path, error *err) {
  arena scratch = {0};
  file_writer w;
  bool ok = file_create(&w, path, &scratch, err);
  if (ok) {
    write_head(w.stream, "RAYS", s);
    for (size_t i = 0; i < s->count; i++) {
      unsigned char b[RAY_BYTES];
      put_ray(b, &s->rays[i]);
      fwrite(b, 1, sizeof b, w.stream);
    }
    ok = file_commit(&w, err);
  }
  arena_free(&scratch);
  return ok;
}

bool rays_save_hits(const ray_set *s, const hit *hits, const char *path,
                    error *err) {
  arena scratch = {0};
  file_writer w;
  bool ok = file_create(&w, path, &scratch, err);
  if (ok) {
    write_head(w.stream, "HITS", s);
    for (size_t i = 0; i < s->count; i++) {
      unsigned char b[HIT_BYTES];
      put_float(b, hits[i].t);
      put_u32(b + 4, hits[i].triangle);
      fwrite(b, 1, sizeof b, w.stream);
    }
    ok = file_commit(&w, err);
  }
  arena_free(&scratch);
  return ok;
}
