// path_wave.c

#include "path_wave.h"

// Bits of the numbers that materials look at.
static uint32_t uses_of(const path_plain *plain, size_t count) {
  uint32_t choice = 1u << USE_LOBE, any = choice | 1u << USE_MATTER, uses = 0;
  for (size_t i = 0; i < count && plain != NULL; i++) {
    if (plain[i].kind == PLAIN_GLASS) uses |= choice;
    if (plain[i].kind == PLAIN_NOT) uses |= any;
  }
  uint32_t always = 3u << USE_DIRECTION | 1u << USE_LIFE;
  return always | (plain != NULL ? uses : any);
}

wave *wave_room(const path_tracer *by, arena *mem) {
  bool asks = by->world->thorough || light_set_any(by->lights);
  const size_t n = INTEGRATOR_BATCH, m = asks ? n + n * by->questions : 0;
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
  w->missed = ARENA_NEW(mem, missed, 1);
  if (by->questions > 1 && by->sky != NULL)
    w->turns = ARENA_NEW(mem, path_ready, by->questions * (MET / LANES));
  w->plain = path_plains(by->world->scene, mem);
  w->uses = uses_of(w->plain, by->world->scene->material_count);
  if (asks) w->uses |= 3u << USE_LIGHT | 1u << USE_PICK;
  if (by->aim != NULL) w->aims = path_aims_room(mem);
  if (by->film != NULL) w->shares = ARENA_NEW(mem, path_shares, 1);
  return w;
}

void wave_survey(wave *w) {
  const path_tracer *by = w->by;
  const scene *s = by->world->scene;
  const env *sky = &s->env;
  bool bright = by->lights->env.irradiance > 0, once = by->questions <= 1;
  w->sheets = by->world->thorough || scene_has_sheets(s);
  w->lights = by->world->thorough || light_set_any(by->lights);
  w->lit = w->lights && once && path_ready_lights(by->lights);
  bool many = by->sky != NULL && fabsf(sky->rotate) < SKY_MOST_TURNS;
  w->asks = bright && many;
  w->together = once && bright && !w->asks;
  w->even = sky->kind == ENV_CONSTANT && !bright;
  w->looks = many && (sky->kind == ENV_SKY || env_has_map(sky));
  w->sky = env_radiance(sky, (vec3){0, 1, 0});
}

// Starts come in blocks, rows of sixteen pixels of a tile one after the other;
// blocks of the same pixels, of sample after sample, are a stack.
enum { ROW = 16, BLOCK = ROW * ROW, STACK = 4 * BLOCK };

_Static_assert((int)ROW == (int)PATH_ROW, "rows of blocks");

// The start that comes k-th: sixteen that are close become neighbours, and
// their rays a packet.  Of one block a square of four by four; of a stack of
// two blocks four by two pixels, and of four blocks two by two.
static size_t square_order(size_t k) {
  return (k & ~(size_t)0x3c) | (k >> 2 & 3) << 4 | (k >> 4 & 3) << 2;
}

static size_t two_order(size_t k) {
  return (k & ~(size_t)0x1fc) | (k >> 2 & 1) << 4 | (k >> 3 & 1) << 8 |
         (k >> 4 & 3) << 2 | (k >> 6 & 7) << 5;
}

static size_t four_order(size_t k) {
  return (k & ~(size_t)0x3fe) | (k >> 1 & 1) << 4 | (k >> 2 & 3) << 8 |
         (k >> 4 & 7) << 1 | (k >> 7 & 7) << 5;
}

// How many starts are put in order together.
static size_t together(const path_start *s, size_t n) {
  if (n >= STACK && s[0].pixel == s[3 * BLOCK].pixel) return STACK;
  if (n >= 2 * BLOCK && s[0].pixel == s[BLOCK].pixel) return 2 * BLOCK;
  return n < BLOCK ? n & ~(size_t)(4 * ROW - 1) : BLOCK;
}

static size_t in_order(size_t k, size_t size) {
  if (size == STACK) return four_order(k);
  return size == 2 * BLOCK ? two_order(k) : square_order(k);
}

