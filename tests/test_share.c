// test_share.c — paths of neighbours that share what they find: the same light
// as without, whoever else is asked, and less noise.

#include "aim_learn.h"
#include "share_learn.h"
#include "walkers.h"

enum { WIDTH = 48, HEIGHT = 32 };

static const vec3 BLACK = {0, 0, 0};

// A room with a lamp that shines at the wall behind it, or away from that, a
// matt ball and one of chrome.
static world *room_with_balls(bool away) {
  world *w = world_new();
  w->materials[0] = world_material(MATERIAL_BLINN_PHONG, vec3_all(0.7f), BLACK);
  w->materials[1] = world_material(MATERIAL_BLINN_PHONG, BLACK, BLACK);
  w->materials[1].ke = vec3_all(30);
  w->materials[2] =
      world_material(MATERIAL_BLINN_PHONG, (vec3){0.2f, 0.5f, 0.1f}, BLACK);
  w->materials[3] = world_material(MATERIAL_MIRROR, BLACK, vec3_all(0.9f));
  world_box(w, vec3_all(-1), vec3_all(1), true, 0);
  vec3 up = {0, 0.4f, 0}, along = {0, 0, 0.4f};
  world_quad(w, (vec3){-0.8f, -0.2f, -0.2f}, away ? up : along,
             away ? along : up, 1);
  world_ball(w, (vec3){0.2f, -0.7f, -0.4f}, 0.3f, 3, true, 2);
  world_ball(w, (vec3){-0.4f, -0.7f, 0.2f}, 0.25f, 3, true, 3);
  world_ready(w, 0);
  return w;
}

static void room_walker(walker *k, world *w) {
  walker_ready(k, &w->path, 3, &w->mem);
  k->camera =
      (camera){NULL, {0.8f, 0.3f, 0.9f}, {-0.2f, -0.4f, -0.3f}, {0, 1, 0}, 70};
  k->width = WIDTH, k->height = HEIGHT;
}

// The film that k draws, by a view that lives as long.
static path_film film_of(const walker *k, camera_view *view) {
  *view = walker_view(k, 1);
  return (path_film){view, k->width, k->height};
}

// By a lesson over a larger film: in this small one neighbours are far apart.
static bool learn(walker *k, pool *threads) {
  camera_view *view = ARENA_NEW(k->mem, camera_view, 1);
  path_film *on = ARENA_NEW(k->mem, path_film, 1);
  *on = film_of(k, view);
  enum { TIMES = 12 };
  camera_view large = walker_view(k, TIMES);
  path_film lesson = {&large, TIMES * k->width, TIMES * k->height};
  if (share_learn(&k->tracer, &lesson, threads)) k->tracer.film = on;
  return k->tracer.film != NULL;
}

// Sums over blocks of several pictures, which know nothing of each other as
// pixels of one that share do, and over all of each picture.
enum { PICTURES = 24, BLOCK = 8 };
enum { BLOCKS = WIDTH / BLOCK * (HEIGHT / BLOCK) };

typedef struct sums {
  double mean[BLOCKS + 1], variance[BLOCKS + 1];  // of the mean; all is last
} sums;

static void add_picture(sums *s, const image *p) {
  double block[BLOCKS + 1] = {0};
  for (int y = 0; y < HEIGHT; y++)
    for (int x = 0; x < WIDTH; x++) {
      double v = (double)p->pixels[y * WIDTH + x].y;
      block[y / BLOCK * (WIDTH / BLOCK) + x / BLOCK] += v;
      block[BLOCKS] += v;
    }
  for (int i = 0; i <= BLOCKS; i++) {
    s->mean[i] += block[i];
    s->variance[i] += block[i] * block[i];
  }
}

// The pictures are those of seeds from `seed` on.
static sums sums_of(walker *k, bool naive, int spp, uint64_t seed) {
  sums s = {0};
  for (uint64_t i = 0; i < PICTURES; i++) {
    k->tracer.seed = seed + i;
    render_result r = naive ? walker_draw_naive(k, spp, k->tracer.seed)
                            : walker_draw(k, spp, NULL);
    add_picture(&s, &r.color);
  }
  for (int i = 0; i <= BLOCKS; i++) {
    s.mean[i] /= PICTURES;
    s.variance[i] =
        (s.variance[i] / PICTURES - s.mean[i] * s.mean[i]) / (PICTURES - 1);
  }
  return s;
}

static void check_alike(const char *what, const sums *a, const sums *b) {
  double square = 0, worst = 0, z = 0;
  for (int i = 0; i <= BLOCKS; i++) {
    z = (a->mean[i] - b->mean[i]) / sqrt(a->variance[i] + b->variance[i]);
    if (i == BLOCKS) break;
    square += z * z / BLOCKS;
    worst = fmax(worst, fabs(z));
  }
  print_message("# %s: z %.2f, mean square of blocks %.2f, worst %.2f\n", what,
                z, square, worst);
  assert_true(fabs(z) < 4);
  assert_true(square < 2);
  assert_true(worst < 5);
}

