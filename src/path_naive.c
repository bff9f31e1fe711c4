// path_naive.c

#include "path_naive.h"

// A path whose throughput falls below this plays roulette for it.
#define ROULETTE_BELOW 0.25f

// From this segment on even a path that lost nothing is ended with probability
// 1 - LOSSLESS_SURVIVAL, so that mirrors facing each other end.
enum { LOSSLESS_FROM = 4096 };
#define LOSSLESS_SURVIVAL 0.999f

// Reversible optics let no light into glass that cannot get out again, but
// interpolated normals do: after this many reflections inside, one after the
// other, it goes straight out.
enum { TRAPPED_AFTER = 256 };

// The most rays of a path.  Unreachable by the roulette above (e^-99), except
// through sheets that let light straight through, which do not play.
enum { PATH_MAX_RAYS = 100000 };

// The most sheets a shadow ray looks through.
enum { SHADOW_MAX_SHEETS = 1000 };

// A path on its way: what it has gathered, and what the rest still counts.
typedef struct walk {
  const path_world *world;
  rng *random;
  path_stats *stats;
  ray ray;
  vec3 sum, throughput;
  int inside;  // reflections inside glass since the last other event
} walk;

// A hit seen from where the ray came from: unit wo, the two normals turned to
// that side, and the frame about the normal n that scatters.
typedef struct stop {
  surface at;
  vec3 wo, ng, ns;
  vec3 n, t, b;
} stop;

static bool closest(const walk *k, const ray *r, hit *h) {
  k->stats->rays++;
  return k->world->tracer.closest(k->world->tracer.tree, r, h);
}

static vec3 to_local(const stop *s, vec3 w) {
  return (vec3){vec3_dot(w, s->t), vec3_dot(w, s->b), vec3_dot(w, s->n)};
}

static vec3 to_world(const stop *s, vec3 w) {
  vec3 v = vec3_scale(s->t, w.x);
  return vec3_unit(vec3_mad(vec3_mad(v, w.y, s->b), w.z, s->n));
}

static stop stop_at(const walk *k, const hit *h) {
  const scene *world = k->world->scene;
  stop s = {.at = surface_at(world, h, k->ray.d)};
  s.wo = vec3_unit(vec3_neg(k->ray.d));
  s.ns = surface_mapped_normal(world, &s.at, h);
  s.ng = s.at.ng;
  if (!s.at.front) {
    s.ng = vec3_neg(s.ng);
    s.ns = vec3_neg(s.ns);
  }
  return s;
}

// The normal for b: mirrors and glass want one whose directions lie on the
// right sides of the facet, others one that faces the viewer.
static void stop_orient(stop *s, const bsdf *b) {
  switch (b->kind) {
  case BSDF_MIRROR: s->n = surface_bend(s->ns, s->ng, s->wo); break;
  case BSDF_GLASS:
    s->n = surface_bend_glass(s->ns, s->ng, s->wo, b->eta);
    break;
  case BSDF_LAMBERT:
  case BSDF_BLINN_PHONG:
  case BSDF_ROUGH: s->n = surface_face(s->ns, s->wo); break;
  }
  bsdf_basis(s->n, &s->t, &s->b);
}

// What one shadow ray is about: the direction to the light, the light on a
// facing plane, and for a point light where it is.
typedef struct light_ray {
  bool is_point;
  vec3 to, wi, power;
} light_ray;

static light_ray light_ray_of(const light *l, vec3 p) {
  if (l->kind == LIGHT_DIR)
    return (light_ray){.wi = vec3_unit(vec3_neg(l->at)), .power = l->power};
  vec3 d = vec3_sub(l->at, p);
  float r2 = vec3_dot(d, d);
  vec3 power = r2 > 0 ? vec3_scale(l->power, 1 / r2) : vec3_all(0);
  return (light_ray){true, l->at, vec3_unit(d), power};
}

static ray shadow_ray(const surface *from, const light_ray *l, bool smooth) {
  if (l->is_point) return surface_ray_to(from, l->to, smooth);
  return smooth ? surface_smooth_ray(from, l->wi) : surface_ray(from, l->wi);
}

static bool any_sheets(const scene *s) {
  for (size_t i = 0; i < s->material_count; i++)
    if (s->materials[i].passes) return true;
  return false;
}

// The share of light that reaches the surface: 0 or 1, or what the sheets in
// between let through.  They are looked up only when something is in between.
static float light_passes(const walk *k, const surface *from,
                          const light_ray *l) {
  const path_world *w = k->world;
  ray r = shadow_ray(from, l, true);
  k->stats->rays++;
  if (!w->tracer.any(w->tracer.tree, &r)) return 1;
  if (!any_sheets(w->scene)) return 0;
  float share = 1;
  hit h;
  for (int i = 0; i < SHADOW_MAX_SHEETS && closest(k, &r, &h); i++) {
    surface s = surface_at(w->scene, &h, r.d);
    if (!matter_passes(&s)) return 0;
    share *= 1 - matter_opacity(&s);
    if (!(share > 0)) return 0;
    r = shadow_ray(&s, l, false);
  }
  return share;
}

