// path_aim.c

#include "path_aim.h"

#include "rng.h"
#include "tracer.h"

// An aimed ray and what follows it are no more rays than these.
enum { LONGEST = 8 };

// The numbers of an event of a way, of eight.
enum { DIRECTION = 0, SPHERE = 2, MATTER = 3, LOBE = 4, OPACITY = 5, USES = 8 };

// One way: to a mirror or glass, and on by mirrors and glass alone.
typedef struct way {
  uint32_t path;
  vec3 throughput;
  float rival;  // density by scattering over that by aiming
  sampler numbers;
  int segment, rays, inside;
} way;

struct path_aims {
  const aim_map *map;
  const path_world *world;
  way ways[INTEGRATOR_BATCH * AIM_RAYS];
  ray rays[INTEGRATOR_BATCH * AIM_RAYS];
  hit hits[INTEGRATOR_BATCH * AIM_RAYS];
  vec3 found[INTEGRATOR_BATCH];
  size_t count;
  double *gain;
};

void path_trail_turn(path_trail *t, float pdf, const ray *r, uint32_t rays) {
  t->rival = 0;
  if (t->cell == NULL || rays != t->rays + 1) return;
  t->rival = t->asked * aim_pdf(t->cell, r->o, r->d) / pdf;
}

float path_trail_weight(const path_trail *t, uint32_t rays) {
  return rays - t->rays <= LONGEST ? path_weight(t->rival) : 1;
}

path_aims *path_aims_room(arena *mem) {
  return ARENA_NEW(mem, path_aims, 1);
}

void path_aims_begin(path_aims *a, const aim_map *map, const path_world *world,
                     double *gain) {
  a->map = map;
  a->gain = gain;
  a->world = world;
  for (size_t i = 0; i < INTEGRATOR_BATCH; i++)
    a->found[i] = vec3_all(0);
}

// A ray from there by the numbers of w, if it may bring something.
static bool aim(const path_aims *a, const path_stand *s, const path_trail *t,
                way *w, ray *r) {
  const vertex *v = s->at;
  float u[USES], pdf;
  sampler_8(&w->numbers, 0, u);
  vec3 o = surface_smooth_ray(&v->at, v->ng).o;
  vec3 d = aim_sample(t->cell, o, (vec3){u[0], u[1], u[SPHERE]}, &pdf);
  pdf *= t->asked;
  vec3 wi = vertex_local(v, d), wo = vertex_local(v, v->wo);
  if (!(wi.z > 0 && pdf > 0)) return false;
  vec3 f = vec3_scale(bsdf_eval(s->bsdf, wo, wi), wi.z / pdf);
  w->throughput = vec3_mul(s->throughput, f);
  w->rival = bsdf_pdf(s->bsdf, wo, wi) / pdf;
  *r = ray_from(o, d);
  return vec3_peak(w->throughput) > 0 || a->world->thorough;
}

path_trail path_aims_ask(path_aims *a, const path_stand *s, uint32_t rays) {
  path_trail t = {.rays = rays};
  const int most = a->world->max_depth;
  if (most > 0 && s->segment + 2 > most) return t;
  t.cell = aim_at(a->map, s->at->at.p, s->at->n);
  if (t.cell == NULL) return t;
  float throughput = s->scale * vec3_peak(s->throughput);
  t.asked = aim_asked(a->map, t.cell, throughput);
  if (!(t.asked > 0)) return (path_trail){.rays = rays};
  if (a->gain != NULL)
    *a->gain += (double)aim_gain(t.cell, t.asked, throughput);
  sampler numbers = s->numbers;
  numbers.key = rng_mix(s->numbers.key + rays + 1);
  rng chance = rng_of(numbers.key, numbers.index, 0);
  for (float left = t.asked - rng_next(&chance); left > 0; left--) {
    way w = {s->path, .numbers = numbers, .segment = s->segment + 1};
    if (aim(a, s, &t, &w, &a->rays[a->count])) a->ways[a->count++] = w;
    numbers.key = rng_mix(numbers.key);
  }
  return t;
}

static void find(path_aims *a, const way *w, vec3 radiance) {
  vec3 *sum = &a->found[w->path];
  *sum =
      vec3_mad(*sum, path_weight(w->rival), vec3_mul(w->throughput, radiance));
}

// On from a mirror or glass; false where the way ends, as it does anywhere
// else.
static bool turn(const path_aims *a, way *w, vertex *v, const float *u,
                 ray *r) {
  matter m = vertex_matter(v, a->world->dfg, u[MATTER]);
  bsdf_sample d;
  if (!bsdf_is_delta(&m.bsdf)) return false;
  const int most = a->world->max_depth;
  if (most > 0 && w->segment >= most) return false;
  if (!bsdf_sample_wi(&m.bsdf, vertex_local(v, v->wo), u[LOBE], 0, 0, &d))
    return false;
  w->throughput = vec3_mul(w->throughput, vec3_mul(m.weight, d.weight));
  *r = vertex_leave(v, &m.bsdf, &d, r->d, &w->inside);
  w->segment++;
  return vec3_peak(w->throughput) > 0;
}

// What becomes of a way where its ray ends; *r is then its next one.  What the
// first ray meets must be a mirror or glass, and its own light does not count:
// others look for that.
static bool step(path_aims *a, way *w, const hit *h, ray *r) {
  const scene *s = a->world->scene;
  bool first = w->rays++ == 0;
  if (h->triangle == HIT_NONE) {
    if (!first) find(a, w, env_radiance(&s->env, vec3_unit(r->d)));
    return false;
  }
  float u[USES];
  sampler_8(&w->numbers, USES * (uint32_t)w->rays, u);
  vertex v = vertex_at(s, h, r->d);
  bool goes_on;
  if (matter_passes(&v.at) && u[OPACITY] >= matter_opacity(&v.at)) {
    goes_on = !first;
    *r = surface_ray(&v.at, r->d);
  } else {
    if (v.at.front && !first) find(a, w, matter_emission(&v.at));
    goes_on = turn(a, w, &v, u, r);
  }
  return goes_on && w->rays < LONGEST;
}

void path_aims_run(path_aims *a, path_stats *stats) {
  stats->aimed += a->count;
  while (a->count > 0) {
    tracer_closest_many(&a->world->tracer, a->rays, NULL, a->hits, a->count);
    stats->rays += a->count;
    size_t next = 0;
    for (size_t i = 0; i < a->count; i++) {
      way w = a->ways[i];
      ray r = a->rays[i];
      if (!step(a, &w, &a->hits[i], &r)) continue;
      a->ways[next] = w;
      a->rays[next++] = r;
    }
    a->count = next;
  }
}

vec3 path_aims_take(path_aims *a, size_t path) {
  vec3 sum = a->found[path];
  a->found[path] = vec3_all(0);
  return sum;
}
