// test_light_sky.c — skies that are remembered: parts of a table, and the same
// light with whatever memory.

#include "chi.h"
#include "num.h"
#include "skies.h"
#include "walkers.h"

// Chi-square tests, a few hundred of them, go wrong by chance less often.
#define LEAST_PROBABILITY 1e-6

// Maps that are hard to cut in one way each.
typedef enum map_kind { NOISE, SUN, STRIPES, SMALL, SKY, MAP_KINDS } map_kind;

static const sky_plan PLANS[MAP_KINDS] = {
    [NOISE] = {SKY_NOISE, 384, 16, .rotate = 0.3f},
    [SUN] = {SKY_SUN, 32, 16, 200, 0.3f},
    [STRIPES] = {SKY_STRIPES, 32, 16, .rotate = 0.3f},
    [SMALL] = {SKY_NOISE, 3, 1, .rotate = 0.3f},
    [SKY] = {SKY_BUILT_IN, 32, 16, .rotate = 0.3f},
};

// Bins over the sphere whose edges are edges of cells of the table.
enum { BINS_X = 96, BINS_Y = 32, BINS = BINS_X * BINS_Y };

// How far the edges are turned.
static float turn_of(const light_sky *s) {
  return s->env->env->rotate + 0.5f / (float)s->env->map.width;
}

static int bin_of(const light_sky *s, vec2 uv) {
  float u = uv.x + turn_of(s);
  int x = (int)((u - floorf(u)) * BINS_X), y = (int)(uv.y * BINS_Y);
  return (y < BINS_Y ? y : BINS_Y - 1) * BINS_X + (x < BINS_X ? x : 0);
}

typedef double counts[LIGHT_PARTS_MOST][BINS];

// The integrals of the density over each bin, by part.
static void integrate(const light_sky *s, counts want) {
  enum { FINE = 24 };
  const int w = BINS_X * FINE, h = BINS_Y * FINE;
  for (int i = 0; i < w * h; i++) {
    float u = ((float)(i % w) + 0.5f) / (float)w - turn_of(s);
    vec2 uv = {u - floorf(u), ((float)(i / w) + 0.5f) / (float)h};
    double sine = sin(3.14159265358979 * (double)uv.y);
    double area = 2 * 9.869604401089358 * sine / w / h;
    uint32_t part;
    double density = (double)light_sky_density(s, uv, &part);
    want[part][bin_of(s, uv)] += density * area;
  }
}

// Directions of a part lie in it, but for a few on its edge, and come as often
// as the density there says, which integrates to 1.
static double check_part(const light_sky *s, uint32_t part, double *want) {
  const long n = shortened(20000) + 1000;
  double got[BINS] = {0}, total = 0;
  long elsewhere = 0, off = 0;
  rng r = rng_of(2, part, 0);
  for (long i = 0; i < n; i++) {
    float u1 = rng_next(&r), u2 = rng_next(&r);
    env_sample d = light_sky_sample(s, part, (vec2){u1, u2});
    vec2 uv = env_uv(d.wi);
    uint32_t found;
    float density = light_sky_density(s, uv, &found);
    assert_true(d.pdf > 0);
    elsewhere += found != part;
    off += found == part && !(fabsf(density / d.pdf - 1) < 1e-2f);
    got[bin_of(s, uv)]++;
  }
  for (int i = 0; i < BINS; i++)
    total += want[i];
  for (int i = 0; i < BINS; i++)
    want[i] *= (double)n;
  assert_true(fabs(total - 1) < 1e-4);
  assert_true(elsewhere <= n / 500 + 1 && off <= n / 500 + 1);
  return chi_probability(got, want, BINS);
}

