// test_jury.c — a jury asks the pixels that matter, by numbers of its own, and
// knows the lamp's edge where the picture cannot.

#include "jury.h"
#include "num.h"
#include "rng.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

static long shortened(long n) {
  return getenv("FACET_QUICK") != NULL ? (n / 2 > 1 ? n / 2 : 1) : n;
}

// A window of a film: a wall with a round lamp, whose edge covers a part of
// each pixel that it goes through.
enum { FILM_WIDTH = 120, FILM_HEIGHT = 90, FROM_X = 11, FROM_Y = 7 };
enum { WIDTH = 96, HEIGHT = 75, PIXELS = WIDTH * HEIGHT };
enum { FILM = FILM_WIDTH * FILM_HEIGHT, SAMPLES = 8 };

static const double LAMP = 12, WALL = 0.3;

static bool in_lamp(double x, double y) {
  double u = x - 60.5, v = y - 44.2;
  return u * u + v * v < 15.3 * 15.3;
}

static double radiance_at(double x, double y) {
  return in_lamp(x, y) ? LAMP : WALL;
}

// The truth, by many points.
static double radiance_of(int x, int y) {
  enum { SIDE = 64 };
  double sum = 0;
  for (int k = 0; k < SIDE * SIDE; k++)
    sum +=
        radiance_at(x + (k % SIDE + 0.5) / SIDE, y + (k / SIDE + 0.5) / SIDE);
  return sum / (SIDE * SIDE);
}

// Whoever is asked for samples of it, and how many of each pixel of the window
// there were; elsewhere is where no jury has a pixel.
typedef struct stage {
  uint64_t seed;
  uint32_t *asked, *elsewhere;  // NULL: nobody counts
} stage;

static vec3 sample_of(uint64_t seed, uint64_t pixel, uint32_t sample) {
  rng r = rng_of(seed, pixel, sample);
  uint64_t in = pixel % FILM;
  double x = (double)(in % FILM_WIDTH) + (double)rng_next(&r);
  double y = (double)(in / FILM_WIDTH) + (double)rng_next(&r);
  double shown = radiance_at(x, y) * (0.9 + 0.2 * (double)rng_next(&r));
  return vec3_all((float)shown);
}

static vec2 stage_place(const void *self, uint64_t pixel, uint32_t sample) {
  (void)self, (void)pixel, (void)sample;
  return (vec2){0.5f, 0.5f};
}

static void *stage_room(const void *self, arena *mem) {
  (void)self;
  return ARENA_NEW(mem, bool, 1);
}

// The samples of a pixel are 0, 1, 2, ... of a film beyond those of the halves.
static void count(const stage *s, const path_start *start) {
  uint64_t in = start->pixel - 2 * (uint64_t)FILM;
  uint64_t x = in % FILM_WIDTH - FROM_X, y = in / FILM_WIDTH - FROM_Y;
  if (x >= WIDTH || y >= HEIGHT || s->asked[y * WIDTH + x]++ != start->sample)
    ++*s->elsewhere;
}

static void stage_radiance(const void *self, const path_start *starts, size_t n,
                           vec3 *out, path_stats *stats, void *room) {
  const stage *s = self;
  (void)room;
  stats->rays += n;
  for (size_t i = 0; i < n; i++) {
    out[i] = sample_of(s->seed, starts[i].pixel, starts[i].sample);
    if (s->asked != NULL) count(s, &starts[i]);
  }
}

static uint64_t film_pixel(size_t i) {
  uint64_t x = FROM_X + i % WIDTH, y = FROM_Y + i / WIDTH;
  return y * FILM_WIDTH + x;
}

static halves halves_of(uint64_t seed, arena *mem) {
  halves h = halves_new(mem, WIDTH, HEIGHT);
  for (size_t i = 0; i < PIXELS; i++)
    for (uint32_t k = 0; k < SAMPLES; k++) {
      uint64_t pixel = film_pixel(i) + (k & 1) * FILM;
      halves_add(&h, i, k, sample_of(seed, pixel, k / 2));
    }
  return h;
}

static jury jury_of(const integrator *by) {
  return (jury){by, NULL, FILM_WIDTH, FILM_HEIGHT, FROM_X, FROM_Y, 0, 0, 0};
}

