// path_naive.c

#include "path_naive.h"

#include "roulette.h"
#include "vertex.h"

// A path on its way: what it has gathered, and what the rest still counts.
typedef struct walk {
  const path_world *world;
  rng *random;
  path_stats *stats;
  ray ray;
  vec3 sum, throughput;
  int inside;  // reflections inside glass since the last other event
} walk;

static bool closest(const walk *k, const ray *r, hit *h) {
  k->stats->rays++;
  return k->world->tracer.closest(k->world->tracer.tree, r, h);
}

// The share of light that reaches the surface: 0 or 1, or what the sheets in
// between let through.  They are looked up only when something is in between.
static float light_passes(const walk *k, const surface *from,
                          const light_ray *l) {
  const path_world *w = k->world;
  ray r = light_ray_shadow(l, from, true);
  k->stats->rays++;
  if (!w->tracer.any(w->tracer.tree, &r)) return 1;
  if (!scene_has_sheets(w->scene)) return 0;
  return light_ray_through(l, w, from, k->stats);
}

// What the point and directional lights add at v.
static void add_lights(walk *k, const vertex *v, const bsdf *b) {
  const scene *world = k->world->scene;
  vec3 wo = vertex_local(v, v->wo);
  for (size_t i = 0; i < world->light_count; i++) {
    light_ray l = light_ray_of(&world->lights[i], v->at.p);
    vec3 wi = vertex_local(v, l.wi);
    if (!(wi.z > 0)) continue;
    vec3 f = vec3_scale(bsdf_eval_point(b, wo, wi), wi.z);
    vec3 lit = vec3_mul(k->throughput, vec3_mul(f, l.power));
    if (!(vec3_peak(lit) > 0)) continue;
    k->sum = vec3_mad(k->sum, light_passes(k, &v->at, &l), lit);
  }
}

// Go on in a direction sampled from b; false where nothing is scattered.
static bool scatter(walk *k, const vertex *v, const bsdf *b) {
  float u = rng_next(k->random), u1 = rng_next(k->random);
  float u2 = rng_next(k->random);
  bsdf_sample d;
  if (!bsdf_sample_wi(b, vertex_local(v, v->wo), u, u1, u2, &d)) return false;
  k->throughput = vec3_mul(k->throughput, d.weight);
  k->ray = vertex_leave(v, b, &d, k->ray.d, &k->inside);
  return vec3_peak(k->throughput) > 0;
}

// Russian roulette: a path of little throughput ends with a probability, and
// the survivors stand for the ended ones.
static bool survives(walk *k, int segment) {
  float q = roulette_odds(k->throughput, segment);
  if (q >= 1) return true;
  if (rng_next(k->random) >= q) return false;
  k->throughput = vec3_scale(k->throughput, 1 / q);
  return true;
}

// One bounce at the hit; false where the path ends.
static bool bounce(walk *k, vertex *v, int segment) {
  matter m = vertex_matter(v, k->world->dfg, rng_next(k->random));
  k->throughput = vec3_mul(k->throughput, m.weight);
  if (k->world->lights && !bsdf_is_delta(&m.bsdf)) add_lights(k, v, &m.bsdf);
  if (k->world->lamps_only && segment + 1 == k->world->max_depth) return false;
  return scatter(k, v, &m.bsdf);
}

// Whether the ray goes straight through the surface, by chance 1 - opacity.
static bool goes_through(walk *k, const vertex *v) {
  return matter_passes(&v->at) && rng_next(k->random) >= matter_opacity(&v->at);
}

vec3 path_naive_radiance(const path_world *w, ray r, rng *random,
                         path_stats *stats) {
  walk k = {w, random, stats, r, vec3_all(0), vec3_all(1), 0};
  int segment = 1;
  for (int rays = 0; rays < ROULETTE_MAX_RAYS; rays++) {
    hit h;
    if (!closest(&k, &k.ray, &h)) {
      vec3 sky = env_radiance(&w->scene->env, vec3_unit(k.ray.d));
      return vec3_add(k.sum, vec3_mul(k.throughput, sky));
    }
    vertex v = vertex_at(w->scene, &h, k.ray.d);
    if (goes_through(&k, &v)) {
      k.ray = surface_ray(&v.at, k.ray.d);
      continue;
    }
    if (v.at.front) {
      vec3 glow = matter_emission(&v.at);
      k.sum = vec3_add(k.sum, vec3_mul(k.throughput, glow));
    }
    if (w->max_depth > 0 && segment >= w->max_depth) return k.sum;
    if (!bounce(&k, &v, segment) || !survives(&k, segment)) return k.sum;
    segment++;
  }
  stats->cut++;
  return k.sum;
}

// The first two numbers of a stream place the sample in its pixel.
static vec2 naive_place(const void *self, uint64_t pixel, uint32_t sample) {
  const path_naive *p = self;
  rng random = rng_of(p->seed, pixel, sample);
  float x = rng_next(&random), y = rng_next(&random);
  return (vec2){x, y};
}

static void naive_radiance(const void *self, const path_start *starts, size_t n,
                           vec3 *out, path_stats *stats, void *room) {
  (void)room;
  const path_naive *p = self;
  stats->followed += n;
  for (size_t i = 0; i < n; i++) {
    rng random = rng_of(p->seed, starts[i].pixel, starts[i].sample);
    random.dimension = 2;
    out[i] = path_naive_radiance(p->world, starts[i].ray, &random, stats);
  }
}

static void *naive_room(const void *self, arena *mem) {
  (void)self;
  (void)mem;
  return NULL;
}

integrator path_naive_integrator(const path_naive *p) {
  return (integrator){p, naive_place, naive_room, naive_radiance, NULL};
}
