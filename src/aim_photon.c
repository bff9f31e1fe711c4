// aim_photon.c

#include "aim_photon.h"

#include "light_emission.h"
#include "pick.h"
#include "rng.h"
#include "tracer.h"
#include "vertex.h"

#include <string.h>

// The most mirrors and glass on a way, and the tries of a batch.
enum { LONGEST = 6, BATCH = 1024 };

// After so many tries from somewhere it is known whether light comes down.
enum { SURE = 64 };

struct aim_mirrors {
  const path_world *world;
  const light_set *lights;
  uint32_t *triangles;
  pick by_area;
  double area;
};

// A photon on its way.
typedef struct flight {
  aim_photon at;
  ray ray;
  int inside, events;
  vec3 across;  // a normal of the triangle where it began, of any length
  rng numbers;
} flight;

// The room of one worker.
typedef struct sky {
  flight flights[BATCH];
  vertex at[BATCH];
  ray rays[BATCH];
  hit hits[BATCH];
  bool blocked[BATCH];
  light_question asked[BATCH];
  light_sample light[BATCH];
} sky;

typedef struct flight_job {
  const aim_mirrors *by;
  aim_tries tries;
  uint32_t stretches[AIM_STRETCHES], stretch_count;
  bool lit[AIM_STRETCHES][2];  // before and behind
  sky *rooms;
  aim_photon *out;  // BATCH for each item
  size_t *counts;
} flight_job;

static bool is_mirror(const scene *s, uint32_t triangle) {
  material_kind kind = s->materials[s->material_of[triangle]].kind;
  return kind == MATERIAL_MIRROR || kind == MATERIAL_GLASS;
}

static vec3 corner(const scene *s, uint32_t triangle, uint32_t k) {
  const mesh *m = &s->mesh;
  return m->positions[m->position_index[3 * (size_t)triangle + k]];
}

// Whether a chain of mirrors can end where light is.
static bool shines(const light_set *l) {
  return l->name_count > 0 || l->env.irradiance > 0;
}

const aim_mirrors *aim_mirrors_of(const path_world *world, const light_set *l,
                                  arena *mem) {
  const scene *s = world->scene;
  uint32_t all = (uint32_t)s->mesh.triangle_count, n = 0;
  if (!shines(l) || s->material_count == 0) return NULL;
  for (uint32_t i = 0; i < all; i++)
    n += is_mirror(s, i);
  if (n == 0 || n > PICK_UNITS) return NULL;
  arena scratch = {0};
  double *areas = ARENA_NEW(&scratch, double, n);
  aim_mirrors *m = ARENA_NEW(mem, aim_mirrors, 1);
  *m =
      (aim_mirrors){world, l, ARENA_NEW(mem, uint32_t, n), pick_new(mem, n), 0};
  n = 0;
  for (uint32_t i = 0; i < all; i++) {
    if (!is_mirror(s, i)) continue;
    areas[n] = (double)(float)mesh_triangle_area(&s->mesh, i);
    m->triangles[n++] = i;
  }
  pick_weigh(&m->by_area, areas, &m->area);
  arena_free(&scratch);
  return m->area > 0 && isfinite(m->area) ? m : NULL;
}

// Whether it is a mirror or glass there, and on from it if so.
typedef enum fate { FATE_ENDS, FATE_DOWN, FATE_ON } fate;

static fate turn(const path_world *w, flight *f, vertex *v) {
  matter m = vertex_matter(v, w->dfg, rng_next(&f->numbers));
  float u = rng_next(&f->numbers);
  bsdf_sample d;
  if (!bsdf_is_delta(&m.bsdf)) return FATE_DOWN;
  if (!bsdf_sample_wi(&m.bsdf, vertex_local(v, v->wo), u, 0, 0, &d))
    return FATE_ENDS;
  float share = light_mean(vec3_mul(m.weight, d.weight));
  f->at.y = v->at.p;
  f->at.power *= share;
  f->at.radiance *= share;
  f->ray = vertex_leave(v, &m.bsdf, &d, f->ray.d, &f->inside);
  return ++f->events <= LONGEST && f->at.power > 0 ? FATE_ON : FATE_ENDS;
}

