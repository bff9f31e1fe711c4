// test_ready.c — what is found of sixteen vertices together is what is found of
// them one by one, to the bit, by every set of instructions that runs here.

#include "light_memory.h"
#include "num.h"
#include "path.h"
#include "ready.h"
#include "ready_num.h"
#include "wide.h"
#include "world_hits.h"

#include <string.h>

static void assert_vec3(vec3 a, vec3 b) {
  assert_memory_equal(&a, &b, sizeof a);
}

static void assert_float(float a, float b) {
  assert_memory_equal(&a, &b, sizeof a);
}

// Balls of every kind of material, in a box unless it is open; lamps nearby,
// far away and turned away.
static world *new_world(bool smooth, bool memory, bool few, bool open,
                        light_set *lights) {
  world *w = world_new();
  const vec3 grey = {0.7f, 0.6f, 0.5f}, bright = {0.9f, 0.8f, 0.2f};
  w->materials[0] = world_material(MATERIAL_BLINN_PHONG, grey, vec3_all(0));
  w->materials[1] = world_material(MATERIAL_BLINN_PHONG, bright, vec3_all(0));
  w->materials[1].ke = (vec3){9, 7, 5};
  w->materials[2] = world_material(MATERIAL_MIRROR, grey, grey);
  w->materials[3] = world_material(MATERIAL_GLASS, grey, grey);
  w->materials[4] = world_material(MATERIAL_BLINN_PHONG, grey, bright);
  w->materials[4].ns = 30;
  w->materials[5] = world_material(MATERIAL_METAL_ROUGH, grey, bright);
  w->materials[5].roughness = 0.4f;
  w->materials[6] = w->materials[0];
  w->materials[6].d = 0.5f;
  w->materials[6].passes = true;
  if (!open) world_box(w, vec3_all(-2), vec3_all(2), true, 0);
  for (uint32_t i = 0; i < 7; i++)
    world_ball(w, (vec3){-1.5f + 0.5f * (float)i, i % 2 ? -1 : 0.3f, 0.2f},
               0.4f, 2, smooth, i == 1 ? 0 : i);
  world_quad(w, (vec3){-0.5f, 1.9f, -0.5f}, (vec3){1, 0, 0}, (vec3){0, 0, 1},
             1);
  world_quad(w, (vec3){1.9f, 0, 0}, (vec3){0, 0.02f, 0}, (vec3){0, 0, -0.03f},
             1);
  if (!few)
    world_quad(w, (vec3){-1.9f, 1, 1}, (vec3){0, 0.2f, 0}, (vec3){0, 0, -0.3f},
               1);
  world_ready(w, 0);
  light_set_build(lights, &w->scene, true, true, &w->mem, NULL);
  if (!memory) return w;
  lights->memory = light_set_cut(lights, w->scene.lo, w->scene.hi, &w->mem);
  assert_non_null(lights->memory);
  return w;
}

// What a lane says of lights, and light_sample_at.
static int check_light(const light_set *l, const vertex *v, const float *u,
                       const path_ready *r, int i) {
  light_sample s;
  vec3 three = {u[USE_PICK], u[USE_LIGHT], u[USE_LIGHT + 1]};
  bool found = light_sample_at(l, v->at.p, v->n, three, &s);
  assert_int_equal(found, r->found[i] != 0);
  assert_int_equal(s.part, r->part[i]);
  if (!found) return 0;
  assert_vec3(s.wi, lanes_at(&r->wi, i));
  assert_vec3(s.to, lanes_at(&r->to, i));
  assert_vec3(s.radiance, lanes_at(&r->radiance, i));
  assert_float(s.pdf, r->pdf[i]);
  assert_float(s.chosen, r->chosen[i]);
  assert_float(vertex_local(v, s.wi).z, r->cosine[i]);
  ray shadow = surface_ray_to(&v->at, s.to, true);
  assert_vec3(shadow.o, lanes_at(&r->from, i));
  return 1;
}

// The triangle that a ray climbs away from: it leaves the front side, not more
// than so much beside the facet.
static uint32_t left_of(const vertex *v, vec3 d) {
  vec3 lift = vec3_sub(v->at.p_smooth, v->at.p);
  float high = vec3_dot(lift, v->at.ng);
  bool above = v->at.front &&
               high * high >= RAY_CLIMB * RAY_CLIMB * vec3_dot(lift, lift);
  return above && ray_climbs(d, v->at.ng) ? v->at.triangle : HIT_NONE;
}

