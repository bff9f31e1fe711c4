// path.c — the trick: paths go in waves.  All paths of a batch take one step
// together: their rays are traced at once, then all are shaded, then all
// shadow rays are traced at once.  A path is still a function of its pixel and
// sample alone, so nobody can tell from the picture.

#include "path.h"

#include "roulette.h"
#include "tracer.h"
#include "vertex.h"

// A path between two waves.
typedef struct path {
  sampler numbers;
  vec3 sum, throughput;
  vec3 from, from_n;  // where the last direction was sampled, and the normal
  float pdf;          // of that direction; 0 where only a delta could give it
  int segment, inside;
  path_trail trail;
} path;

// Rays that have met a surface, and where: few enough for the fastest cache.
enum { MET = 64 };

typedef struct met {
  uint32_t which[MET];
  ray rays[MET];
  hit hits[MET];
  sampler numbers[MET];
  vertex at[MET];
  path_ready ready[MET / LANES];
} met;

// A light sample on its way through the scene: what it brings if nothing is in
// between, to which path; and for sheets, from where to where.
typedef struct shadow {
  uint32_t path;
  vec3 lit;
  light_ray to;
  surface from;
  size_t record;  // in the log; PATH_NO_RECORD: none
} shadow;

// The room of one worker: paths, those still on their way with their rays, and
// the light samples of this wave.
typedef struct wave {
  const path_tracer *by;
  path_stats *stats;
  bool sheets, lights;  // whether there are any
  bool lit;             // whether ready knows of lights
  bool even;            // whether the sky is, and found by chance alone
  vec3 sky;
  path *paths;
  uint32_t *alive;
  ray *rays, *shadow_rays;
  hit *hits;
  shadow *shadows;
  bool *blocked;
  met *met;
  path_aims *aims;  // NULL: no ray is aimed
  size_t count, next, shadow_count;
  uint32_t steps;  // the rays of each path so far
} wave;

// The weight of a sample of density a where the other way to find it has
// density b.
static float power_weight(float a, float b) {
  return b > 0 ? path_weight(b / a) : 1;
}

static void add(path *p, float weight, vec3 radiance) {
  p->sum = vec3_mad(p->sum, weight, vec3_mul(p->throughput, radiance));
}

// The sky, found by a direction.
static void meet_sky(const wave *w, path *p, const ray *r) {
  float weight = p->pdf > 0 ? 1 : path_trail_weight(&p->trail, w->steps);
  if (w->even) {
    if (vec3_finite(r->d)) add(p, weight, w->sky);
    return;
  }
  vec3 d = vec3_unit(r->d);
  vec3 sky = env_radiance(&w->by->world->scene->env, d);
  if (!(vec3_peak(sky) > 0)) return;
  if (p->pdf > 0)
    weight = power_weight(p->pdf,
                          light_pdf_env(w->by->lights, p->from, p->from_n, d));
  add(p, weight, sky);
}

// A glowing surface, found by a direction.
static void meet_glow(const wave *w, path *p, const vertex *v) {
  vec3 glow = matter_emission(&v->at);
  if (!(vec3_peak(glow) > 0)) return;
  float weight = path_trail_weight(&p->trail, w->steps);
  if (p->pdf > 0)
    weight = power_weight(p->pdf,
                          light_pdf_triangle(w->by->lights, p->from, p->from_n,
                                             v->at.triangle, v->at.p));
  add(p, weight, glow);
}

// Sample a light for v; false where none is met.
static bool look_alone(const wave *w, const stop *s, const bsdf *b,
                       light_sample *l, meeting *m) {
  const vertex *v = s->at;
  vec3 u = {s->u[USE_PICK], s->u[USE_LIGHT], s->u[USE_LIGHT + 1]};
  bool found = light_sample_at(w->by->lights, v->at.p, v->n, u, l);
  vec3 wi = vertex_local(v, l->wi), wo = vertex_local(v, v->wo);
  if (!found || !(wi.z > 0)) return false;
  m->cosine = wi.z;
  m->f = l->delta ? bsdf_eval_point(b, wo, wi) : bsdf_eval(b, wo, wi);
  m->pdf = bsdf_pdf(b, wo, wi);
  return true;
}