// A batch starts wherever the walker says; the view isn't looked through.
static void stage_begin(const void *self, const path_row *row,
                        path_start *out) {
  (void)self;
  *out = (path_start){.pixel = row->pixel, .sample = row->sample};
}

static integrator stage_walker(const stage *s) {
  return (integrator){s, stage_place, stage_room, stage_radiance, stage_begin};
}

// The error by the halves, the radiance to divide by being known.
static double known_error(const halves *h) {
  double sum = 0;
  for (size_t i = 0; i < PIXELS; i++) {
    uint64_t at = film_pixel(i);
    double m[2],
        r = radiance_of((int)(at % FILM_WIDTH), (int)(at / FILM_WIDTH));
    halves_means(h, i, 0, m);
    sum += (m[0] - m[1]) * (m[0] - m[1]) / 4 / (r * r + 0.01);
  }
  return sqrt(sum / PIXELS);
}

// Where a lamp's edge goes through pixels few samples cannot tell a lamp from a
// speck.  A jury can.
static void a_jury_knows_the_edge(void **state) {
  (void)state;
  double alone = 0, judged = 0, alone2 = 0, judged2 = 0;
  long seeds = shortened(20);
  for (long k = 0; k < seeds; k++) {
    arena mem = {0};
    stage s = {(uint64_t)k, NULL, NULL};
    integrator by = stage_walker(&s);
    jury j = jury_of(&by);
    halves h = halves_of(s.seed, &mem);
    double known = known_error(&h);
    double a = halves_error(&h, NULL, NULL).error / known - 1;
    double b = jury_error(&j, &h, 1e9, NULL).error / known - 1;
    alone += a, alone2 += a * a, judged += b, judged2 += b * b;
    arena_free(&mem);
  }
  double n = (double)seeds;
  print_message("# off by %.3f (%.3f), with a jury by %.3f (%.3f)\n", alone / n,
                sqrt(alone2 / n), judged / n, sqrt(judged2 / n));
  assert_true(sqrt(alone2 / n) > 0.2);
  assert_true(sqrt(judged2 / n) < 0.1);
}

// It asks by numbers that nobody else has, and few of them: of the pixels whose
// terms are large, as many as these are.
static void few_are_asked(void **state) {
  (void)state;
  arena mem = {0};
  uint32_t elsewhere = 0, *asked = ARENA_NEW(&mem, uint32_t, PIXELS);
  double *terms = ARENA_NEW(&mem, double, PIXELS), sum = 0;
  stage s = {1, asked, &elsewhere};
  integrator by = stage_walker(&s);
  jury j = jury_of(&by);
  halves h = halves_of(1, &mem);
  halves_estimate is = halves_error(&h, terms, NULL);
  jury_error(&j, &h, is.error / 1.01, NULL);
  assert_true(j.samples == 0);
  jury_error(&j, &h, is.error, NULL);
  uint64_t samples = 0, pixels = 0;
  for (size_t i = 0; i < PIXELS; i++)
    sum += terms[i];
  for (size_t i = 0; i < PIXELS; i++) {
    double n = terms[i] / sum * PIXELS * SAMPLES / 16;
    assert_true(asked[i] == 0 ? n < 4 * SAMPLES : fabs(asked[i] - n) <= 1);
    samples += asked[i], pixels += asked[i] > 0;
  }
  assert_int_equal(elsewhere, 0);
  assert_true(pixels > 0 && j.pixels == pixels && pixels < PIXELS / 64);
  assert_true(j.samples == samples && j.rays == samples);
  assert_true(samples <= PIXELS * SAMPLES / 16);
  arena_free(&mem);
}

// The same for any threads, and asked again.
static void all_say_the_same(void **state) {
  (void)state;
  arena mem = {0};
  stage s = {3, NULL, NULL};
  integrator by = stage_walker(&s);
  jury j = jury_of(&by);
  halves h = halves_of(3, &mem);
  halves_estimate alone = jury_error(&j, &h, 1e9, NULL);
  for (int n = 2; n < 8; n += 5) {
    pool *threads = pool_new(&mem, n);
    halves_estimate same = jury_error(&j, &h, 1e9, threads);
    assert_memory_equal(&same, &alone, sizeof same);
    pool_free(threads);
  }
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_jury_knows_the_edge),
      cmocka_unit_test(few_are_asked),
      cmocka_unit_test(all_say_the_same),
  };
  return cmocka_run_group_tests_name("jury", tests, NULL, NULL);
}