static void samples_of_parts_follow_their_density(void **state) {
  (void)state;
  arena mem = {0};
  counts *want = calloc(1, sizeof *want);
  for (int i = 0; i < 2 * MAP_KINDS; i++) {
    map_kind kind = (map_kind)(i / 2);
    env e = sky_env(&PLANS[kind], &mem);
    light_env bright, table;
    light_env_build(&bright, &e, &mem, NULL);
    table = bright;
    if (i % 2 == 1) light_env_whole(&table, &bright, &mem, NULL);
    light_sky s;
    assert_true(light_sky_of(&s, &table, LIGHT_PARTS_MOST, &mem));
    memset(want, 0, sizeof *want);
    integrate(&s, *want);
    double least = 1, power = 0;
    for (uint32_t k = 0; k < s.count; k++) {
      power += (double)s.power[k];
      least = fmin(least, check_part(&s, k, (*want)[k]));
    }
    print_message("# map %d, %s: %u parts, power %.6f, least p %.2g\n",
                  (int)kind, i % 2 == 1 ? "whole" : "above the mean", s.count,
                  power, least);
    assert_true(fabs(power - 1) < 1e-6 && least > LEAST_PROBABILITY);
  }
  free(want);
  arena_free(&mem);
}

static const vec3 BLACK = {0, 0, 0};

// Also with more lamps than memory is for: a ball of them.
typedef enum lamps { NO_LAMPS, MANY_LAMPS } lamps;

// A yard below a bright window of the sky, which a wall hides from most of it,
// and a fainter one that all of it sees.
static world *yard(lamps lit) {
  world *w = world_new();
  w->materials[0] = world_material(MATERIAL_BLINN_PHONG, vec3_all(0.6f), BLACK);
  world_quad(w, (vec3){-2, 0, 2}, (vec3){4, 0, 0}, (vec3){0, 0, -4}, 0);
  world_quad(w, (vec3){-1, 0, 2}, (vec3){0, 0, -4}, (vec3){0, 3, 0}, 0);
  w->materials[1] = world_material(MATERIAL_BLINN_PHONG, BLACK, BLACK);
  w->materials[1].ke = vec3_all(2);
  if (lit == MANY_LAMPS)
    world_ball(w, (vec3){0.5f, 0.4f, -1}, 0.3f, 2, false, 1);
  env *e = &w->scene.env;
  *e = (env){.kind = ENV_MAP, .scale = 1, .map = image_new(&w->mem, 32, 16)};
  for (int i = 0; i < 32 * 16; i++) {
    int x = i % 32, y = i / 32;
    bool west = x >= 6 && x < 10, east = x >= 23 && x < 25, high = y >= 5;
    bool bright = high && y < 7 && (west || east);
    e->map.pixels[i] = vec3_all(!bright ? 0.05f : west ? 60 : 6);
  }
  world_ready(w, 0);
  return w;
}

enum { WIDTH = 64, HEIGHT = 48 };

static void yard_walker(walker *k, world *w) {
  walker_ready(k, &w->path, 3, &w->mem);
  k->camera = (camera){NULL, {1.6f, 2, 1.9f}, {-0.2f, 0, 0}, {0, 1, 0}, 60};
  k->width = WIDTH, k->height = HEIGHT;
}

static bool learn(walker *k, pool *threads) {
  camera_view view;
  path_film lesson = walker_lesson(k, &view);
  return path_learn(&k->lights, &k->tracer, &lesson, k->mem, threads);
}

// The integral of light_pdf_env over the sphere.
static double sum_density(const light_set *l, vec3 p, vec3 n) {
  enum { W = 2048, H = 1024 };
  double sum = 0;
  for (int i = 0; i < W * H; i++) {
    vec2 uv = {((float)(i % W) + 0.5f) / W, ((float)(i / W) + 0.5f) / H};
    double sine = sin(3.14159265358979 * (double)uv.y);
    sum += (double)light_pdf_env(l, p, n, uv) * sine;
  }
  return sum * 2 * 9.869604401089358 / W / H;
}

// Whatever is remembered, the density of all directions is the probability to
// ask at all.
static void densities_add_up_to_what_is_asked(void **state) {
  (void)state;
  world *w = yard(NO_LAMPS);
  walker k;
  yard_walker(&k, w);
  assert_true(fabs(sum_density(&k.lights, BLACK, (vec3){0, 1, 0}) - 1) < 1e-3);
  assert_true(learn(&k, NULL));
  double least = 1;
  for (int i = 0; i < 8; i++) {
    vec3 p = {-1.8f + 0.5f * (float)i, 0, 0.3f}, n = {0, 1, 0};
    const light_memory *m = k.lights.memory;
    double asked = 0;
    for (uint32_t part = 0; part < m->count; part++)
      asked += (double)light_memory_share(m, light_memory_key(m, p, n), part);
    least = fmin(least, asked);
    assert_true(fabs(sum_density(&k.lights, p, n) / asked - 1) < 1e-3);
  }
  print_message("# asked with probability %.3f at least\n", least);
  world_free(w);
}