// What the point and directional lights add at s.
static void add_lights(walk *k, const stop *s, const bsdf *b) {
  const scene *world = k->world->scene;
  vec3 wo = to_local(s, s->wo);
  for (size_t i = 0; i < world->light_count; i++) {
    light_ray l = light_ray_of(&world->lights[i], s->at.p);
    vec3 wi = to_local(s, l.wi);
    if (!(wi.z > 0)) continue;
    vec3 f = vec3_scale(bsdf_eval_point(b, wo, wi), wi.z);
    vec3 lit = vec3_mul(k->throughput, vec3_mul(f, l.power));
    if (!(vec3_peak(lit) > 0)) continue;
    k->sum = vec3_mad(k->sum, light_passes(k, &s->at, &l), lit);
  }
}

// Go on in a direction sampled from b; false where nothing is scattered.
static bool scatter(walk *k, const stop *s, const bsdf *b) {
  float u = rng_next(k->random), u1 = rng_next(k->random);
  float u2 = rng_next(k->random);
  bsdf_sample d;
  if (!bsdf_sample_wi(b, to_local(s, s->wo), u, u1, u2, &d)) return false;
  vec3 wi = to_world(s, d.wi);
  k->throughput = vec3_mul(k->throughput, d.weight);
  bool held = b->kind == BSDF_GLASS && !s->at.front && !d.transmitted;
  k->inside = held ? k->inside + 1 : 0;
  if (k->inside > TRAPPED_AFTER && s->at.smooth)
    k->ray = surface_ray(&s->at, k->ray.d);
  else if (d.delta)
    k->ray = surface_ray(&s->at, surface_keep_side(&s->at, wi, d.transmitted));
  else
    k->ray = surface_smooth_ray(&s->at, wi);
  return vec3_peak(k->throughput) > 0;
}

// Russian roulette: a path of little throughput ends with a probability, and
// the survivors stand for the ended ones.
static bool survives(walk *k, int segment) {
  float q = vec3_peak(k->throughput) / ROULETTE_BELOW;
  q = fminf(q, segment < LOSSLESS_FROM ? 1 : LOSSLESS_SURVIVAL);
  if (q >= 1) return true;
  if (rng_next(k->random) >= q) return false;
  k->throughput = vec3_scale(k->throughput, 1 / q);
  return true;
}

// One bounce at the hit; false where the path ends.
static bool bounce(walk *k, stop *s) {
  float cos_o = fminf(fmaxf(vec3_dot(s->ns, s->wo), 0), 1);
  float u = rng_next(k->random);
  matter m = matter_choose(k->world->dfg, &s->at, cos_o, u);
  k->throughput = vec3_mul(k->throughput, m.weight);
  if (!s->at.front && m.bsdf.kind == BSDF_GLASS) m.bsdf.eta = 1 / m.bsdf.eta;
  stop_orient(s, &m.bsdf);
  if (k->world->lights && !bsdf_is_delta(&m.bsdf)) add_lights(k, s, &m.bsdf);
  return scatter(k, s, &m.bsdf);
}

// Whether the ray goes straight through the surface, by chance 1 - opacity.
static bool goes_through(walk *k, const stop *s) {
  return matter_passes(&s->at) && rng_next(k->random) >= matter_opacity(&s->at);
}

vec3 path_naive_radiance(const path_world *w, ray r, rng *random,
                         path_stats *stats) {
  walk k = {w, random, stats, r, vec3_all(0), vec3_all(1), 0};
  int segment = 1;
  for (int rays = 0; rays < PATH_MAX_RAYS; rays++) {
    hit h;
    if (!closest(&k, &k.ray, &h)) {
      vec3 sky = env_radiance(&w->scene->env, vec3_unit(k.ray.d));
      return vec3_add(k.sum, vec3_mul(k.throughput, sky));
    }
    stop s = stop_at(&k, &h);
    if (goes_through(&k, &s)) {
      k.ray = surface_ray(&s.at, k.ray.d);
      continue;
    }
    if (s.at.front) {
      vec3 glow = matter_emission(&s.at);
      k.sum = vec3_add(k.sum, vec3_mul(k.throughput, glow));
    }
    if (w->max_depth > 0 && segment >= w->max_depth) return k.sum;
    if (!bounce(&k, &s) || !survives(&k, segment)) return k.sum;
    segment++;
  }
  stats->cut++;
  return k.sum;
}
