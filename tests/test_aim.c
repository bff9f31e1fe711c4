// test_aim.c — rays aimed at lamps in mirrors and glass: the densities are
// those of the samples, the light is the same with and without them and with
// nonsense, and what a mirror shows is known.

#include "aim_learn.h"
#include "ready.h"
#include "worlds.h"

#include <string.h>

enum { WIDTH = 48, HEIGHT = 36 };

static const vec3 BLACK = {0, 0, 0};

// A walker of a world, and the film that it learns from.
typedef struct walker {
  light_set lights;
  path_tracer tracer;
  integrator by;
  camera_view view, lesson;
} walker;

enum { LESSON = 4 };  // times the film

static void walker_ready(walker *k, world *w, vec3 eye, vec3 target) {
  k->view = world_view(eye, target, 50, WIDTH, HEIGHT);
  k->lesson = world_view(eye, target, 50, LESSON * WIDTH, LESSON * HEIGHT);
  light_set_build(&k->lights, &w->scene, w->path.lights, true, &w->mem, NULL);
  k->tracer = (path_tracer){.world = &w->path,
                            .lights = &k->lights,
                            .ready = ready_best(),
                            .seed = 3};
  k->by = path_integrator(&k->tracer);
}

static bool learn(walker *k, world *w, pool *threads) {
  path_lesson l = {&k->lesson, LESSON * WIDTH, LESSON * HEIGHT};
  k->tracer.aim = aim_learn(&k->tracer, &l, &w->mem, threads);
  return k->tracer.aim != NULL;
}

static render_result draw(world *w, const walker *k, int spp, pool *threads) {
  render_settings how = {.width = WIDTH,
                         .height = HEIGHT,
                         .spp = spp,
                         .seed = 3,
                         .by = &k->by,
                         .aovs = RENDER_AOV_VARIANCE};
  render_result r;
  render_run(&r, &w->path, &k->view, &how, &w->mem, threads);
  assert_int_equal(r.non_finite, 0);
  return r;
}

// Three spheres, of which two overlap; and one that o may be inside of.
static aim_cell some_cell(void) {
  return (aim_cell){.count = 3,
                    .root = 1,
                    .least = 0.01f,
                    .upto = {0.5f, 0.8f, 1},
                    .x = {1, 1.2f, -2},
                    .y = {1, 1, 0.5f},
                    .z = {0, 0.1f, 1},
                    .radius = {0.4f, 0.3f, 0.8f}};
}

// Means over the samples are means over all directions, weighed by the density.
static void densities_are_those_of_samples(void **state) {
  (void)state;
  const long n = shortened(200000);
  static const vec3 FROM[] = {{0, 0, 0}, {-2.1f, 0.6f, 1.2f}, {6, 3, 0}};
  aim_cell c = some_cell();
  for (int place = 0; place < 3; place++) {
    vec3 o = FROM[place];
    double sums[2][5][2] = {{{0}}};
    for (long i = 0; i < n; i++) {
      rng r = rng_of(7, (uint64_t)place, (uint64_t)i);
      vec3 u = {rng_next(&r), rng_next(&r), rng_next(&r)};
      float z = 1 - 2 * rng_next(&r), turn = 2 * PI * rng_next(&r), pdf;
      float flat = sqrtf(1 - z * z);
      vec3 all = {flat * cosf(turn), flat * sinf(turn), z};
      vec3 wi = aim_sample(&c, o, u, &pdf);
      assert_true(fabsf(vec3_length(wi) - 1) < 1e-5f && pdf > 0);
      float weight = 4 * PI * aim_pdf(&c, o, all);
      for (int k = 0; k < 2; k++) {
        vec3 d = k == 0 ? wi : all;
        const float f[5] = {1, d.x, d.y, d.x * d.z, d.z * d.z};
        for (int m = 0; m < 5; m++) {
          double x = (double)(f[m] * (k == 0 ? 1 : weight));
          sums[k][m][0] += x, sums[k][m][1] += x * x;
        }
      }
    }
    for (int m = 0; m < 5; m++) {
      double mean[2], spread = 0;
      for (int k = 0; k < 2; k++) {
        mean[k] = sums[k][m][0] / (double)n;
        spread += (sums[k][m][1] / (double)n - mean[k] * mean[k]) / (double)n;
      }
      double z = (mean[0] - mean[1]) / sqrt(spread);
      print_message("# from %d: %.5f, %.5f, z = %.2f\n", place, mean[0],
                    mean[1], z);
      assert_true(fabs(z) < 4);
    }
  }
}

// Share of the hemisphere's projected solid angle of the rectangle a x b at
// height h with a corner straight above.
static double corner_factor(double a, double b, double h) {
  double x = a / h, y = b / h, p = sqrt(1 + x * x), q = sqrt(1 + y * y);
  return (x / p * atan(y / p) + y / q * atan(x / q)) / (2 * 3.141592653589793);
}

