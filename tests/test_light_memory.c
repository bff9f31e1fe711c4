// test_light_memory.c — lights that are remembered: parts of emitters, and the
// same light with whatever memory.

#include "walkers.h"

enum { WIDTH = 64, HEIGHT = 48 };

static const vec3 BLACK = {0, 0, 0};

// A room with a lamp outside of a hole in its left wall, which is nearer to -x
// than the room by `outside`.
static world *room_with_hole(float outside) {
  world *w = world_new();
  w->materials[0] = world_material(MATERIAL_BLINN_PHONG, vec3_all(0.6f), BLACK);
  w->materials[1] = world_material(MATERIAL_BLINN_PHONG, BLACK, BLACK);
  w->materials[1].ke = vec3_all(9);
  world_quad(w, (vec3){-2, 0, 2}, (vec3){4, 0, 0}, (vec3){0, 0, -4}, 0);
  world_quad(w, (vec3){-2, 2, -2}, (vec3){4, 0, 0}, (vec3){0, 0, 4}, 0);
  world_quad(w, (vec3){-2, 0, -2}, (vec3){4, 0, 0}, (vec3){0, 2, 0}, 0);
  world_quad(w, (vec3){2, 0, 2}, (vec3){-4, 0, 0}, (vec3){0, 2, 0}, 0);
  world_quad(w, (vec3){2, 0, -2}, (vec3){0, 0, 4}, (vec3){0, 2, 0}, 0);
  static const float hole[4][4] = {{-2, -0.3f, 0, 2},
                                   {0.3f, 2, 0, 2},
                                   {-0.3f, 0.3f, 0, 1},
                                   {-0.3f, 0.3f, 1.5f, 2}};
  for (int i = 0; i < 4; i++) {
    const float *h = hole[i];
    world_quad(w, (vec3){-2, h[2], h[1]}, (vec3){0, 0, h[0] - h[1]},
               (vec3){0, h[3] - h[2], 0}, 0);
  }
  float x = -2 - outside;
  world_quad(w, (vec3){x, 0, 2}, (vec3){0, 0, -4}, (vec3){0, 3, 0}, 1);
  world_ready(w, 0);
  return w;
}

// A walker of a world from a camera in the right corner.
static void corner_walker(walker *k, world *w) {
  walker_ready(k, &w->path, 3, &w->mem);
  k->camera = (camera){NULL, {1.6f, 1.2f, 1.7f}, {-1, 0.5f, -1}, {0, 1, 0}, 65};
  k->width = WIDTH, k->height = HEIGHT;
}

static bool learn(walker *k, pool *threads) {
  camera_view view;
  path_film lesson = walker_lesson(k, &view);
  return path_learn(&k->lights, &k->tracer, &lesson, k->mem, threads);
}

// The parts of a lamp cover it once: their areas add up, and a point inside of
// a part is found there, at the place that its weights say.
static void parts_cover_the_whole(void **state) {
  (void)state;
  world *w = room_with_hole(1);
  walker k;
  corner_walker(&k, w);
  light_parts parts;
  assert_true(light_parts_of(&parts, &k.lights.near, &w->mem));
  assert_int_equal(parts.count, 2 * 5 * 5);
  double area = 0;
  for (uint32_t i = 0; i < parts.count; i++) {
    const light_part *p = &parts.of[i];
    const light_triangle *t = &k.lights.near.emitters[p->emitter].shape;
    area += (double)p->shape.area;
    assert_true(vec3_dot(p->shape.n, t->n) > 0.9999f);
    for (int step = 1; step < 9; step++) {
      float b = 0.1f * (float)step, c = 0.09f * (float)(10 - step) - 0.05f;
      vec3 q = vec3_mad(vec3_mad(p->shape.a, b, p->shape.ab), c, p->shape.ac);
      if (b + c < 0.98f && c > 0.02f)
        assert_int_equal(light_parts_at(&parts, p->emitter, q), i);
      vec2 at = {p->at.x + b * p->ab.x + c * p->ac.x,
                 p->at.y + b * p->ab.y + c * p->ac.y};
      vec3 same = vec3_mad(vec3_mad(t->a, at.x, t->ab), at.y, t->ac);
      assert_true(vec3_length(vec3_sub(q, same)) < 1e-5f);
    }
  }
  assert_true(fabs(area - 12) < 1e-4);
  world_free(w);
}

