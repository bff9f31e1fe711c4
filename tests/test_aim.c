// test_aim.c — rays aimed at lamps in mirrors and glass: the densities are
// those of the samples, the light is the same with and without them and with
// nonsense, and what a mirror shows is known.

#include "aim_learn.h"
#include "aim_photon.h"
#include "walkers.h"

enum { WIDTH = 48, HEIGHT = 36 };

static const vec3 BLACK = {0, 0, 0};

static void mirror_walker(walker *k, world *w, vec3 eye, vec3 target) {
  walker_ready(k, &w->path, 3, &w->mem);
  k->camera = (camera){NULL, eye, target, {0, 1, 0}, 50};
  k->width = WIDTH, k->height = HEIGHT;
}

static bool learn(walker *k, pool *threads) {
  camera_view view;
  path_film lesson = walker_lesson(k, &view);
  k->tracer.aim = aim_learn(&k->tracer, &lesson, k->mem, threads);
  return k->tracer.aim != NULL;
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
static estimate mean_along(const walker *k, ray r) {
  const size_t n = INTEGRATOR_BATCH;
  void *room = k->by.room(k->by.self, k->mem);
  path_start *starts = ARENA_NEW(k->mem, path_start, n);
  vec3 *out = ARENA_NEW(k->mem, vec3, n);
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
  mirror_walker(&k, w, (vec3){0, 0.8f, 4}, (vec3){0, 0, 0});
  ray r = ray_from((vec3){0, 0.5f, 2}, (vec3){0, -0.5f, -2});
  estimate plain = mean_along(&k, r);
  check("scattered", plain, want);
  assert_true(learn(&k, NULL));
  estimate aimed = mean_along(&k, r);
  check("aimed", aimed, want);
  assert_true(aimed.error < 0.2 * plain.error);
  aim_cell nonsense[1] = {some_cell()};
  nonsense[0].x[2] = 1.3f;
  nonsense[0].y[2] = 2.1f;
  aim_node nodes[LIGHT_SIDES];
  for (int i = 0; i < LIGHT_SIDES; i++)
    nodes[i] = (aim_node){0, AIM_LEAF, 0};
  static const float KEEN[] = {0.3f, 1, 3.7f, 100};
  for (int i = 0; i < 4; i++) {
    aim_map map = {nodes, nonsense, KEEN[i]};
    k.tracer.aim = &map;
    check("aimed at random", mean_along(&k, r), want);
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
  mirror_walker(k, w, (vec3){0, 1.6f, 1.9f}, (vec3){0, 0.8f, -1});
}

// The same light in each part of the picture as by the naive walk, with less
// than half of the variance that there is without aimed rays.
static void rooms_are_the_same(void **state) {
  (void)state;
  world *w = room_with_balls();
  walker k;
  room_walker(&k, w);
  render_result truth = walker_draw_naive(&k, (int)shortened(400), 3);
  render_result plain = walker_draw(&k, 100, NULL);
  assert_true(learn(&k, NULL));
  render_result aimed = walker_draw(&k, 100, NULL);
  likeness l = likeness_of(&aimed, &truth, 12);
  double noise = noise_of(&aimed, &aimed), before = noise_of(&plain, &plain);
  const int pixels = WIDTH * HEIGHT;
  print_message("# against naive z %.2f, blocks' mean square %.2f; noise %.3g, "
                "not aimed %.3g\n",
                l.z, l.square, noise / pixels, before / pixels);
  assert_int_equal(l.blank, 0);
  assert_true(fabs(l.z) < 4);
  assert_true(l.square < 2);
  assert_true(noise < 0.5 * before);
  world_free(w);
}

// The power that comes down, and how uncertain its sum is.
static estimate power_of(const aim_photons *all) {
  double sum = 0, sum2 = 0;
  for (size_t i = 0; i < all->count; i++) {
    double power = (double)all->of[i].power / all->tries;
    sum += power, sum2 += power * power;
  }
  return (estimate){sum, sqrt(sum2)};
}

// Photons that begin only where the first of them came from stand for the same
// power as photons from everywhere, and more of their tries come down.
static void photons_follow_the_first(void **state) {
  (void)state;
  enum { FIRST = 8192, TRIES = 65536, PART = TRIES / AIM_STRETCHES };
  world *w = room_with_balls();
  walker k;
  room_walker(&k, w);
  const aim_mirrors *m = aim_mirrors_of(&w->path, &k.lights, k.mem);
  assert_non_null(m);
  const aim_tries t = {1, 0, FIRST}, rest = {1, FIRST, TRIES};
  const aim_tries even = {2, 0, TRIES};
  aim_photons first = aim_photons_of(m, &t, k.mem, NULL);
  aim_photons all = aim_photons_more(m, &first, &rest, k.mem, NULL);
  aim_photons by = aim_photons_of(m, &even, k.mem, NULL);
  size_t lit = 0;
  bool known[AIM_STRETCHES][2] = {{false}};
  for (size_t i = 0; i < first.count; i++)
    known[first.of[i].stretch][first.of[i].behind] = true;
  for (int i = 0; i < AIM_STRETCHES; i++)
    lit += known[i][0] || known[i][1];
  for (size_t i = 0; i < all.count; i++)
    assert_true(known[all.of[i].stretch][all.of[i].behind]);
  for (size_t i = 0; i < first.count; i++)
    assert_memory_equal(&all.of[i].x, &first.of[i].x, sizeof(vec3));
  estimate a = power_of(&all), b = power_of(&by), c = power_of(&first);
  print_message("# %zu of %d stretches, power %.4f +- %.4f, first %.4f, evenly "
                "%.4f +- %.4f; photons %zu and %zu\n",
                lit, AIM_STRETCHES, a.mean, a.error, c.mean, b.mean, b.error,
                all.count, by.count);
  assert_true(lit < AIM_STRETCHES * 3 / 4);
  assert_true(fabs(all.tries - TRIES) < PART);
  assert_true(fabs((double)all.count / (double)by.count - 1) < 0.05);
  assert_true(fabs(a.mean - b.mean) <
              4 * sqrt(a.error * a.error + b.error * b.error));
  assert_true(fabs(a.mean - c.mean) < 4 * c.error);
  world_free(w);
}

static void same_map(void **state) {
  (void)state;
  world *w = room_with_balls();
  assert_same_lesson(w, room_walker, learn);
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
    assert_false(learn(&k, NULL));
    world_free(w);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(densities_are_those_of_samples),
      cmocka_unit_test(mirrored_lamps_shine),
      cmocka_unit_test(rooms_are_the_same),
      cmocka_unit_test(photons_follow_the_first),
      cmocka_unit_test(same_map),
      cmocka_unit_test(nothing_to_aim_at),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