// A lamp of 0.5 x 0.4 at height 1 that shines up, at a mirror at height 2: the
// floor, which it does not shine on, sees it at height 3.
static world *mirrored_lamp(double *radiance) {
  world *w = world_new();
  w->materials[0] = world_material(MATERIAL_BLINN_PHONG, vec3_all(0.5f), BLACK);
  w->materials[1] = world_material(MATERIAL_MIRROR, BLACK, vec3_all(0.9f));
  w->materials[2] = world_material(MATERIAL_BLINN_PHONG, BLACK, BLACK);
  w->materials[2].ke = vec3_all(20);
  world_quad(w, (vec3){-9, 0, 9}, (vec3){18, 0, 0}, (vec3){0, 0, -18}, 0);
  world_quad(w, (vec3){-3, 2, -3}, (vec3){6, 0, 0}, (vec3){0, 0, 6}, 1);
  world_quad(w, (vec3){2, 1, 0.2f}, (vec3){0.5f, 0, 0}, (vec3){0, 0, -0.4f}, 2);
  world_ready(w, 0);
  w->path.max_depth = 3;
  double share = corner_factor(2.5, 0.2, 3) - corner_factor(2, 0.2, 3);
  *radiance = 0.5 * 0.9 * 20 * 2 * share;
  return w;
}

// The mean of samples along one ray, of whom each pixel has its own.
static estimate mean_along(world *w, const walker *k, ray r) {
  const size_t n = INTEGRATOR_BATCH;
  void *room = k->by.room(k->by.self, &w->mem);
  path_start *starts = ARENA_NEW(&w->mem, path_start, n);
  vec3 *out = ARENA_NEW(&w->mem, vec3, n);
  path_stats stats = {0};
  double sum = 0, sum2 = 0;
  const long batches = shortened(128);
  for (long b = 0; b < batches; b++) {
    for (size_t i = 0; i < n; i++)
      starts[i] = (path_start){r, (uint64_t)b * n + i, 0};
    k->by.radiance(k->by.self, starts, n, out, &stats, room);
    for (size_t i = 0; i < n; i++) {
      sum += (double)out[i].x;
      sum2 += (double)(out[i].x * out[i].x);
    }
  }
  double all = (double)batches * (double)n, mean = sum / all;
  return (estimate){mean, sqrt((sum2 / all - mean * mean) / all)};
}

static void check(const char *what, estimate e, double want) {
  double z = (e.mean - want) / e.error;
  print_message("# %s: %.6f +- %.6f, expected %.6f, z = %.2f\n", what, e.mean,
                e.error, want, z);
  assert_true(fabs(z) < 4);
}

// What the floor gets from a lamp in a mirror is what it would get from the
// lamp behind it: without aimed rays, with them, and with rays that nonsense
// aims.
static void mirrored_lamps_shine(void **state) {
  (void)state;
  double want;
  world *w = mirrored_lamp(&want);
  walker k;
  walker_ready(&k, w, (vec3){0, 0.8f, 4}, (vec3){0, 0, 0});
  ray r = ray_from((vec3){0, 0.5f, 2}, (vec3){0, -0.5f, -2});
  estimate plain = mean_along(w, &k, r);
  check("scattered", plain, want);
  assert_true(learn(&k, w, NULL));
  estimate aimed = mean_along(w, &k, r);
  check("aimed", aimed, want);
  assert_true(aimed.error < 0.2 * plain.error);
  aim_cell nonsense[1] = {some_cell()};
  nonsense[0].x[2] = 1.3f;
  nonsense[0].y[2] = 2.1f;
  aim_node nodes[AIM_SIDES];
  for (int i = 0; i < AIM_SIDES; i++)
    nodes[i] = (aim_node){0, AIM_LEAF, 0};
  static const float KEEN[] = {0.3f, 1, 3.7f, 100};
  for (int i = 0; i < 4; i++) {
    aim_map map = {nodes, nonsense, KEEN[i]};
    k.tracer.aim = &map;
    check("aimed at random", mean_along(w, &k, r), want);
  }
  world_free(w);
}

// A closed room with a lamp, a mirror ball and a glass ball.
static world *room_with_balls(void) {
  world *w = world_new();
  w->materials[0] = world_material(MATERIAL_BLINN_PHONG, vec3_all(0.6f), BLACK);
  w->materials[1] = world_material(MATERIAL_MIRROR, BLACK, vec3_all(0.9f));
  w->materials[2] = world_material(MATERIAL_GLASS, BLACK, vec3_all(1));
  w->materials[3] = world_material(MATERIAL_BLINN_PHONG, BLACK, BLACK);
  w->materials[3].ke = (vec3){9, 8, 7};
  world_box(w, (vec3){-2, 0, -2}, (vec3){2, 3, 2}, true, 0);
  world_ball(w, (vec3){-0.8f, 0.7f, -0.6f}, 0.7f, 4, true, 1);
  world_ball(w, (vec3){0.8f, 0.7f, 0.3f}, 0.7f, 4, true, 2);
  world_quad(w, (vec3){-0.4f, 2.9f, -0.4f}, (vec3){0.8f, 0, 0},
             (vec3){0, 0, 0.8f}, 3);
  world_ready(w, 0);
  w->path.max_depth = 12;
  return w;
}