// The point, the albedo and the direction.
static void check_leave(const vertex *v, const bsdf *b, const float *u,
                        const path_ready *r, int i) {
  bsdf_sample d;
  assert_int_equal(b->kind, BSDF_LAMBERT);
  assert_vec3(v->at.p, lanes_at(&r->p, i));
  assert_vec3(v->n, lanes_at(&r->n, i));
  assert_vec3(b->kd, lanes_at(&r->kd, i));
  assert_int_equal(left_of(v, lanes_at(&r->leave, i)), r->left[i]);
  assert_true(bsdf_sample_wi(b, vertex_local(v, v->wo), u[USE_LOBE],
                             u[USE_DIRECTION], u[USE_DIRECTION + 1], &d));
  assert_vec3(vertex_world(v, d.wi), lanes_at(&r->leave, i));
  assert_vec3(d.weight, lanes_at(&r->weight, i));
  assert_float(d.pdf, r->leave_pdf[i]);
}

// What a plain mirror or glass does.
static void check_clear(const vertex *v, const bsdf *b, const float *u,
                        const path_ready *r, int i) {
  bsdf_sample d;
  int inside = 0;
  assert_true(bsdf_sample_wi(b, vertex_local(v, v->wo), u[USE_LOBE], 0, 0, &d));
  ray next = vertex_leave(v, b, &d, (vec3){0, 0, 0}, &inside);
  assert_int_equal(r->plain[i],
                   b->kind == BSDF_GLASS ? PLAIN_GLASS : PLAIN_MIRROR);
  assert_vec3(v->at.p, lanes_at(&r->p, i));
  assert_vec3(v->n, lanes_at(&r->n, i));
  assert_vec3(next.o, lanes_at(&r->from, i));
  assert_vec3(next.d, lanes_at(&r->leave, i));
  assert_vec3(d.weight, lanes_at(&r->weight, i));
  assert_float(0, r->leave_pdf[i]);
  assert_int_equal(inside, r->held[i]);
  bool climbs = ray_climbs(next.d, v->at.ng);
  assert_int_equal(climbs ? v->at.triangle : HIT_NONE, r->left[i]);
}

// What was written down of a vertex, with the frame where it is matt.
static void check_vertex(const vertex *ready, const vertex *v, bool matt) {
  assert_vec3(ready->at.p, v->at.p);
  assert_vec3(ready->ns, v->ns);
  if (!matt) return;
  assert_vec3(ready->n, v->n);
  assert_vec3(ready->t, v->t);
  assert_vec3(ready->b, v->b);
}

typedef struct counts {
  int lambert, matt, plain, lit, delta, clear, held;
} counts;

static void check_one(const ready_job *j, size_t k, const dfg *table,
                      counts *c) {
  const path_ready *r = &j->ready[k / LANES];
  int i = (int)(k % LANES);
  float u[USES], own[USES];
  if (j->toward != NULL) sampler_8(&j->toward[k], j->dimension, u);
  sampler_8(&j->numbers[k], j->dimension, own);
  for (int d = j->toward != NULL ? 2 : 0; d < USES; d++)
    u[d] = own[d];
  for (int d = 0; d < USES; d++)
    assert_float(u[d], r->u[d][i]);
  vertex v = vertex_at(j->scene, &j->hits[k], j->rays[k].d);
  matter m = vertex_matter(&v, table, u[USE_MATTER]);
  bool plain = j->plain != NULL && v.at.material == j->scene->materials;
  bool delta = bsdf_is_delta(&m.bsdf), clear = delta && r->plain[i];
  assert_int_equal(r->plain[i] == PLAIN_MATT, plain && r->matt[i]);
  if (!r->plain[i]) check_vertex(&j->at[k], &v, r->matt[i]);
  if (clear) check_clear(&v, &m.bsdf, u, r, i);
  c->lambert += m.bsdf.kind == BSDF_LAMBERT;
  c->delta += delta && j->plain != NULL;
  c->clear += clear;
  c->held += clear && r->held[i];
  if (!r->matt[i]) return;
  c->matt++;
  c->plain += plain;
  assert_int_equal(0, r->held[i]);
  check_leave(&v, &m.bsdf, u, r, i);
  if (j->lights != NULL) c->lit += check_light(j->lights, &v, u, r, i);
}

