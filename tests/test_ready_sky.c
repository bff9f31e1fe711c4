// test_ready_sky.c — what many ask of an environment is what they ask one by
// one, to the bit, by every set of instructions that runs here.

#include "num.h"
#include "path.h"
#include "ready.h"
#include "skies.h"
#include "wide.h"
#include "world_hits.h"

#include <string.h>

static void assert_vec3(vec3 a, vec3 b) {
  assert_memory_equal(&a, &b, sizeof a);
}

static void assert_float(float a, float b) {
  assert_memory_equal(&a, &b, sizeof a);
}

typedef enum map_kind { NOISE, SUN, STRIPES, SMALL, EVEN, SKY, MAPS } map_kind;

static const sky_plan PLANS[MAPS] = {
    [NOISE] = {SKY_NOISE, 61, 33, .rotate = 0.3f},
    [SUN] = {SKY_SUN, 128, 64, 1200, -7.25f},
    [STRIPES] = {SKY_STRIPES, .width = 61, .height = 33},
    [SMALL] = {SKY_NOISE, 3, 1, .rotate = 0.3f},
    [EVEN] = {SKY_EVEN, 61, 33, .rotate = 0.3f},
    [SKY] = {SKY_BUILT_IN, 61, 33, .rotate = 0.3f},
};

// Who else shines, and of what there is a memory.
typedef enum company {
  ALONE,
  KNOWN,
  FEW,
  MANY,
  MANY_KNOWN,
  NEAR_KNOWN,
  ALL
} company;

// A memory that has been told of finds here and there.
static const light_memory *taught(light_memory *m, arena *mem) {
  enum { RECORDS = 20000 };
  light_record *records = ARENA_NEW(mem, light_record, RECORDS);
  assert_non_null(m);
  for (uint32_t i = 0; i < RECORDS; i++) {
    rng r = rng_of(3, i, 0);
    vec3 p = {rng_next(&r), rng_next(&r), rng_next(&r)};
    vec3 at = vec3_sub(vec3_scale(p, 6), vec3_all(3));
    uint32_t part = (uint32_t)(rng_next(&r) * (float)m->count);
    records[i] = (light_record){light_memory_key(m, at, (vec3){0, 1, 0}), part,
                                part % 3 ? rng_next(&r) : 0, 0.5f};
  }
  light_memory_learn(m, records, RECORDS, mem, NULL);
  return m;
}

// Matt balls and others; lamps of all kinds in company.
static world *new_world(map_kind sky, company with, light_set *lights) {
  world *w = world_new();
  const vec3 grey = {0.7f, 0.6f, 0.5f};
  const int lamps = with == ALONE || with == KNOWN ? 0 : with == FEW ? 1 : 20;
  w->materials[0] = world_material(MATERIAL_BLINN_PHONG, grey, vec3_all(0));
  w->materials[1] = w->materials[0];
  w->materials[1].ke = (vec3){9, 7, 5};
  w->materials[2] = world_material(MATERIAL_GLASS, grey, grey);
  w->materials[3] = world_material(MATERIAL_BLINN_PHONG, grey, grey);
  w->materials[3].ns = 30;
  world_quad(w, (vec3){-3, -1, 3}, (vec3){6, 0, 0}, (vec3){0, 0, -6}, 0);
  for (uint32_t i = 0; i < 4; i++)
    world_ball(w, (vec3){-1.5f + (float)i, -0.5f, 0}, 0.45f, 2, i % 2,
               i == 1 ? 0 : i);
  for (int i = 0; i < lamps; i++)
    world_quad(w, (vec3){(float)(i % 5) - 2, 2, (float)i * 0.2f - 2},
               (vec3){0.1f, 0, 0}, (vec3){0, 0.02f, 0.1f}, 1);
  w->lights[0] = (light){LIGHT_DIR, {1, -1, 0}, {2, 2, 1}};
  w->lights[1] = (light){LIGHT_POINT, {0, 3, 1}, {1, 4, 1}};
  w->scene.light_count = lamps > 0 ? 2 : 0;
  w->scene.env = sky_env(&PLANS[sky], &w->mem);
  world_ready(w, 0);
  light_set_build(lights, &w->scene, true, true, &w->mem, NULL);
  assert_int_equal(lights->env.irradiance > 0, sky != EVEN);
  vec3 lo = w->scene.lo, hi = w->scene.hi;
  if (sky != EVEN && (with == KNOWN || with == MANY_KNOWN))
    lights->memory =
        taught(light_set_cut_sky(lights, lo, hi, &w->mem, NULL), &w->mem);
  if (with == NEAR_KNOWN)
    lights->memory = taught(light_set_cut(lights, lo, hi, &w->mem), &w->mem);
  return w;
}

