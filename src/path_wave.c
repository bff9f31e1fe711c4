// path_wave.c

#include "path_wave.h"

wave *wave_room(const path_tracer *by, arena *mem) {
  const size_t n = INTEGRATOR_BATCH, m = n + n * by->questions;
  wave *w = ARENA_NEW(mem, wave, 1);
  w->paths = ARENA_NEW(mem, path, n);
  w->alive = ARENA_NEW(mem, uint32_t, n);
  w->rays = ARENA_NEW(mem, ray, n);
  w->shadow_rays = ARENA_NEW(mem, ray, m);
  w->left = ARENA_NEW(mem, uint32_t, n);
  w->hits = ARENA_NEW(mem, hit, n);
  w->shadows = ARENA_NEW(mem, shadow, m);
  w->blocked = ARENA_NEW(mem, bool, m);
  w->met = ARENA_NEW(mem, met, 1);
  w->plain = path_ready_plain(by->world->scene, mem);
  if (by->aim != NULL) w->aims = path_aims_room(mem);
  if (by->film != NULL) w->shares = ARENA_NEW(mem, path_shares, 1);
  return w;
}

// The start that comes k-th, where starts are rows of sixteen pixels: those of
// a square of four by four become neighbours, and their rays a packet.
static size_t square_order(size_t k) {
  return (k & ~(size_t)0x3c) | (k >> 2 & 3) << 4 | (k >> 4 & 3) << 2;
}

_Static_assert(PATH_ROW == 16, "rows of square_order");

void wave_begin(wave *w, const path_start *starts, size_t n) {
  const path_tracer *by = w->by;
  const sampler_kind kind = by->sampler;
  const uint64_t seed = by->seed;
  const size_t squares = w->shares == NULL ? n & ~(size_t)63 : 0;
  w->count = 0;
  w->steps = 0;
  for (size_t k = 0; k < n; k++) {
    size_t i = k < squares ? square_order(k) : k;
    const path_start *s = &starts[i];
    w->paths[i] = (path){.throughput = vec3_all(1), .scale = 1, .segment = 1};
    if (s->pixel == GROUP_NO_PIXEL) continue;
    w->paths[i].numbers = sampler_of(kind, seed, s->pixel, s->sample);
    w->alive[w->count] = (uint32_t)i;
    w->rays[w->count++] = s->ray;
  }
  if (w->aims != NULL) path_aims_begin(w->aims, by->aim, by->world, by->gain);
}

static void add(path *p, float weight, vec3 radiance) {
  p->sum = vec3_mad(p->sum, weight, vec3_mul(p->throughput, radiance));
}

void wave_meet_sky(const wave *w, path *p, const ray *r) {
  float weight = p->pdf > 0 ? 1 : path_trail_weight(&p->trail, w->steps);
  if (w->even) {
    if (vec3_finite(r->d)) add(p, weight, w->sky);
    return;
  }
  vec3 d = vec3_unit(r->d);
  vec3 sky = env_radiance(&w->by->world->scene->env, d);
  if (!(vec3_peak(sky) > 0)) return;
  if (p->pdf > 0)
    weight = wave_weight(p->pdf,
                         light_pdf_env(w->by->lights, p->from, p->from_n, d));
  add(p, weight, sky);
}

void wave_meet_glow(const wave *w, path *p, const vertex *v) {
  vec3 glow = matter_emission(&v->at);
  if (!(vec3_peak(glow) > 0)) return;
  float weight = path_trail_weight(&p->trail, w->steps);
  if (p->pdf > 0)
    weight = wave_weight(p->pdf,
                         light_pdf_triangle(w->by->lights, p->from, p->from_n,
                                            v->at.triangle, v->at.p));
  add(p, weight, glow);
}

// Whether nobody asks more of plain vertices than their lanes know.
static bool lanes_will_do(const wave *w) {
  if (w->aims != NULL || w->shares != NULL || w->by->log != NULL) return false;
  return !w->lights || (w->lit && !w->sheets);
}

void wave_vertices(const wave *w, size_t n) {
  const path_tracer *by = w->by;
  met *m = w->met;
  ready_job job = {.scene = by->world->scene,
                   .lights = w->lit ? by->lights : NULL,
                   .plain = lanes_will_do(w) ? w->plain : NULL,
                   .dimension = 2 + USES * w->steps,
                   .hits = m->hits,
                   .rays = m->rays,
                   .numbers = m->numbers,
                   .at = m->at,
                   .ready = m->ready};
  (by->ready != NULL ? by->ready : path_ready_alone)(&job, n);
}

vec3 wave_take(wave *w, size_t i) {
  vec3 sum = w->paths[i].sum;
  w->paths[i].sum = vec3_all(0);
  if (w->aims == NULL) return sum;
  return vec3_add(sum, path_aims_take(w->aims, i));
}