// Runs of every length up to 64, at every dimension from which blocks begin
// and samples of low and high numbers; every third run has directions by other
// numbers.
static void check_level(const world *w, const light_set *lights,
                        const path_plain *plain, ready_function *by,
                        sampler_kind kind, counts *c) {
  hit hits[HITS];
  ray rays[HITS];
  vertex at[64];
  path_ready ready[64 / LANES];
  sampler numbers[64], toward[64];
  size_t n = world_hits(w, 3, hits, rays);
  ready_job j = {.scene = &w->scene,
                 .lights = lights,
                 .plain = plain,
                 .numbers = numbers,
                 .at = at,
                 .ready = ready};
  for (size_t from = 0, run = 1; from < n; from += run, run = run % 64 + 1) {
    if (run > n - from) run = n - from;
    for (size_t i = 0; i < run; i++) {
      uint32_t sample = (uint32_t)((from + i) * (from + i) >> from % 20);
      numbers[i] = sampler_of(kind, 5, from + i, sample);
      toward[i] = sampler_of(kind, 6, from, sample + (uint32_t)i);
    }
    j.toward = run % 3 == 0 ? toward : NULL;
    j.dimension = 2 + USES * (uint32_t)(run % 5);
    j.hits = hits + from, j.rays = rays + from;
    by(&j, run);
    for (size_t i = 0; i < run; i++)
      check_one(&j, i, w->path.dfg, c);
  }
}

static void ready_is_alone(void **unused) {
  (void)unused;
  for (int k = 0; k < 7; k++) {
    light_set lights;
    world *w = new_world(k % 2, k<4, k> 4, false, &lights);
    counts c = {0};
    const path_plain *plain = k % 2 ? path_plains(&w->scene, &w->mem) : NULL;
    assert_int_equal(k > 4, lights.near.nodes[0].count > 0);
    int levels = 0;
    for (int level = 0; level < WIDE_LEVELS; level++) {
      ready_function *by = ready_by(level);
      if (by == NULL) continue;
      levels++;
      check_level(w, k == 3 ? NULL : &lights, plain, by,
                  k == 2   ? SAMPLER_RANDOM
                  : k == 3 ? SAMPLER_TURNED
                           : SAMPLER_SOBOL,
                  &c);
    }
    print_message("# %d levels: %d matt, %d of them plain, %d lit, of %d\n",
                  levels, c.matt, c.plain, c.lit, c.lambert);
    assert_true(c.matt > 1000 * levels);
    assert_true(c.matt > c.lambert * 9 / 10);
    assert_true(plain == NULL || c.plain > c.matt / 4);
    print_message("# %d of %d clear, %d held\n", c.clear, c.delta, c.held);
    assert_true(c.clear >= c.delta * 3 / 4 && (plain == NULL || c.held > 0));
    assert_true(k == 3 || c.lit > 300 * levels);
    world_free(w);
  }
}

// Whole paths: the same radiance with and without, of all levels.  From k = 4
// on without sheets, so that vertices are plain; then under the sky alone.
static void paths_are_alone(void **unused) {
  (void)unused;
  enum { STARTS = 400 };
  for (int k = 0; k < 6; k++) {
    light_set lights;
    world *w = new_world(k % 2, k < 2, k == 2, k == 5, &lights);
    w->materials[6].passes = k < 4;
    if (k == 5) {
      w->materials[1].ke = vec3_all(0);
      w->scene.env =
          (env){.kind = ENV_CONSTANT, .scale = 1, .constant = {1, 2, 3}};
      light_set_build(&lights, &w->scene, false, false, &w->mem, NULL);
    }
    camera_view view =
        world_view((vec3){1, 0.5f, 1.5f}, (vec3){-1, 0, -1}, 70, 100, 10);
    path_start starts[STARTS];
    vec3 alone[STARTS], out[STARTS];
    path_stats stats = {0};
    world_starts(starts, STARTS, &view);
    path_tracer walker = {.world = &w->path,
                          .lights = &lights,
                          .sampler = k == 3 ? SAMPLER_RANDOM : SAMPLER_SOBOL};
    integrator by = path_integrator(&walker);
    void *room = by.room(by.self, &w->mem);
    by.radiance(by.self, starts, STARTS, alone, &stats, room);
    for (int level = 0; level < WIDE_LEVELS; level++) {
      walker.ready = ready_by(level);
      if (walker.ready == NULL) continue;
      by.radiance(by.self, starts, STARTS, out, &stats, room);
      assert_memory_equal(alone, out, sizeof out);
    }
    world_free(w);
  }
}