// Where all light comes from an even sky, all that counts is where paths go.
static sampler_kind kind_of(const wave *w) {
  sampler_kind kind = w->by->sampler;
  bool even = w->even && !light_set_any(w->by->lights);
  return even && kind == SAMPLER_SOBOL ? SAMPLER_TURNED : kind;
}

// A path that asks for lights has most of its light before it ends.  One that
// only meets the sky has none, and is worth following as if it were brighter.
#define SCALE_UNLIT 2.0f

static float scale_of(const wave *w) {
  return light_set_any(w->by->lights) ? 1 : SCALE_UNLIT;
}

// Where a path was last is told by its next direction.
static inline void begin_path(wave *w, const path_start *starts, size_t i,
                              float scale) {
  const path_start *s = &starts[i];
  path *p = &w->paths[i];
  p->sum = vec3_all(0);
  p->throughput = vec3_all(1);
  p->pdf = 0;
  p->scale = scale;
  p->segment = 1;
  p->inside = 0;
  p->trail = (path_trail){.cell = NULL};
  if (s->pixel == GROUP_NO_PIXEL) return;
  p->numbers = sampler_of(w->kind, w->by->seed, s->pixel, s->sample);
  w->alive[w->count] = (uint32_t)i;
  w->rays[w->count++] = s->ray;
}

void wave_begin(wave *w, const path_start *starts, size_t n) {
  const path_tracer *by = w->by;
  size_t done = 0, some;
  w->kind = kind_of(w);
  float scale = scale_of(w);
  w->count = 0;
  w->steps = 0;
  while (w->shares == NULL && (some = together(starts + done, n - done)) > 0) {
    for (size_t k = 0; k < some; k++)
      begin_path(w, starts, done + in_order(k, some), scale);
    done += some;
  }
  for (; done < n; done++)
    begin_path(w, starts, done, scale);
  if (w->aims != NULL) path_aims_begin(w->aims, by->aim, by->world, by->gain);
}

static void add(path *p, float weight, vec3 radiance) {
  p->sum = vec3_mad(p->sum, weight, vec3_mul(p->throughput, radiance));
}

static float weight_alone(const wave *w, const path *p) {
  if (p->pdf > 0 || w->aims == NULL) return 1;
  return path_trail_weight(&p->trail, w->steps);
}

// What path p finds of the sky.
static void meet_sky(const wave *w, path *p, const env_place *at) {
  const env *sky = &w->by->world->scene->env;
  float weight = weight_alone(w, p);
  vec3 radiance = env_radiance_at(sky, at);
  if (!(vec3_peak(radiance) > 0)) return;
  if (p->pdf > 0 && w->lights) {
    vec2 uv = sky->kind == ENV_MAP ? at->uv : env_uv(at->d);
    weight = wave_weight(p->pdf,
                         light_pdf_env(w->by->lights, p->from, p->from_n, uv));
  }
  add(p, weight, radiance);
}

size_t wave_miss(const wave *w, size_t n, uint32_t which, const ray *r) {
  missed *m = w->missed;
  path *p = &w->paths[which];
  if (w->even) {
    if (vec3_finite(r->d)) add(p, weight_alone(w, p), w->sky);
    return n;
  }
  m->which[n] = which;
  if (w->looks) {
    m->all.d[n] = r->d;
  } else {
    m->at[n] = env_expect(&w->by->world->scene->env, vec3_unit(r->d));
    if (w->lights) light_env_expect(&w->by->lights->env, m->at[n].uv);
  }
  if (n + 1 < MET) return n + 1;
  wave_meet_sky(w, MET);
  return 0;
}

// All of them at once.
static void look_all(const wave *w, size_t n) {
  missed *m = w->missed;
  sky_looks *q = &m->all;
  for (size_t i = 0; i < n; i++) {
    const path *p = &w->paths[m->which[i]];
    q->from[i] = p->from;
    q->from_n[i] = p->from_n;
    q->rival[i] = p->pdf > 0 && w->lights;
  }
  w->by->sky->look(w->by->lights, q, n);
  for (size_t i = 0; i < n; i++) {
    path *p = &w->paths[m->which[i]];
    float weight = 1;
    if (q->rival[i]) weight = wave_weight(p->pdf, q->pdf[i]);
    if (!(p->pdf > 0)) weight = path_trail_weight(&p->trail, w->steps);
    if (vec3_peak(q->radiance[i]) > 0) add(p, weight, q->radiance[i]);
  }
}

