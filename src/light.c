// light.c

#include "light.h"

#include "light_emission.h"

#include <stdlib.h>

static void add_far(light_set *out, const light *l) {
  light_far f = {vec3_unit(vec3_neg(l->at)), l->power, light_mean(l->power)};
  if (l->kind == LIGHT_DIR && f.power > 0) out->far[out->far_count++] = f;
}

static int by_triangle(const void *a, const void *b) {
  uint32_t x = ((const light_name *)a)->triangle;
  uint32_t y = ((const light_name *)b)->triangle;
  return x < y ? -1 : x > y;
}

static void name_triangles(light_set *out, arena *mem) {
  const light_tree *t = &out->near;
  out->names = ARENA_NEW(mem, light_name, t->count);
  for (uint32_t i = 0; i < t->count; i++)
    if (!t->emitters[i].is_point)
      out->names[out->name_count++] = (light_name){t->emitters[i].source, i};
  qsort(out->names, out->name_count, sizeof *out->names, by_triangle);
}

void light_set_build(light_set *out, const scene *s, bool lights_on,
                     bool env_on, arena *mem, pool *threads) {
  *out = (light_set){.scene = s};
  uint32_t count;
  light_emitter *emitters = light_emitters(s, lights_on, &count);
  light_tree_build(&out->near, emitters, count, mem);
  array_free(emitters);
  name_triangles(out, mem);
  out->far = ARENA_NEW(mem, light_far, s->light_count);
  for (size_t i = 0; lights_on && i < s->light_count; i++)
    add_far(out, &s->lights[i]);
  if (env_on) light_env_build(&out->env, &s->env, mem, threads);
}

bool light_set_any(const light_set *l) {
  return l->near.count > 0 || l->far_count > 0 || l->env.irradiance > 0;
}

light_memory *light_set_cut(light_set *l, vec3 lo, vec3 hi, arena *mem) {
  float power[LIGHT_PARTS_MOST];
  l->sky.count = 0;
  if (!light_parts_of(&l->parts, &l->near, mem)) return NULL;
  for (uint32_t i = 0; i < l->parts.count; i++)
    power[i] = light_parts_power(&l->parts, i);
  light_memory *m = ARENA_NEW(mem, light_memory, 1);
  if (!light_memory_new(m, power, l->parts.count, lo, hi, mem)) return NULL;
  m->rest = l->env.rest + l->env.irradiance;
  for (size_t i = 0; i < l->far_count; i++)
    m->rest += l->far[i].power;
  return m;
}

light_memory *light_set_cut_sky(light_set *l, vec3 lo, vec3 hi, arena *mem,
                                pool *threads) {
  if (!(l->env.irradiance > 0)) return NULL;
  light_memory *m = ARENA_NEW(mem, light_memory, 1);
  light_sky *sky = &l->sky;
  light_env_whole(&l->whole, &l->env, mem, threads);
  if (!light_sky_of(sky, &l->whole, LIGHT_PARTS_MOST, mem)) return NULL;
  if (!light_memory_new(m, sky->power, sky->count, lo, hi, mem)) return NULL;
  light_sky_usual(sky, &l->env, m->usual);
  m->rest = l->whole.rest;
  for (size_t i = 0; i < l->far_count; i++)
    m->rest += l->far[i].power;
  return m;
}

// The probabilities of the three kinds of light at a place.
typedef struct shares {
  float near, far, env;
  float far_sum;  // of far_weight
} shares;

static float far_weight(const light_far *f, const light_place *at) {
  return at->all_around ? f->power
                        : f->power * float_max(vec3_dot(at->n, f->wi), 0);
}

static float share_of(float weight, float sum, int kinds) {
  return weight > 0 ? (1 - LIGHT_EVEN_SHARE) * weight / sum +
                          LIGHT_EVEN_SHARE / (float)kinds
                    : 0;
}

// Nothing needs to be weighed where all lights are of one kind.
static shares shares_at(const light_set *l, const light_place *at) {
  bool sky = l->env.irradiance > 0;
  if (l->far_count == 0 && !sky) return (shares){.near = 1};
  if (l->far_count == 0 && l->near.count == 0) return (shares){.env = 1};
  shares s = {.near = light_tree_bound(&l->near, at), .env = l->env.irradiance};
  for (size_t i = 0; i < l->far_count; i++)
    s.far_sum += far_weight(&l->far[i], at);
  float sum = s.near + s.far_sum + s.env;
  int kinds = (s.near > 0) + (s.far_sum > 0) + (s.env > 0);
  if (kinds == 0 || !(sum < INFINITY)) return (shares){0};
  s.near = share_of(s.near, sum, kinds);
  s.far = share_of(s.far_sum, sum, kinds);
  s.env = share_of(s.env, sum, kinds);
  return s;
}