static vec3 random_unit(rng *r) {
  vec2 around = num_circle(rng_next(r));
  float y = 2 * rng_next(r) - 1, flat = sqrtf(1 - y * y);
  return (vec3){flat * around.x, y, flat * around.y};
}

// Random directions, and those at poles, seams and borders of texels; of any
// length, and none.
static vec3 direction_of(uint32_t i, rng *r) {
  static const float some[] = {0, -0.0f, 1, -1, 1e-30f, -1e-30f, 1e-3f, 3};
  vec3 d = random_unit(r);
  if (i % 3 == 0)
    d = (vec3){some[i / 3 % 8], some[i / 24 % 8], some[i / 192 % 8]};
  if (i % 7 == 0) {
    float u = (float)(int)(rng_next(r) * 244) / 244;
    d = env_direction((vec2){u, (float)(int)(rng_next(r) * 132) / 132});
  }
  if (i % 97 == 0) d = vec3_scale(d, 1e30f);
  if (i % 101 == 0) d.x = NAN;
  if (i % 103 == 0) d.y = INFINITY;
  return d;
}

static vec3 place_of(rng *r) {
  vec3 p = {rng_next(r), rng_next(r), rng_next(r)};
  return vec3_sub(vec3_scale(p, 6), vec3_all(3));
}

static void check_look(const light_set *l, const sky_looks *q, size_t k) {
  vec3 d = vec3_unit(q->d[k]);
  assert_vec3(env_radiance(&l->scene->env, d), q->radiance[k]);
  float pdf = 0;
  if (q->rival[k] && vec3_finite(d))
    pdf = light_pdf_env(l, q->from[k], q->from_n[k], env_uv(d));
  assert_float(pdf, q->pdf[k]);
}

static long looks(const light_set *l, const path_sky *by, uint32_t count) {
  long dense = 0;
  for (uint32_t i = 0, run = 1; i < count; i += run, run = run % 64 + 1) {
    sky_looks q;
    for (uint32_t k = 0; k < run; k++) {
      rng r = rng_of(7, i + k, 0);
      q.d[k] = direction_of(i + k, &r);
      q.from[k] = place_of(&r), q.from_n[k] = random_unit(&r);
      q.rival[k] = (i + k) % 5 > 0;
    }
    by->look(l, &q, run);
    for (uint32_t k = 0; k < run; k++) {
      check_look(l, &q, k);
      dense += q.pdf[k] > 0;
    }
  }
  return dense;
}

static void check_answer(const light_set *l, const path_ready *r, int i) {
  vec3 u = {r->u[USE_PICK][i], r->u[USE_LIGHT][i], r->u[USE_LIGHT + 1][i]};
  vec3 n = lanes_at(&r->n, i);
  light_sample s;
  bool found = light_sample_at(l, lanes_at(&r->p, i), n, u, &s);
  assert_int_equal(found, r->found[i] != 0);
  if (!found) return;
  assert_int_equal(s.part, r->part[i]);
  assert_int_equal(s.delta, r->delta[i] != 0);
  assert_int_equal(s.has_end, r->has_end[i] != 0);
  assert_vec3(s.wi, lanes_at(&r->wi, i));
  assert_vec3(s.radiance, lanes_at(&r->radiance, i));
  if (s.has_end) assert_vec3(s.to, lanes_at(&r->to, i));
  assert_float(s.pdf, r->pdf[i]);
  assert_float(s.chosen, r->chosen[i]);
  assert_float(vec3_dot(s.wi, n), r->cosine[i]);
}

// Numbers at the ends of their range too.
static float number_of(rng *r) {
  float u = rng_next(r);
  return u < 0.02f ? 0 : u > 0.98f ? FLOAT_BELOW_1 : u;
}