// The one question of `turns` what a light adds at v, if nothing is in between.
static void ask_light(wave *w, const stop *s, const bsdf *b, uint32_t turns) {
  const vertex *v = s->at;
  const path *p = &w->paths[s->which];
  w->stats->asked++;
  light_sample l;
  meeting m = {0};
  bool found =
      s->lit ? path_ready_light(s, &l, &m) : look_alone(w, s, b, &l, &m);
  size_t record = path_log_note(w->by->log, w->by->lights->memory, v, &l,
                                found ? m.cosine : 0);
  if (!found) return;
  float scale = m.cosine / (l.pdf * (float)turns);
  if (!l.delta) scale *= power_weight(l.pdf, m.pdf);
  vec3 lit = vec3_mul(vec3_mul(p->throughput, m.f), l.radiance);
  lit = vec3_scale(lit, scale);
  if (!(vec3_peak(lit) > 0)) {
    if (!w->by->world->thorough) return;
    lit = vec3_all(0);
  }
  light_ray to = {.is_point = l.has_end, .to = l.to, .wi = l.wi};
  size_t i = w->shadow_count++;
  w->shadow_rays[i] =
      s->lit ? path_ready_shadow(s) : light_ray_shadow(&to, &v->at, true);
  w->shadows[i].path = s->which;
  w->shadows[i].lit = lit;
  w->shadows[i].record = record;
  if (!w->sheets) return;
  w->shadows[i].to = to;
  w->shadows[i].from = v->at;
}

// As many questions as the tracer wants.
static void ask_lights(wave *w, const stop *s, const bsdf *b) {
  uint32_t turns = w->by->questions;
  if (turns <= 1) {
    ask_light(w, s, b, 1);
    return;
  }
  for (uint32_t i = 0; i < turns; i++) {
    stop one = path_ready_turn(s, i, turns);
    ask_light(w, &one, b, turns);
  }
}

// Go on in a direction sampled from b; false where nothing is scattered.
static bool scatter(wave *w, const stop *s, const bsdf *b, ray *r) {
  const vertex *v = s->at;
  path *p = &w->paths[s->which];
  bsdf_sample d = {.delta = false};
  if (s->ready != NULL)
    *r = path_ready_leave(s, &d);
  else if (!bsdf_sample_wi(b, vertex_local(v, v->wo), s->u[USE_LOBE],
                           s->u[USE_DIRECTION], s->u[USE_DIRECTION + 1], &d))
    return false;
  if (d.delta && p->pdf > 0) path_trail_turn(&p->trail, p->pdf, r, w->steps);
  p->throughput = vec3_mul(p->throughput, d.weight);
  p->from = v->at.p;
  p->from_n = v->n;
  p->pdf = d.delta ? 0 : d.pdf;
  if (s->ready != NULL)
    p->inside = 0;
  else
    *r = vertex_leave(v, b, &d, r->d, &p->inside);
  return vec3_peak(p->throughput) > 0;
}

// Perhaps aim at mirrors and glass.
static void ask_aims(wave *w, const stop *s, const bsdf *b) {
  path *p = &w->paths[s->which];
  path_stand here = {s->which, s->at, b, p->throughput, p->numbers, p->segment};
  p->trail = path_aims_ask(w->aims, &here, w->steps);
}

// Russian roulette.
static bool survives(path *p, float u) {
  float q = roulette_odds(p->throughput, p->segment);
  if (q >= 1) return true;
  if (u >= q) return false;
  p->throughput = vec3_scale(p->throughput, 1 / q);
  return true;
}