// Paths in a ball of glass, of which some are held so often that they have to
// go straight on.
static void glass_holds(void **unused) {
  (void)unused;
  enum { SIDE = 32, STARTS = SIDE * SIDE, SAMPLES = 16 };
  light_set lights;
  world *w = new_world(true, false, true, true, &lights);
  camera_view view =
      world_view((vec3){0, -1, 2}, (vec3){0, -1, 0}, 26, SIDE, SIDE);
  path_start starts[STARTS];
  vec3 alone[STARTS], out[STARTS];
  path_stats stats = {0};
  path_tracer walker = {.world = &w->path, .lights = &lights};
  integrator by = path_integrator(&walker);
  void *room = by.room(by.self, &w->mem);
  w->materials[1].ke = vec3_all(0);
  w->materials[6].passes = false;
  w->scene.env = (env){.kind = ENV_CONSTANT, .scale = 1, .constant = {1, 2, 3}};
  light_set_build(&lights, &w->scene, false, false, &w->mem, NULL);
  for (uint32_t k = 0; k < SAMPLES; k++) {
    for (uint32_t i = 0; i < STARTS; i++)
      starts[i] = (path_start){
          camera_ray(&view, (float)(i % SIDE) + 0.5f, (float)(i / SIDE) + 0.5f),
          i, k};
    walker.ready = NULL;
    by.radiance(by.self, starts, STARTS, alone, &stats, room);
    walker.ready = ready_best();
    by.radiance(by.self, starts, STARTS, out, &stats, room);
    assert_memory_equal(alone, out, sizeof out);
  }
  print_message("# %.1f rays a path\n",
                (double)stats.rays / (double)stats.followed);
  world_free(w);
}

static void assert_same_start(const path_start *a, const path_start *b) {
  assert_memory_equal(&a->ray, &b->ray, sizeof a->ray);
  assert_int_equal(a->pixel, b->pixel);
  assert_int_equal(a->sample, b->sample);
}

// Rows of samples begin where place and camera_ray say, also where the view is
// so large that a direction's square is no float.
static void rows_are_alone(void **unused) {
  (void)unused;
  light_set lights;
  world *w = new_world(false, false, true, false, &lights);
  camera_view view =
      world_view((vec3){1, 0.5f, 1.5f}, (vec3){-1, 0, -1}, 70, 100, 10);
  for (uint32_t k = 0; k < 3000; k++) {
    path_tracer walker = {.world = &w->path, .lights = &lights, .seed = k / 9};
    integrator alone = path_integrator(&walker);
    path_row row = {
        &view,      k * UINT64_C(0x100000001), (int)k % 101,
        (int)k / 7, 1 + (int)k % PATH_ROW,     k % 5 ? k : k << 20 | 7};
    if (k == 2000) view.corner = vec3_scale(view.corner, 1e30f);
    path_start one[PATH_ROW], all[PATH_ROW];
    integrator_begin(&alone, &row, one);
    for (int level = 0; level < WIDE_LEVELS; level++) {
      walker.starts = ready_starts_by(level);
      if (walker.starts == NULL) continue;
      integrator by = path_integrator(&walker);
      assert_true(by.begin != NULL);
      integrator_begin(&by, &row, all);
      for (int i = 0; i < row.count; i++)
        assert_same_start(&one[i], &all[i]);
    }
  }
  world_free(w);
}

// Functions without branches are those with them.
static void no_branches(void **unused) {
  (void)unused;
  for (uint32_t i = 0; i <= 1 << 20; i++) {
    float u = (float)i * 0x1p-20f;
    vec2 a = num_circle(u), b = lane_circle(u);
    assert_memory_equal(&a, &b, sizeof a);
    rng r = rng_of(i, 0, 0);
    float x = (rng_next(&r) - 0.5f) * num_exp2(20 * rng_next(&r) - 10);
    float y = i % 64 ? rng_next(&r) - 0.5f : i % 128 ? x : 0;
    assert_float(num_turns(y, x), lane_turns(y, x));
  }
  assert_float(num_turns(0, 0), lane_turns(0, 0));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(ready_is_alone), cmocka_unit_test(paths_are_alone),
      cmocka_unit_test(glass_holds),    cmocka_unit_test(rows_are_alone),
      cmocka_unit_test(no_branches),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
