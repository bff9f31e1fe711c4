// path.c — the trick: paths go in waves.  All paths of a batch take one step
// together: their rays are traced at once, then all are shaded, then all
// shadow rays are traced at once.  A path is still a function of its pixel and
// sample alone, and what it is told of those of its group (path_share.h) of
// theirs, so nobody can tell from the picture.

#include "path.h"

#include "path_wave.h"
#include "roulette.h"
#include "tracer.h"

// Sample a light for v; false where none is met.
static bool look_alone(const wave *w, const stop *s, const bsdf *b,
                       light_sample *l, meeting *m) {
  const vertex *v = s->at;
  size_t i = (size_t)(v - w->met->at);
  light_question q = path_ready_question(s);
  if (w->together && w->met->asked[i])
    *l = w->met->light[i];
  else
    light_sample_at(w->by->lights, q.p, q.n, q.u, l);
  vec3 wi = vertex_local(v, l->wi), wo = vertex_local(v, v->wo);
  if (!(l->pdf > 0 && wi.z > 0)) return false;
  m->cosine = wi.z;
  m->f = l->delta ? bsdf_eval_point(b, wo, wi) : bsdf_eval(b, wo, wi);
  m->pdf = bsdf_pdf(b, wo, wi);
  return true;
}

// One of `turns` questions: what a light adds at v, if nothing is in between.
static void ask_light(wave *w, const stop *s, const bsdf *b, uint32_t turns) {
  const vertex *v = s->at;
  const path *p = &w->paths[s->which];
  w->stats->asked++;
  light_sample l;
  meeting m = {0};
  bool found =
      s->lit ? path_ready_light(s, &l, &m) : look_alone(w, s, b, &l, &m);
  if (!found) m = (meeting){0};
  size_t record = path_log_note(w->by->log, w->by->lights, v, &l, &m);
  if (!found) return;
  float scale = m.cosine / (l.pdf * (float)turns);
  if (!l.delta) scale *= wave_weight(l.pdf, m.pdf);
  vec3 lit = vec3_mul(vec3_mul(p->throughput, m.f), l.radiance);
  lit = vec3_scale(lit, scale);
  if (!(vec3_peak(lit) > 0)) {
    record = path_log_forget(w->by->log, record);
    if (!w->by->world->thorough) return;
    lit = vec3_all(0);
  }
  light_ray to = {.is_point = l.has_end, .to = l.to, .wi = l.wi};
  size_t i = w->shadow_count++;
  w->shadow_rays[i] =
      s->lit ? path_ready_shadow(s) : light_ray_shadow(&to, &v->at, true);
  w->shadows[i].path = s->which;
  w->shadows[i].lit = lit, w->shadows[i].record = record;
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
    stop one = wave_turn(w, s, i);
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
  path_stand here = {s->which,   s->at,      b,       p->throughput,
                     p->numbers, p->segment, p->scale};
  p->trail = path_aims_ask(w->aims, &here, w->steps);
}

static inline float odds_of(const path *p) {
  return roulette_odds(vec3_scale(p->throughput, p->scale), p->segment);
}

// Russian roulette.
static inline bool survives(path *p, float u) {
  float q = odds_of(p);
  if (q >= 1) return true;
  if (u >= q) return false;
  p->throughput = vec3_scale(p->throughput, 1 / q);
  return true;
}

// Whether a vertex is matt, and its normal is not bent for who looks at it.
static bool is_matt(const vertex *v) {
  return matter_matt(&v->at) && vec3_dot(v->ns, v->wo) > 0;
}

// Remember from where a path leaves the first surface that it met; what it
// finds there is of the group's numbers.
static void stand(const wave *w, const stop *s, const bsdf *b) {
  if (w->shares == NULL || w->steps > 0 || !is_matt(s->at)) return;
  w->paths[s->which].numbers = w->met->common[s->at - w->met->at];
  w->shares->stand[s->which] =
      (share_stand){.from = surface_smooth_ray(&s->at->at, s->at->ng).o,
                    .n = s->at->ns,
                    .albedo = b->kd,
                    .odds = float_min(odds_of(&w->paths[s->which]), 1)};
}