// Those that are matt are answered, and nobody else; of them found.
static long asks(const light_set *l, const path_sky *by, uint32_t count) {
  long found = 0;
  for (uint32_t i = 0, run = 1; i < count; i += run, run = run % 64 + 1) {
    path_ready ready[64 / LANES] = {0};
    for (uint32_t k = 0; k < run; k++) {
      path_ready *of = &ready[k / LANES];
      int lane = (int)(k % LANES);
      rng r = rng_of(8, i + k, 0);
      for (int use = 0; use < USES; use++)
        of->u[use][lane] = number_of(&r);
      lanes_set(&of->p, lane, place_of(&r));
      lanes_set(&of->n, lane, random_unit(&r));
      of->matt[lane] = (i + k) % 4 > 0;
    }
    by->ask(l, ready, run);
    for (uint32_t k = 0; k < 64 && k / LANES * LANES < run; k++) {
      const path_ready *of = &ready[k / LANES];
      int lane = (int)(k % LANES);
      assert_true(of->lit);
      if (of->matt[lane]) check_answer(l, of, lane);
      if (!of->matt[lane]) assert_int_equal(0, of->found[lane]);
      found += of->found[lane];
    }
  }
  return found;
}

static void sky_is_alone(void **unused) {
  (void)unused;
  const uint32_t count = (uint32_t)shortened(6000);
  for (int k = 0; k < MAPS * ALL; k++) {
    light_set lights;
    map_kind sky = (map_kind)(k / ALL);
    const long few = sky == SUN ? -1 : (long)count / 20;
    world *w = new_world(sky, (company)(k % ALL), &lights);
    for (int level = 0; level < WIDE_LEVELS; level++) {
      const path_sky *by = ready_sky_by(level);
      if (by == NULL) continue;
      long dense = looks(&lights, by, count);
      assert_true(sky == EVEN ? dense == 0 : dense > few);
      if (sky != EVEN) assert_true(asks(&lights, by, count) > count / 20);
    }
    world_free(w);
  }
}

// What was written down is the same; the second log is freed.
static void check_log(const path_log *a, const path_log *b) {
  assert_int_equal(a->count, b->count);
  if (a->count > 0)
    assert_memory_equal(a->items, b->items, a->count * sizeof *a->items);
  array_free(b->items);
}

// Whole paths: the same radiance by any of these, with plain vertices and
// without, with one question to lights or several, and where the sky is turned
// too often to be asked by many.
static void paths_are_alone(void **unused) {
  (void)unused;
  enum { STARTS = 400 };
  for (int k = 0; k < MAPS * ALL; k++) {
    light_set lights;
    world *w = new_world((map_kind)(k / ALL), (company)(k % ALL), &lights);
    if (k % ALL == ALL - 1) w->scene.env.rotate += 3 * SKY_MOST_TURNS;
    camera_view view =
        world_view((vec3){1, 0.5f, 3}, (vec3){-1, -0.5f, -1}, 50, 100, 10);
    path_start starts[STARTS];
    vec3 alone[STARTS], out[STARTS];
    path_stats stats = {0};
    world_starts(starts, STARTS, &view);
    path_log first = {0};
    path_tracer walker = {.world = &w->path, .lights = &lights};
    walker.questions = k % 2 ? 8 : 0;
    walker.log = k % 2 && lights.memory != NULL ? &first : NULL;
    integrator by = path_integrator(&walker);
    void *alone_room = by.room(by.self, &w->mem);
    by.radiance(by.self, starts, STARTS, alone, &stats, alone_room);
    walker.sky = ready_sky_best();
    void *room = by.room(by.self, &w->mem);
    for (int level = 0; level < 2 * WIDE_LEVELS; level++) {
      walker.ready = level % 2 ? ready_by(level / 2) : NULL;
      walker.sky = ready_sky_by(level / 2);
      path_log log = {0};
      if (walker.log != NULL) walker.log = &log;
      by.radiance(by.self, starts, STARTS, out, &stats, room);
      assert_memory_equal(alone, out, sizeof out);
      check_log(&first, &log);
    }
    array_free(first.items);
    world_free(w);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sky_is_alone),
      cmocka_unit_test(paths_are_alone),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