// The density of a sample is that of its direction, by the one of the two
// triangles of the lamp that it lies on.
static void check_density(const world *w, const light_set *l, vec3 p,
                          const light_sample *s) {
  float above = s->to.y / 3 - (2 - s->to.z) / 4;  // the diagonal
  if (fabsf(above) < 1e-3f) return;
  uint32_t lamp = (uint32_t)w->scene.mesh.triangle_count - 2 + (above > 0);
  float pdf = light_pdf_triangle(l, p, (vec3){0, 1, 0}, lamp, s->to);
  assert_true(fabsf(pdf / s->pdf - 1) < 1e-3f);
}

// Whatever is remembered, even nonsense, light samples over their densities
// add up to the same; the densities are those of the samples; and what is
// never asked does not count as found.
static void lies_do_no_harm(void **state) {
  (void)state;
  world *w = room_with_hole(1);
  walker k;
  corner_walker(&k, w);
  vec3 p = {0.5f, 0.1f, 0.2f}, n = {0, 1, 0};
  light_memory *m =
      light_set_cut(&k.lights, vec3_all(-4), vec3_all(4), &w->mem);
  assert_non_null(m);
  double sums[2][2] = {{0}};
  const int count = (int)shortened(200000);
  for (int lie = 0; lie < 2; lie++) {
    k.lights.memory = lie ? m : NULL;
    light_record records[60];
    for (uint32_t i = 0; i < 60; i++)
      records[i] = (light_record){light_memory_key(m, p, n), i % 50,
                                  i % 7 == 3 ? 10 : 0, 1};
    if (lie) light_memory_learn(m, records, 60, &w->mem, NULL);
    for (int i = 0; i < count; i++) {
      rng r = rng_of(4, (uint64_t)i, (uint32_t)lie);
      vec3 u = {rng_next(&r), rng_next(&r), rng_next(&r)};
      light_sample l;
      if (!light_sample_at(&k.lights, p, n, u, &l) || !(l.wi.y > 0)) continue;
      if (i < 2000) check_density(w, &k.lights, p, &l);
      double x = (double)(l.radiance.x * l.wi.y / l.pdf);
      sums[lie][0] += x, sums[lie][1] += x * x;
    }
  }
  double mean[2], spread = 0;
  for (int i = 0; i < 2; i++) {
    mean[i] = sums[i][0] / count;
    spread += (sums[i][1] / count - mean[i] * mean[i]) / count;
  }
  print_message("# irradiance %.5f, with lies %.5f, +- %.5f\n", mean[0],
                mean[1], sqrt(spread));
  assert_true(fabs(mean[0] - mean[1]) < 4 * sqrt(spread));
  world_free(w);
}

// The key of a cell of the box from -4 to 4, for what faces up.
static uint32_t key_of_cell(const light_memory *m, float x, float y, float z) {
  vec3 at = {(x + 0.5f) / 3 - 4, (y + 0.5f) / 3 - 4, (z + 0.5f) / 3 - 4};
  return light_memory_key(m, at, (vec3){0, 1, 0});
}