// What a path finds from its second surface on may be for all of its group.
static void share(wave *w, const stop *s) {
  path_shares *all = w->shares;
  size_t i = s->which;
  if (all == NULL || w->steps != 1 || !is_matt(s->at)) return;
  if (!path_shares_find(all, i, s->at)) return;
  all->own[i] = wave_take(w, i);
  w->paths[i].throughput = vec3_all(1);
  w->paths[i].scale = SHARE_SCALE * vec3_peak(all->stand[i].albedo);
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
  if (!scatter(w, s, &m.bsdf, r)) return false;
  stand(w, s, &m.bsdf);
  if (!survives(p, s->u[USE_LIFE])) return false;
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

// Whether a path that is alive takes another step: it has had so many.
static bool goes_on(const wave *w, bool alive) {
  if (w->steps + 1 < ROULETTE_MAX_RAYS) return alive;
  w->stats->cut += alive;
  return false;
}

// What becomes of a path at a vertex; *r is then its next ray.  False where it
// ends.
static bool step(wave *w, stop *s, ray *r) {
  path *p = &w->paths[s->which];
  const path_world *world = w->by->world;
  bool alive = true;
  if (goes_through(s)) {
    *r = surface_ray(&s->at->at, r->d);
  } else {
    if (s->at->at.front) wave_meet_glow(w, p, s->at);
    bool last = world->max_depth > 0 && p->segment >= world->max_depth;
    if (!last) share(w, s);
    alive = !last && bounce(w, s, r);
  }
  return goes_on(w, alive);
}

// The same where the vertex in lane i is plain.
static bool hop(wave *w, uint32_t which, const path_ready *v, int i, ray *r) {
  path *p = &w->paths[which];
  const path_world *world = w->by->world;
  if (world->max_depth > 0 && p->segment >= world->max_depth) return false;
  if (v->lit && v->matt[i]) {
    stop s = {.which = which, .ready = v, .lane = i, .lit = true};
    ask_light(w, &s, NULL, 1);
  }
  if (world->lamps_only && p->segment + 1 == world->max_depth) return false;
  p->throughput = vec3_mul(p->throughput, lanes_at(&v->weight, i));
  if (!(vec3_peak(p->throughput) > 0)) return false;
  if (!survives(p, v->u[USE_LIFE][i])) return false;
  p->from = lanes_at(&v->p, i);
  p->from_n = lanes_at(&v->n, i);
  p->pdf = v->leave_pdf[i];
  p->inside = v->held[i] ? p->inside + 1 : 0;
  p->segment++;
  *r = ray_from(lanes_at(&v->from, i), lanes_at(&v->leave, i));
  return goes_on(w, true);
}

// Whether the smooth surface is straight above the facet, or nearly.
static bool lifted_straight(const surface *at) {
  vec3 lift = vec3_sub(at->p_smooth, at->p);
  float high = vec3_dot(lift, at->ng);
  return high * high >= RAY_CLIMB * RAY_CLIMB * vec3_dot(lift, lift);
}

// The triangle that a path's next ray climbs away from, if any.  After a
// direction of some density the ray begins on the smooth surface, on the side
// that the last one came from; else on the facet, on the side that it goes to.
static uint32_t left_by(const wave *w, const stop *s, const ray *r) {
  const surface *at = &s->at->at;
  if (!ray_climbs(r->d, at->ng)) return HIT_NONE;
  bool above =
      !(w->paths[s->which].pdf > 0) || (at->front && lifted_straight(at));
  return above ? at->triangle : HIT_NONE;
}

// What becomes of the path at vertex i of w->met; false where it ends.
static bool step_one(wave *w, size_t i, ray *r, uint32_t *left) {
  met *m = w->met;
  const path_ready *v = &m->ready[i / LANES];
  int lane = (int)(i % LANES);
  int inside = v->held[lane] * w->paths[m->which[i]].inside;
  if (v->plain[lane] && inside < VERTEX_TRAPPED_AFTER) {
    *left = v->left[lane];
    return hop(w, m->which[i], v, lane, r);
  }
  if (v->plain[lane])
    m->at[i] = vertex_at(w->by->world->scene, &m->hits[i], m->rays[i].d);
  stop s = path_ready_stop(&m->at[i], v, lane);
  s.which = m->which[i];
  *r = m->rays[i];
  if (!step(w, &s, r)) return false;
  *left = left_by(w, &s, r);
  return true;
}

// Shade n of the paths whose rays have met a surface.
static void step_some(wave *w, size_t n) {
  wave_vertices(w, n);
  if (w->together) wave_ask(w, n);
  for (size_t i = 0; i < n; i++) {
    if (!step_one(w, i, &w->rays[w->next], &w->left[w->next])) continue;
    w->alive[w->next++] = w->met->which[i];
  }
}

// One step of every path on its way.
static void step_all(wave *w) {
  tracer_closest_many(&w->by->world->tracer, w->rays,
                      w->steps > 0 ? w->left : NULL, w->hits, w->count);
  w->stats->rays += w->count;
  w->next = w->shadow_count = 0;
  size_t n = 0, lost = 0;
  for (size_t i = 0; i < w->count; i++) {
    if (w->hits[i].triangle == HIT_NONE) {
      lost = wave_miss(w, lost, w->alive[i], &w->rays[i]);
      continue;
    }
    wave_meet(w, n++, i);
    if (n < MET) continue;
    step_some(w, n);
    n = 0;
  }
  step_some(w, n);
  wave_meet_sky(w, lost);
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
        w->by->log->items[s->record].found *= share;
      if (!(share > 0)) continue;
    }
    path *p = &w->paths[s->path];
    p->sum = vec3_mad(p->sum, share, s->lit);
  }
}