// Where along the area of a try's stretches it begins, in [0, 1).
static float begin(const flight_job *job, size_t i, flight *f) {
  size_t tries = job->tries.to - job->tries.from;
  double u = ((double)i + (double)rng_next(&f->numbers)) / (double)tries;
  double at = u * job->stretch_count;
  uint32_t k = (uint32_t)at;
  if (k >= job->stretch_count) k = job->stretch_count - 1;
  f->at.stretch = job->stretches[k];
  float along = (float)((f->at.stretch + at - k) / AIM_STRETCHES);
  return float_min(along, FLOAT_BELOW_1);
}

// A point of a mirror, chosen evenly, and what it asks of the lights.
static void start(const flight_job *job, size_t i, flight *f, hit *at,
                  light_question *q) {
  const aim_mirrors *by = job->by;
  const scene *s = by->world->scene;
  *f = (flight){.numbers = rng_of(job->tries.seed, job->tries.from + i, 0)};
  rng *n = &f->numbers;
  float u = begin(job, i, f), share;
  uint32_t t = by->triangles[pick_at(&by->by_area, &u, &share)];
  *at = (hit){.b1 = rng_next(n), .b2 = rng_next(n), .triangle = t};
  if (at->b1 + at->b2 > 1) at->b1 = 1 - at->b1, at->b2 = 1 - at->b2;
  vec3 a = corner(s, t, 0), ab = vec3_sub(corner(s, t, 1), a);
  vec3 ac = vec3_sub(corner(s, t, 2), a);
  f->across = vec3_cross(ab, ac);
  q->p = vec3_mad(vec3_mad(a, at->b1, ab), at->b2, ac);
  q->n = vec3_all(0);
  q->u = (vec3){rng_next(n), rng_next(n), rng_next(n)};
}

// Light that arrives there on a lit side, if the shadow ray meets nothing.
static bool meet(const flight_job *job, const light_sample *l, const hit *at,
                 flight *f, vertex *v, ray *shadow) {
  const aim_mirrors *by = job->by;
  if (!(l->pdf > 0) || l->delta) return false;
  f->at.behind = vec3_dot(f->across, l->wi) < 0;
  if (!job->lit[f->at.stretch][f->at.behind]) return false;
  f->ray.d = vec3_neg(l->wi);
  *v = vertex_at(by->world->scene, at, f->ray.d);
  light_ray to = {.is_point = l->has_end, .to = l->to, .wi = l->wi};
  *shadow = light_ray_shadow(&to, &v->at, false);
  f->at.radiance = light_mean(l->radiance);
  f->at.power = f->at.radiance * fabsf(vec3_dot(v->ng, l->wi)) / l->pdf;
  f->at.power *= (float)by->area;
  return true;
}

// Begin the tries of an item, which ask the lights together; how many are on
// their way from the first mirror.
static size_t start_all(const flight_job *job, size_t item, sky *room) {
  const path_world *w = job->by->world;
  size_t n = 0, next = 0, all = job->tries.to - job->tries.from;
  size_t first = item * BATCH, some = all - first < BATCH ? all - first : BATCH;
  flight *f = room->flights;
  for (size_t i = 0; i < some; i++)
    start(job, first + i, &f[i], &room->hits[i], &room->asked[i]);
  light_samples_at(job->by->lights, room->asked, some, room->light);
  for (size_t i = 0; i < some; i++) {
    if (!meet(job, &room->light[i], &room->hits[i], &f[i], &room->at[n],
              &room->rays[n]))
      continue;
    f[n++] = f[i];
  }
  tracer_any_many(&w->tracer, room->rays, room->blocked, n);
  for (size_t i = 0; i < n; i++) {
    flight one = f[i];
    if (!room->blocked[i] && turn(w, &one, &room->at[i]) == FATE_ON)
      f[next++] = one;
  }
  return next;
}