// Whom of the near lights to ask: an emitter or a part of one, and with what
// probability.
typedef struct asked {
  const light_emitter *emitter;
  const light_part *part;  // NULL: all of it
  float share;
} asked;

// Whether there is a memory, and of whom.
static bool knows_sky(const light_set *l) {
  return l->memory != NULL && l->sky.count > 0;
}

static bool knows_near(const light_set *l) {
  return l->memory != NULL && l->sky.count == 0;
}

// A part that memory chooses.
static bool remember(const light_set *l, const light_place *at, double u,
                     uint32_t *part, float *share) {
  uint32_t key = light_memory_key(l->memory, at->p, at->n);
  float one = float_min((float)u, FLOAT_BELOW_1);
  return light_memory_pick(l->memory, key, one, part, share);
}

static bool choose_near(const light_set *l, const light_place *at, double u,
                        asked *out) {
  uint32_t i;
  *out = (asked){0};
  if (!knows_near(l)) {
    if (!light_tree_pick(&l->near, at, u, &i, &out->share)) return false;
  } else {
    if (!remember(l, at, u, &i, &out->share)) return false;
    out->part = &l->parts.of[i];
    i = out->part->emitter;
  }
  out->emitter = &l->near.emitters[i];
  return true;
}

static bool sample_point(const light_set *l, const light_place *at,
                         const asked *a, light_sample *out) {
  const light_emitter *e = a->emitter;
  vec3 d = vec3_sub(e->shape.a, at->p);
  float d2 = vec3_dot(d, d);
  out->wi = vec3_unit(d);
  out->radiance = vec3_scale(l->scene->lights[e->source].power, 1 / d2);
  out->pdf = a->share;
  out->delta = out->has_end = true;
  out->to = e->shape.a;
  return d2 > 0 && vec3_finite(out->radiance);
}

// The weights of the corners of the whole that a point of a part has.
static vec2 of_whole(const light_part *p, const light_point *q) {
  if (p == NULL) return (vec2){q->b, q->c};
  return (vec2){p->at.x + q->b * p->ab.x + q->c * p->ac.x,
                p->at.y + q->b * p->ab.y + q->c * p->ac.y};
}

static bool sample_near(const light_set *l, const light_place *at, double u1,
                        vec3 u, light_sample *out) {
  asked a;
  if (!choose_near(l, at, u1, &a)) return false;
  out->chosen = a.share;
  if (a.part != NULL) out->part = (uint32_t)(a.part - l->parts.of);
  if (a.emitter->is_point) return sample_point(l, at, &a, out);
  const light_triangle *t = a.part != NULL ? &a.part->shape : &a.emitter->shape;
  light_point q;
  if (!light_triangle_sample(t, at->p, u.y, u.z, &q)) return false;
  vec2 where = of_whole(a.part, &q);
  out->wi = q.wi;
  out->radiance = light_emission(l->scene, a.emitter->source, where.x, where.y);
  out->pdf = a.share * q.pdf;
  out->has_end = true;
  out->to = q.at;
  return true;
}

static bool sample_far(const light_set *l, const light_place *at, float sum,
                       double u, light_sample *out) {
  double left = u * (double)sum;
  for (size_t i = 0; i < l->far_count; i++) {
    const light_far *f = &l->far[i];
    float weight = far_weight(f, at);
    if (!(weight > 0)) continue;
    out->wi = f->wi;
    out->radiance = f->irradiance;
    out->pdf = weight / sum;
    out->delta = true;
    left -= (double)weight;
    if (left < 0) break;
  }
  return out->pdf > 0;
}

// The part of the environment to ask, if it has any; false: none.
static bool choose_env(const light_set *l, const light_place *at, double u,
                       light_sample *out) {
  out->chosen = 1;
  if (!knows_sky(l)) return true;
  uint32_t part;
  if (!remember(l, at, u, &part, &out->chosen)) return false;
  out->part = part;
  return true;
}