// Walk n paths to their ends.
static void walk(wave *w, const path_start *starts, size_t n) {
  wave_begin(w, starts, n);
  while (w->count > 0) {
    step_all(w);
    light_all(w);
    if (w->aims != NULL) path_aims_run(w->aims, w->stats);
    if (w->shares == NULL || w->steps != 2) continue;
    path_shares_connect(w->shares, &w->by->world->tracer, w->stats);
  }
}

// Walk the groups of as many of n paths as there is room for; how many.
static size_t walk_groups(wave *w, const path_start *starts, size_t n,
                          vec3 *out) {
  path_shares *s = w->shares;
  integrator by = path_integrator(w->by);
  size_t some = path_groups_seat(&s->groups, w->by->film, &by, starts, n);
  path_shares_begin(s);
  walk(w, s->groups.starts, s->groups.count);
  for (size_t i = 0; i < s->groups.count; i++) {
    vec3 *to = s->find[i].any ? &s->find[i].radiance : &s->own[i];
    *to = wave_take(w, i);
  }
  for (size_t i = 0; i < s->groups.count; i++)
    if (s->groups.asked[i] != GROUP_NOBODY)
      out[s->groups.asked[i]] = path_shares_sum(s, i);
  return some;
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
  wave *w = room;
  w->by = by;
  w->stats = stats;
  stats->followed += n;
  wave_survey(w);
  if (w->shares != NULL) {
    for (size_t i = 0; i < n;)
      i += walk_groups(w, starts + i, n - i, out + i);
    return;
  }
  walk(w, starts, n);
  wave_take_all(w, n, out);
}

static void *path_room(const void *self, arena *mem) {
  return wave_room(self, mem);
}

integrator path_integrator(const path_tracer *p) {
  bool rows = p->starts != NULL && p->sampler == SAMPLER_SOBOL;
  return (integrator){p, path_place, path_room, path_radiance,
                      rows ? path_begin : NULL};
}