void wave_meet_sky(const wave *w, size_t n) {
  const missed *m = w->missed;
  if (w->looks) {
    look_all(w, n);
    return;
  }
  for (size_t i = 0; i < n; i++)
    meet_sky(w, &w->paths[m->which[i]], &m->at[i]);
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
  return !w->lights ||
         ((w->lit || (w->asks && w->by->questions <= 1)) && !w->sheets);
}

// Ask for those of them that are matt, once or several times.
static void ask_all(const wave *w, size_t n) {
  const path_tracer *by = w->by;
  if (by->questions <= 1) by->sky->ask(by->lights, w->met->ready, n);
  for (uint32_t i = 0; i < by->questions && by->questions > 1; i++) {
    path_ready *turn = w->turns + i * (MET / LANES);
    path_ready_turns(turn, w->met->ready, n, i, by->questions);
    by->sky->ask(by->lights, turn, n);
  }
}

// Whether all of a triangle is matt.
static bool is_matt(const scene *s, uint32_t triangle) {
  surface any = {.material = NULL};
  if (s->material_of != NULL)
    any.material = &s->materials[s->material_of[triangle]];
  return matter_matt(&any);
}

void wave_meet(const wave *w, size_t n, size_t i) {
  const scene *s = w->by->world->scene;
  uint32_t which = w->alive[i], triangle = w->hits[i].triangle;
  met *m = w->met;
  vertex_expect(s, triangle);
  m->which[n] = which;
  m->numbers[n] = w->paths[which].numbers;
  m->hits[n] = w->hits[i];
  m->rays[n] = w->rays[i];
  m->common[n] = m->numbers[n];
  if (w->shares == NULL || w->steps > 0 || !is_matt(s, triangle)) return;
  m->common[n] =
      path_groups_numbers(&w->shares->groups, which, w->kind, w->by->seed);
}

void wave_vertices(const wave *w, size_t n) {
  const path_tracer *by = w->by;
  met *m = w->met;
  ready_job job = {.scene = by->world->scene,
                   .lights = w->lit ? by->lights : NULL,
                   .plain = lanes_will_do(w) ? w->plain : NULL,
                   .dimension = 2 + USES * w->steps,
                   .uses = w->uses,
                   .hits = m->hits,
                   .rays = m->rays,
                   .numbers = m->numbers,
                   .toward =
                       w->shares != NULL && w->steps == 0 ? m->common : NULL,
                   .at = m->at,
                   .ready = m->ready};
  (by->ready != NULL ? by->ready : path_ready_alone)(&job, n);
  if (w->asks) ask_all(w, n);
}

stop wave_turn(const wave *w, const stop *s, uint32_t i) {
  stop one = path_ready_turn(s, i, w->by->questions);
  if (!w->asks || s->ready == NULL) return one;
  one.ready = w->turns + i * (MET / LANES) + (s->ready - w->met->ready);
  one.lit = true;
  return one;
}

void wave_ask(const wave *w, size_t n) {
  met *m = w->met;
  light_question q[MET];
  light_sample found[MET];
  size_t count = 0, which[MET];
  for (size_t i = 0; i < n; i++) {
    const path_ready *v = &m->ready[i / LANES];
    stop s = path_ready_stop(&m->at[i], v, (int)(i % LANES));
    m->asked[i] = s.ready != NULL && !v->plain[i % LANES];
    if (!m->asked[i]) continue;
    q[count] = path_ready_question(&s);
    which[count++] = i;
  }
  if (count == 0) return;
  light_samples_at(w->by->lights, q, count, found);
  for (size_t i = 0; i < count; i++)
    m->light[which[i]] = found[i];
}

vec3 wave_take(wave *w, size_t i) {
  vec3 sum = w->paths[i].sum;
  w->paths[i].sum = vec3_all(0);
  if (w->aims == NULL) return sum;
  return vec3_add(sum, path_aims_take(w->aims, i));
}

void wave_take_all(wave *w, size_t n, vec3 *out) {
  for (size_t i = 0; i < n; i++)
    out[i] = w->aims != NULL ? wave_take(w, i) : w->paths[i].sum;
}