// What is met at a vertex.
static void meet_matter(const wave *w, path *p, const stop *s, matter *m) {
  if (s->ready != NULL) {
    m->bsdf.kind = BSDF_LAMBERT;
    m->bsdf.kd = lanes_at(&s->ready->kd, s->lane);
    return;
  }
  *m = vertex_matter(s->at, w->by->world->dfg, s->u[USE_MATTER]);
  p->throughput = vec3_mul(p->throughput, m->weight);
}

// One bounce; false where the path ends.
static bool bounce(wave *w, stop *s, ray *r) {
  path *p = &w->paths[s->which];
  matter m;
  meet_matter(w, p, s, &m);
  bool delta = bsdf_is_delta(&m.bsdf);
  if (w->lights && !delta) ask_lights(w, s, &m.bsdf);
  if (w->aims != NULL && !delta) ask_aims(w, s, &m.bsdf);
  const path_world *world = w->by->world;
  if (world->lamps_only && p->segment + 1 == world->max_depth) return false;
  if (!scatter(w, s, &m.bsdf, r) || !survives(p, s->u[USE_LIFE])) return false;
  p->segment++;
  return true;
}

// Whether a ray goes straight on, by chance 1 - opacity.  If not, the number
// that decided is stretched, uniform again for the roulette.
static bool goes_through(stop *s) {
  if (!matter_passes(&s->at->at)) return false;
  float opacity = matter_opacity(&s->at->at);
  if (s->u[USE_LIFE] >= opacity) return true;
  s->u[USE_LIFE] /= opacity;
  return false;
}

// What becomes of a path at a vertex; *r is then its next ray.  False where it
// ends.
static bool step(wave *w, stop *s, ray *r) {
  path *p = &w->paths[s->which];
  const path_world *world = w->by->world;
  bool goes_on;
  if (goes_through(s)) {
    *r = surface_ray(&s->at->at, r->d);
    goes_on = true;
  } else {
    if (s->at->at.front) meet_glow(w, p, s->at);
    bool last = world->max_depth > 0 && p->segment >= world->max_depth;
    goes_on = !last && bounce(w, s, r);
  }
  if (w->steps + 1 < ROULETTE_MAX_RAYS) return goes_on;
  w->stats->cut += goes_on;
  return false;
}

// The vertices of n hits.
static void vertices_at(const wave *w, size_t n) {
  const path_tracer *by = w->by;
  met *m = w->met;
  ready_job job = {.scene = by->world->scene,
                   .lights = w->lit ? by->lights : NULL,
                   .dimension = 2 + USES * w->steps,
                   .hits = m->hits,
                   .rays = m->rays,
                   .numbers = m->numbers,
                   .at = m->at,
                   .ready = m->ready};
  (by->ready != NULL ? by->ready : path_ready_alone)(&job, n);
}

// Shade n of the paths whose rays have met a surface.
static void step_some(wave *w, size_t n) {
  met *m = w->met;
  vertices_at(w, n);
  for (size_t i = 0; i < n; i++) {
    ray r = m->rays[i];
    stop s = path_ready_stop(&m->at[i], &m->ready[i / LANES], (int)(i % LANES));
    s.which = m->which[i];
    if (!step(w, &s, &r)) continue;
    w->alive[w->next] = s.which;
    w->rays[w->next++] = r;
  }
}

// One step of every path on its way.
static void step_all(wave *w) {
  met *m = w->met;
  tracer_closest_many(&w->by->world->tracer, w->rays, w->hits, w->count);
  w->stats->rays += w->count;
  w->next = w->shadow_count = 0;
  size_t n = 0;
  for (size_t i = 0; i < w->count; i++) {
    if (w->hits[i].triangle == HIT_NONE) {
      meet_sky(w, &w->paths[w->alive[i]], &w->rays[i]);
      continue;
    }
    vertex_expect(w->by->world->scene, w->hits[i].triangle);
    m->which[n] = w->alive[i];
    m->numbers[n] = w->paths[w->alive[i]].numbers;
    m->hits[n] = w->hits[i];
    m->rays[n++] = w->rays[i];
    if (n < MET) continue;
    step_some(w, n);
    n = 0;
  }
  step_some(w, n);
  w->count = w->next;
  w->steps++;
}