static void check_likeness(const render_result *a, const render_result *b,
                           const char *what) {
  likeness l = likeness_of(a, b, 8);
  print_message("# %s: z %.2f, mean square %.2f\n", what, l.z, l.square);
  assert_true(fabs(l.z) < 4);
  assert_true(l.square < 1.5);
}

// The same picture with memory and without, and by chance alone; and much less
// noise with it.
static void check_help(lamps lit) {
  world *w = yard(lit);
  walker k;
  yard_walker(&k, w);
  render_result plain = walker_draw(&k, 64, NULL);
  assert_true(learn(&k, NULL));
  assert_true(k.lights.sky.count > 0);
  render_result knowing = walker_draw(&k, 64, NULL);
  render_result naive = walker_draw_naive(&k, 512, 5);
  check_likeness(&plain, &knowing, "without memory");
  check_likeness(&naive, &knowing, "by chance alone");
  double before = noise_of(&plain, &plain), after = noise_of(&knowing, &plain);
  print_message("# noise %.3g and %.3g\n", before, after);
  assert_true(after < 0.5 * before);
  world_free(w);
}

static void memory_of_the_sky_helps(void **state) {
  (void)state;
  check_help(NO_LAMPS);
}

static void also_beside_lamps(void **state) {
  (void)state;
  check_help(MANY_LAMPS);
}

// Lies cost noise, but not light.
static void lies_do_no_harm(void **state) {
  (void)state;
  world *w = yard(NO_LAMPS);
  walker k;
  yard_walker(&k, w);
  render_result plain = walker_draw(&k, 64, NULL);
  light_memory *m =
      light_set_cut_sky(&k.lights, w->scene.lo, w->scene.hi, &w->mem, NULL);
  assert_non_null(m);
  light_record records[600];
  for (uint32_t i = 0; i < 600; i++) {
    vec3 p = {-2 + 0.4f * (float)(i % 10), 0, -2 + 0.4f * (float)(i / 10 % 10)};
    records[i] = (light_record){light_memory_key(m, p, (vec3){0, 1, 0}),
                                i % m->count, i % 7 == 3 ? 9 : 0, 1};
  }
  light_memory_learn(m, records, 600, &w->mem, NULL);
  k.lights.memory = m;
  render_result told = walker_draw(&k, 64, NULL);
  check_likeness(&plain, &told, "with lies");
  world_free(w);
}

static void same_memory(void **state) {
  (void)state;
  world *w = yard(NO_LAMPS);
  assert_same_lesson(w, yard_walker, learn);
  world_free(w);
}

// Whoever also does what adds nothing, such as shadow rays for black surfaces,
// remembers the same.
static void same_if_thorough(void **state) {
  (void)state;
  world *w = yard(MANY_LAMPS);
  render_result pictures[2];
  for (int i = 0; i < 2; i++) {
    w->path.thorough = i == 1;
    walker k;
    yard_walker(&k, w);
    assert_true(learn(&k, NULL));
    pictures[i] = walker_draw(&k, 2, NULL);
  }
  assert_same_bytes(&pictures[0], &pictures[1]);
  world_free(w);
}

// Where all see the same sky, nothing is remembered.
static void nothing_to_remember(void **state) {
  (void)state;
  world *w = yard(NO_LAMPS);
  w->scene.mesh.triangle_count = 2;
  world_ready(w, 0);
  walker k;
  yard_walker(&k, w);
  assert_false(learn(&k, NULL));
  assert_true(k.lights.memory == NULL);
  world_free(w);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(samples_of_parts_follow_their_density),
      cmocka_unit_test(densities_add_up_to_what_is_asked),
      cmocka_unit_test(memory_of_the_sky_helps),
      cmocka_unit_test(also_beside_lamps),
      cmocka_unit_test(lies_do_no_harm),
      cmocka_unit_test(same_memory),
      cmocka_unit_test(same_if_thorough),
      cmocka_unit_test(nothing_to_remember),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