static void room_walker(walker *k, world *w) {
  walker_ready(k, w, (vec3){0, 1.6f, 1.9f}, (vec3){0, 0.8f, -1});
}

// The sum of differences of two pictures over their standard error, and the
// mean square of that over blocks.
static void compare(const render_result *a, const render_result *b, double *z,
                    double *square) {
  double difference = 0, variance = 0;
  int blocks = 0;
  *square = 0;
  for (size_t y = 0; y < HEIGHT; y += 12)
    for (size_t x = 0; x < WIDTH; x += 12) {
      double d = 0, v = 0;
      for (size_t i = 0; i < 144; i++) {
        size_t at = (y + i / 12) * WIDTH + x + i % 12;
        d += (double)(a->color.pixels[at].y - b->color.pixels[at].y);
        v += (double)(a->aov[3].pixels[at].y + b->aov[3].pixels[at].y);
      }
      difference += d;
      variance += v;
      *square += d * d / v;
      blocks++;
    }
  *z = difference / sqrt(variance);
  *square /= blocks;
}

static double noise_of(const render_result *r) {
  double sum = 0;
  for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
    double mean = (double)r->color.pixels[i].y;
    sum += (double)r->aov[3].pixels[i].y / (mean * mean + 0.01);
  }
  return sum / (WIDTH * HEIGHT);
}

// The same light in each part of the picture as by the naive walk, with less
// than half of the variance that there is without aimed rays.
static void rooms_are_the_same(void **state) {
  (void)state;
  world *w = room_with_balls();
  walker k;
  room_walker(&k, w);
  path_naive naive = {&w->path, 3};
  integrator by = k.by;
  k.by = path_naive_integrator(&naive);
  render_result truth = draw(w, &k, (int)shortened(400), NULL);
  k.by = by;
  render_result plain = draw(w, &k, 100, NULL);
  assert_true(learn(&k, w, NULL));
  render_result aimed = draw(w, &k, 100, NULL);
  double z, square;
  compare(&aimed, &truth, &z, &square);
  print_message("# against naive z %.2f, blocks' mean square %.2f; noise %.3g, "
                "not aimed %.3g\n",
                z, square, noise_of(&aimed), noise_of(&plain));
  assert_true(fabs(z) < 4);
  assert_true(square < 2);
  assert_true(noise_of(&aimed) < 0.5 * noise_of(&plain));
  world_free(w);
}

// Threads do not show.
static void same_map(void **state) {
  (void)state;
  world *w = room_with_balls();
  render_result pictures[2];
  for (int i = 0; i < 2; i++) {
    walker k;
    room_walker(&k, w);
    pool *threads = pool_new(&w->mem, i == 0 ? 1 : 7);
    assert_true(learn(&k, w, threads));
    pictures[i] = draw(w, &k, 2, threads);
    pool_free(threads);
  }
  assert_memory_equal(pictures[0].color.pixels, pictures[1].color.pixels,
                      WIDTH * HEIGHT * sizeof(vec3));
  world_free(w);
}

// Without a mirror, without a lamp that is seen in one, or where paths end
// before they could: nothing is aimed.
static void nothing_to_aim_at(void **state) {
  (void)state;
  for (int i = 0; i < 4; i++) {
    world *w = room_with_balls();
    if (i == 0) w->materials[1] = w->materials[2] = w->materials[0];
    if (i == 1) {
      w->materials[3].ke = BLACK;
      w->lights[0] = (light){LIGHT_POINT, {0, 2.5f, 0}, vec3_all(5)};
      w->scene.light_count = 1;
      w->path.lights = true;
    }
    if (i == 2) {
      w->materials[3].ke = BLACK;
      w->scene.env = (env){ENV_CONSTANT, .constant = {1, 1, 1}, .scale = 1};
    }
    if (i == 3) w->path.max_depth = 2;
    walker k;
    room_walker(&k, w);
    assert_false(learn(&k, w, NULL));
    world_free(w);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(densities_are_those_of_samples),
      cmocka_unit_test(mirrored_lamps_shine),
      cmocka_unit_test(rooms_are_the_same),
      cmocka_unit_test(same_map),
      cmocka_unit_test(nothing_to_aim_at),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