// Add the light samples that arrive.
static void light_all(wave *w) {
  const path_world *world = w->by->world;
  tracer_any_many(&world->tracer, w->shadow_rays, w->blocked, w->shadow_count);
  w->stats->rays += w->shadow_count;
  w->stats->shadows += w->shadow_count;
  for (size_t i = 0; i < w->shadow_count; i++) {
    const shadow *s = &w->shadows[i];
    float share = 1;
    if (w->blocked[i]) {
      share = 0;
      if (w->sheets)
        share = light_ray_through(&s->to, world, &s->from, w->stats);
      if (s->record != PATH_NO_RECORD)
        w->by->log->items[s->record].square *= share;
      if (!(share > 0)) continue;
    }
    path *p = &w->paths[s->path];
    p->sum = vec3_mad(p->sum, share, s->lit);
  }
}

static vec2 path_place(const void *self, uint64_t pixel, uint32_t sample) {
  const path_tracer *by = self;
  sampler s = sampler_of(by->sampler, by->seed, pixel, sample);
  return sampler_2(&s);
}

static void path_begin(const void *self, const path_row *row, path_start *out) {
  const path_tracer *by = self;
  by->starts(by->seed, row, out);
}

static void path_radiance(const void *self, const path_start *starts, size_t n,
                          vec3 *out, path_stats *stats, void *room) {
  const path_tracer *by = self;
  const sampler_kind kind = by->sampler;
  const uint64_t seed = by->seed;
  wave *w = room;
  w->by = by;
  w->stats = stats;
  stats->followed += n;
  w->sheets = by->world->thorough || scene_has_sheets(by->world->scene);
  w->lights = by->world->thorough || light_set_any(by->lights);
  w->lit = w->lights && by->questions <= 1 && path_ready_lights(by->lights);
  const env *sky = &by->world->scene->env;
  w->even = sky->kind == ENV_CONSTANT && !(by->lights->env.irradiance > 0);
  w->sky = env_radiance(sky, (vec3){0, 1, 0});
  w->count = n;
  w->steps = 0;
  for (size_t i = 0; i < n; i++) {
    w->paths[i] = (path){
        .numbers = sampler_of(kind, seed, starts[i].pixel, starts[i].sample),
        .throughput = vec3_all(1),
        .segment = 1};
    w->alive[i] = (uint32_t)i;
    w->rays[i] = starts[i].ray;
  }
  if (w->aims != NULL) path_aims_begin(w->aims, by->aim, by->world, by->gain);
  while (w->count > 0) {
    step_all(w);
    light_all(w);
    if (w->aims != NULL) path_aims_run(w->aims, stats);
  }
  for (size_t i = 0; i < n; i++)
    out[i] = w->paths[i].sum;
  if (w->aims != NULL) path_aims_add(w->aims, out, n);
}

static void *path_room(const void *self, arena *mem) {
  const path_tracer *by = self;
  const size_t n = INTEGRATOR_BATCH, m = n + n * by->questions;
  wave *w = ARENA_NEW(mem, wave, 1);
  w->paths = ARENA_NEW(mem, path, n);
  w->alive = ARENA_NEW(mem, uint32_t, n);
  w->rays = ARENA_NEW(mem, ray, n);
  w->shadow_rays = ARENA_NEW(mem, ray, m);
  w->hits = ARENA_NEW(mem, hit, n);
  w->shadows = ARENA_NEW(mem, shadow, m);
  w->blocked = ARENA_NEW(mem, bool, m);
  w->met = ARENA_NEW(mem, met, 1);
  if (by->aim != NULL) w->aims = path_aims_room(mem);
  return w;
}

integrator path_integrator(const path_tracer *p) {
  bool rows = p->starts != NULL && p->sampler == SAMPLER_SOBOL;
  return (integrator){p, path_place, path_room, path_radiance,
                      rows ? path_begin : NULL};
}