// Choose a kind of light, and ask it.
bool light_ask_all_but_env(const light_set *l, const light_question *q,
                           light_sample *out) {
  light_place at = light_place_of(q->p, q->n);
  shares s = shares_at(l, &at);
  double choice = light_finer(q->u), near = (double)s.near;
  *out = (light_sample){.part = LIGHT_NO_PART};
  double rest = choice - near - (double)s.far;
  if (rest >= 0) {
    bool left = s.env > 0 && choose_env(l, &at, rest / (double)s.env, out);
    out->chosen *= s.env;
    return left;
  }
  bool is_near = choice < near;
  float share = is_near ? s.near : s.far;
  bool found = is_near ? sample_near(l, &at, choice / near, q->u, out)
                       : sample_far(l, &at, s.far_sum,
                                    (choice - near) / (double)s.far, out);
  out->pdf = found ? out->pdf * share : 0;
  out->chosen *= share;
  return false;
}

// As light_samples_at, of LIGHT_TOGETHER at most.
static void sample_some(const light_set *l, const light_question *q, size_t n,
                        light_sample *out) {
  light_sample *to[LIGHT_TOGETHER];
  uint32_t part[LIGHT_TOGETHER];
  vec2 u[LIGHT_TOGETHER];
  env_sample found[LIGHT_TOGETHER];
  size_t count = 0;
  for (size_t i = 0; i < n; i++) {
    if (!light_ask_all_but_env(l, &q[i], &out[i])) continue;
    u[count] = (vec2){q[i].u.y, q[i].u.z};
    part[count] = out[i].part;
    to[count++] = &out[i];
  }
  if (knows_sky(l))
    light_sky_samples(&l->sky, part, u, count, found);
  else
    light_env_samples(&l->env, u, count, found);
  for (size_t i = 0; i < count; i++) {
    to[i]->wi = found[i].wi;
    to[i]->radiance = found[i].radiance;
    to[i]->pdf = found[i].pdf * to[i]->chosen;
  }
}

void light_samples_at(const light_set *l, const light_question *q, size_t n,
                      light_sample *out) {
  for (size_t i = 0; i < n; i += LIGHT_TOGETHER) {
    size_t some = n - i < LIGHT_TOGETHER ? n - i : LIGHT_TOGETHER;
    sample_some(l, q + i, some, out + i);
  }
}

bool light_sample_at(const light_set *l, vec3 p, vec3 n, vec3 u,
                     light_sample *out) {
  light_question q = {p, n, u};
  sample_some(l, &q, 1, out);
  return out->pdf > 0;
}

// The emitter that a triangle is; false when it is none.
static bool emitter_of(const light_set *l, uint32_t triangle,
                       uint32_t *emitter) {
  size_t lo = 0, hi = l->name_count;
  while (lo < hi) {
    size_t middle = (lo + hi) / 2;
    if (l->names[middle].triangle < triangle)
      lo = middle + 1;
    else
      hi = middle;
  }
  if (lo == l->name_count || l->names[lo].triangle != triangle) return false;
  *emitter = l->names[lo].emitter;
  return true;
}

float light_pdf_triangle(const light_set *l, vec3 p, vec3 n, uint32_t triangle,
                         vec3 q) {
  uint32_t i;
  if (!emitter_of(l, triangle, &i)) return 0;
  light_place at = light_place_of(p, n);
  const light_memory *m = knows_near(l) ? l->memory : NULL;
  uint32_t part = m != NULL ? light_parts_at(&l->parts, i, q) : 0;
  float pdf = light_triangle_pdf(
      m != NULL ? &l->parts.of[part].shape : &l->near.emitters[i].shape, p, q);
  if (!(pdf > 0)) return 0;
  float share = m != NULL
                    ? light_memory_share(m, light_memory_key(m, p, n), part)
                    : light_tree_share(&l->near, &at, i);
  return pdf * shares_at(l, &at).near * share;
}

float light_env_share(const light_set *l, vec3 p, vec3 n) {
  light_place at = light_place_of(p, n);
  return shares_at(l, &at).env;
}

float light_pdf_env(const light_set *l, vec3 p, vec3 n, vec2 uv) {
  if (!(l->env.irradiance > 0)) return 0;
  float share = light_env_share(l, p, n);
  if (!knows_sky(l)) return share * light_env_density(&l->env, uv);
  uint32_t part, key = light_memory_key(l->memory, p, n);
  float pdf = light_sky_density(&l->sky, uv, &part);
  return share * pdf * light_memory_share(l->memory, key, part);
}