// Two places that see different parts: their neighbours, where nobody has been,
// expect the same as they; a place far from both something in between.
static void neighbours_know(void **state) {
  (void)state;
  world *w = room_with_hole(1);
  walker k;
  corner_walker(&k, w);
  light_memory *m =
      light_set_cut(&k.lights, vec3_all(-4), vec3_all(4), &w->mem);
  assert_non_null(m);
  light_record records[2000];
  for (uint32_t i = 0; i < 2000; i++) {
    bool here = i % 2 == 0;
    uint32_t part = i / 2 % 50;
    uint32_t key = here ? key_of_cell(m, 4, 4, 4) : key_of_cell(m, 20, 20, 20);
    float found = part == (here ? 7 : 9) ? 10 : 0;
    records[i] = (light_record){key, part, found, 1};
  }
  light_memory_learn(m, records, 2000, &w->mem, NULL);
  uint32_t near[2] = {key_of_cell(m, 5, 5, 5), key_of_cell(m, 21, 20, 21)};
  uint32_t far = key_of_cell(m, 4, 20, 12);
  float seven[3], nine[3];
  for (int i = 0; i < 3; i++) {
    seven[i] = light_memory_share(m, i < 2 ? near[i] : far, 7);
    nine[i] = light_memory_share(m, i < 2 ? near[i] : far, 9);
  }
  print_message("# parts 7 and 9: %.3f %.3f, %.3f %.3f, far %.3f %.3f\n",
                (double)seven[0], (double)nine[0], (double)seven[1],
                (double)nine[1], (double)seven[2], (double)nine[2]);
  assert_true(seven[0] > 4 * nine[0] && nine[1] > 4 * seven[1]);
  assert_true(fabsf(seven[2] / nine[2] - 1) < 0.2f);
  world_free(w);
}

// Two pictures of the same light, of whom the second has less than half of the
// variance.
static void check_better(const render_result r[2]) {
  likeness l = likeness_of(&r[0], &r[1], 8);
  double before = noise_of(&r[0], &r[0]), after = noise_of(&r[1], &r[0]);
  print_message("# noise %.3g and %.3g; z %.2f, mean square %.2f\n", before,
                after, l.z, l.square);
  assert_true(fabs(l.z) < 4);
  assert_true(l.square < 1.5);
  assert_true(after < 0.5 * before);
}

// A lamp behind a hole: the same picture with memory, and less than half of
// the variance.
static void memory_helps(void **state) {
  (void)state;
  world *w = room_with_hole(1);
  walker k;
  corner_walker(&k, w);
  render_result r[2] = {walker_draw(&k, 64, NULL)};
  assert_true(learn(&k, NULL));
  r[1] = walker_draw(&k, 64, NULL);
  check_better(r);
  world_free(w);
}

// So does whoever asks more often at each vertex, as pupils do.
static void questions_help(void **state) {
  (void)state;
  world *w = room_with_hole(1);
  walker k;
  corner_walker(&k, w);
  render_result r[2] = {walker_draw(&k, 16, NULL)};
  k.tracer.questions = 8;
  r[1] = walker_draw(&k, 16, NULL);
  check_better(r);
  world_free(w);
}

// A sky over a plane in rings, as wide as high, of which LAMP is `bright` times
// as bright as the others.  Questions go to all directions of a ring alike,
// scattered rays by the cosine.
enum { RINGS = 16, LAMP = 5 };

static float ring_radiance(uint32_t ring, float bright) {
  return ring == LAMP ? bright : 1;
}

static const vec3 UP = {0, 1, 0};
static const float RING = 2 * PI / RINGS;  // steradians

// What a memory, which has learned nothing, learns of it.
static double sky_lesson(light_memory *m, float bright, arena *mem) {
  enum { EACH = 2000, COUNT = RINGS * EACH };
  float power[RINGS], all = RINGS - 1 + bright;
  for (uint32_t i = 0; i < RINGS; i++)
    power[i] = ring_radiance(i, bright);
  assert_true(
      light_memory_new(m, power, RINGS, vec3_all(-1), vec3_all(1), mem));
  light_record *records = ARENA_NEW(mem, light_record, COUNT);
  rng r = rng_of(8, 0, 0);
  for (uint32_t i = 0; i < COUNT; i++) {
    uint32_t ring = i / EACH;
    float cosine = ((float)ring + rng_next(&r)) / RINGS;
    float asked = power[ring] / all / RING, scattered = cosine / PI;
    records[i] = (light_record){light_memory_key(m, vec3_all(0), UP), ring,
                                power[ring] * cosine * RING,
                                asked / (asked + scattered)};
  }
  return light_memory_learn(m, records, COUNT, mem, NULL);
}