static void land(flight_job *job, size_t item, flight *f, const vertex *v) {
  if (!(vec3_peak(matter_albedo(&v->at)) > 0)) return;
  f->at.x = v->at.p;
  f->at.n = v->n;
  f->at.cosine = float_max(vec3_dot(v->n, v->wo), 0);
  if (!(f->at.power < INFINITY)) return;
  job->out[item * BATCH + job->counts[item]++] = f->at;
}

static void fly(void *context, size_t item, int worker) {
  flight_job *job = context;
  const path_world *w = job->by->world;
  sky *room = &job->rooms[worker];
  size_t n = start_all(job, item, room);
  while (n > 0) {
    for (size_t i = 0; i < n; i++)
      room->rays[i] = room->flights[i].ray;
    tracer_closest_many(&w->tracer, room->rays, NULL, room->hits, n);
    size_t next = 0;
    for (size_t i = 0; i < n; i++) {
      flight f = room->flights[i];
      if (room->hits[i].triangle == HIT_NONE) continue;
      vertex v = vertex_at(w->scene, &room->hits[i], f.ray.d);
      fate what = turn(w, &f, &v);
      if (what == FATE_DOWN) land(job, item, &f, &v);
      if (what == FATE_ON) room->flights[next++] = f;
    }
    n = next;
  }
}

// Some, and after them those of a job's tries.
static aim_photons fly_all(flight_job *job, const aim_photons *before,
                           arena *mem, pool *threads) {
  arena scratch = {0};
  size_t tries = job->tries.to - job->tries.from;
  size_t items = (tries + BATCH - 1) / BATCH;
  int workers = threads == NULL ? 1 : pool_threads(threads);
  job->rooms = ARENA_NEW(&scratch, sky, (size_t)workers);
  job->counts = ARENA_NEW(&scratch, size_t, items);
  job->out = ARENA_NEW(&scratch, aim_photon, items * BATCH);
  pool_run(threads, items, fly, job);
  aim_photons all = *before;
  all.tries += (double)tries * AIM_STRETCHES / job->stretch_count;
  for (size_t i = 0; i < items; i++)
    all.count += job->counts[i];
  all.of = ARENA_NEW(mem, aim_photon, all.count);
  aim_photon *to = all.of;
  for (size_t i = 0; i < before->count; i++)
    *to++ = before->of[i];
  for (size_t i = 0; i < items; i++)
    for (size_t j = 0; j < job->counts[i]; j++)
      *to++ = job->out[i * BATCH + j];
  arena_free(&scratch);
  return all;
}

// The stretches and sides from which some photon came, or from one of as many
// side by side as make a sure answer.  Where there are none, all of them.
static void find_lit(flight_job *job, const aim_photons *first) {
  bool lit[AIM_STRETCHES][2] = {{first->count == 0, first->count == 0}};
  uint32_t beside = AIM_STRETCHES;
  if (first->count > 0 && first->tries > SURE)
    beside = (uint32_t)ceil(SURE * AIM_STRETCHES / first->tries);
  for (size_t i = 0; i < first->count; i++)
    lit[first->of[i].stretch / beside][first->of[i].behind] = true;
  for (uint32_t i = 0; i < AIM_STRETCHES; i++) {
    const bool *here = lit[i / beside];
    job->lit[i][0] = here[0], job->lit[i][1] = here[1];
    if (here[0] || here[1]) job->stretches[job->stretch_count++] = i;
  }
}

aim_photons aim_photons_more(const aim_mirrors *m, const aim_photons *first,
                             const aim_tries *t, arena *mem, pool *threads) {
  flight_job job = {.by = m, .tries = *t};
  find_lit(&job, first);
  job.tries.to =
      t->from + (t->to - t->from) * job.stretch_count / AIM_STRETCHES;
  return fly_all(&job, first, mem, threads);
}

aim_photons aim_photons_of(const aim_mirrors *m, const aim_tries *t, arena *mem,
                           pool *threads) {
  const aim_photons none = {0};
  return aim_photons_more(m, &none, t, mem, threads);
}