// The same light as by one that shares nothing and by the naive walk: also
// where paths are short, sheets let some light through, and rays are aimed at
// chrome.
static void same_light(void **state) {
  (void)state;
  for (int turn = 0; turn < 4; turn++) {
    world *w = room_with_balls(turn == 3);
    uint64_t seed = 1 + (uint64_t)turn;
    if (turn == 1) w->path.max_depth = 3;
    if (turn == 2) {
      w->materials[2].d = 0.5f;
      w->materials[2].passes = true;
    }
    walker k;
    room_walker(&k, w);
    camera_view view;
    path_film on = film_of(&k, &view);
    camera_view large;
    path_film lesson = walker_lesson(&k, &large);
    if (turn == 3) k.tracer.aim = aim_learn(&k.tracer, &lesson, k.mem, NULL);
    assert_true(turn != 3 || k.tracer.aim != NULL);
    sums alone = sums_of(&k, false, 4, 100 * seed);
    k.tracer.film = &on;
    sums shared = sums_of(&k, false, 4, 100 * seed + 50);
    check_alike("shared and alone", &shared, &alone);
    if (turn == 2) {
      sums naive = sums_of(&k, true, 32, 77);
      check_alike("shared and naive", &shared, &naive);
    }
    world_free(w);
  }
}

// In a closed room whose walls emit 1 and reflect rho, max_depth n shows the
// first n terms of 1 + rho + rho^2 ... and no limit 1 / (1 - rho).
static void glowing_room(void **state) {
  (void)state;
  world *w = world_new();
  w->materials[0] = world_material(MATERIAL_BLINN_PHONG, vec3_all(0.8f), BLACK);
  w->materials[0].ke = vec3_all(1);
  world_box(w, vec3_all(-1), vec3_all(1), true, 0);
  world_ready(w, 0);
  walker k;
  room_walker(&k, w);
  camera_view view;
  path_film on = film_of(&k, &view);
  k.tracer.film = &on;
  double want = 0, term = 1;
  for (int depth = 1; depth <= 6; depth++, term *= 0.8) {
    w->path.max_depth = depth == 6 ? 0 : depth;
    want = depth == 6 ? 5 : want + term;
    sums s = sums_of(&k, false, 2, 1);
    double mean = s.mean[BLOCKS] / (WIDTH * HEIGHT);
    double spread = sqrt(s.variance[BLOCKS]) / (WIDTH * HEIGHT);
    print_message("# depth %d: %.5f +- %.5f, expected %.5f\n",
                  w->path.max_depth, mean, spread, want);
    assert_true(fabs(mean - want) < 4 * spread + 1e-5);
  }
  world_free(w);
}

// What is found for a sample of a pixel is the same whoever else is asked for:
// all, some in any order, one alone; and whether vertices are made ready or
// not.  Also of pixels of another film of that size.
static void company_does_not_show(void **state) {
  (void)state;
  world *w = room_with_balls(false);
  walker k;
  room_walker(&k, w);
  k.width = 27, k.height = 13;
  camera_view view;
  path_film on = film_of(&k, &view);
  k.tracer.film = &on;
  ready_function *ready = k.tracer.ready;
  enum { ALL = 27 * 13 };
  path_start starts[ALL], one;
  vec3 colors[ALL], again[ALL];
  path_stats stats = {0};
  void *room = k.by.room(k.by.self, k.mem);
  for (uint64_t turn = 0; turn < 4; turn++) {
    for (uint64_t i = 0; i < ALL; i++) {
      uint64_t at = i * 100 % ALL, pixel = at + turn % 2 * ALL;
      vec2 in = k.by.place(k.by.self, pixel, (uint32_t)turn);
      ray r =
          camera_ray(&view, (float)(at % 27) + in.x, (float)(at / 27) + in.y);
      starts[i] = (path_start){r, pixel, (uint32_t)turn};
    }
    k.by.radiance(k.by.self, starts, ALL, colors, &stats, room);
    k.tracer.ready = NULL;
    k.by.radiance(k.by.self, starts + 40, 100, again, &stats, room);
    assert_memory_equal(colors + 40, again, 100 * sizeof *again);
    k.tracer.ready = ready;
    for (int i = 0; i < ALL; i += 50) {
      one = starts[i];
      k.by.radiance(k.by.self, &one, 1, again, &stats, room);
      assert_memory_equal(&colors[i], again, sizeof *again);
    }
  }
  world_free(w);
}

static double noise(walker *k) {
  render_result r = walker_draw(k, 16, NULL);
  return noise_of(&r, &r);
}

// It is learned that sharing pays in a bright room, where it takes away more
// than half of the variance, by any number of threads; and that it does not
// under an open sky.
static void learned_where_it_pays(void **state) {
  (void)state;
  world *w = room_with_balls(false);
  w->materials[0].kd = vec3_all(0.9f);
  walker k;
  room_walker(&k, w);
  double alone = noise(&k);
  assert_true(learn(&k, NULL));
  double shared = noise(&k);
  print_message("# noise %.3g alone, %.3g shared\n", alone, shared);
  assert_true(shared < 0.5 * alone);
  assert_same_lesson(w, room_walker, learn);
  w->path.max_depth = 2;
  room_walker(&k, w);
  assert_false(learn(&k, NULL));
  world_free(w);
  w = world_new();
  w->materials[0] = world_material(MATERIAL_BLINN_PHONG, vec3_all(0.7f), BLACK);
  w->scene.env = (env){.kind = ENV_CONSTANT, .constant = {1, 1, 1}, .scale = 1};
  world_quad(w, (vec3){-9, -1, 9}, (vec3){18, 0, 0}, (vec3){0, 0, -18}, 0);
  world_ball(w, (vec3){0.2f, -0.7f, -0.4f}, 0.3f, 3, true, 0);
  world_ready(w, 0);
  room_walker(&k, w);
  assert_false(learn(&k, NULL));
  world_free(w);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(same_light),
      cmocka_unit_test(glowing_room),
      cmocka_unit_test(company_does_not_show),
      cmocka_unit_test(learned_where_it_pays),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