// By brute force: the variance of questions with probabilities p and scattered
// rays together, over the square of all light.
static double sky_variance(const double *p, float bright) {
  enum { STEPS = 1000 };
  double squares = 0, asked = 0, scattered = 0, ring = (double)RING;
  for (uint32_t i = 0; i < RINGS * STEPS; i++) {
    double cosine = (i + 0.5) / (RINGS * STEPS);
    double f = (double)ring_radiance(i / STEPS, bright) * cosine;
    double q = p[i / STEPS] / ring, b = cosine / (double)PI;
    double d = ring / STEPS / (q + b);
    squares += f * f * d;
    asked += f * q * d;
    scattered += f * b * d;
  }
  double sum = asked + scattered;
  return (squares - asked * asked - scattered * scattered) / (sum * sum);
}

// What is left of the noise of questions by power, also as the memory says
// itself; even skies have none.
static void knows_what_it_gains(void **state) {
  (void)state;
  arena mem = {0};
  float bright[] = {1, 3, 30, 1000};
  for (int i = 0; i < 4; i++) {
    light_memory m;
    double said = sky_lesson(&m, bright[i], &mem), p[RINGS], by_power[RINGS];
    double asked = 0;
    for (uint32_t k = 0; k < RINGS; k++) {
      uint32_t key = light_memory_key(&m, vec3_all(0), UP);
      p[k] = (double)light_memory_share(&m, key, k);
      asked += p[k];
      by_power[k] =
          (double)(ring_radiance(k, bright[i]) / (RINGS - 1 + bright[i]));
    }
    double after = sky_variance(p, bright[i]);
    double before = sky_variance(by_power, bright[i]);
    double gain = (before + 0.3) / (after + 0.3) * 1.25 / (1 + 0.25 * asked);
    print_message("# lamp %g: variance %.4f and %.4f, gain %.4f, said %.4f\n",
                  (double)bright[i], before, after, gain, said);
    assert_true(after < before * 1.01);
    assert_true(i > 0 || after < 0.01);
    assert_true(fabs(said / gain - 1) < 0.02);
  }
  arena_free(&mem);
}

static void same_memory(void **state) {
  (void)state;
  world *w = room_with_hole(1);
  assert_same_lesson(w, corner_walker, learn);
  world_free(w);
}

// Where every lamp is seen, or there are too many or none, nothing is
// remembered, and pictures are what they were.
static void nothing_to_remember(void **state) {
  (void)state;
  world *w = world_new();
  w->materials[0] = world_material(MATERIAL_BLINN_PHONG, vec3_all(0.6f), BLACK);
  w->materials[1] = w->materials[0];
  w->materials[1].ke = vec3_all(9);
  world_quad(w, (vec3){-2, 0, 2}, (vec3){4, 0, 0}, (vec3){0, 0, -4}, 0);
  world_quad(w, (vec3){-1, 2, -1}, (vec3){2, 0, 0}, (vec3){0, 0, 2}, 1);
  world_ready(w, 0);
  walker k;
  corner_walker(&k, w);
  assert_false(learn(&k, NULL));
  assert_true(k.lights.memory == NULL);
  world_free(w);
  w = world_new();
  w->materials[0] = world_material(MATERIAL_BLINN_PHONG, vec3_all(0.6f), BLACK);
  w->materials[0].ke = vec3_all(1);
  world_ball(w, vec3_all(0), 1, 3, false, 0);
  world_ready(w, 0);
  corner_walker(&k, w);
  assert_false(learn(&k, NULL));
  world_free(w);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(parts_cover_the_whole),
      cmocka_unit_test(lies_do_no_harm),
      cmocka_unit_test(neighbours_know),
      cmocka_unit_test(memory_helps),
      cmocka_unit_test(questions_help),
      cmocka_unit_test(knows_what_it_gains),
      cmocka_unit_test(same_memory),
      cmocka_unit_test(nothing_to_remember),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
