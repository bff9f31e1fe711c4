// test_path_mis.c — the integrator that looks for lights: scenes whose light is
// known, and the same pictures as the naive one.

#include "walkers.h"

static const vec3 WHITE = {1, 1, 1}, BLACK = {0, 0, 0};

// The mean of n samples along one ray over several pixels' numbers, with the
// standard error of the mean of those means, which are independent.
static estimate mean_along(world *w, sampler_kind kind, ray r, size_t n) {
  enum { PIXELS = 64 };
  walker k;
  walker_ready(&k, &w->path, 5, &w->mem);
  k.tracer.sampler = kind;
  void *room = k.by.room(k.by.self, &w->mem);
  path_start *starts = ARENA_NEW(&w->mem, path_start, n);
  vec3 *out = ARENA_NEW(&w->mem, vec3, n);
  path_stats stats = {0};
  double sum = 0, sum2 = 0;
  for (uint64_t pixel = 0; pixel < PIXELS; pixel++) {
    double mean = 0;
    for (size_t i = 0; i < n; i++)
      starts[i] = (path_start){r, pixel, (uint32_t)i};
    for (size_t i = 0; i < n; i += INTEGRATOR_BATCH) {
      size_t m = n - i < INTEGRATOR_BATCH ? n - i : INTEGRATOR_BATCH;
      k.by.radiance(k.by.self, starts + i, m, out + i, &stats, room);
    }
    for (size_t i = 0; i < n; i++)
      mean += (double)out[i].x / (double)n;
    sum += mean;
    sum2 += mean * mean;
  }
  double mean = sum / PIXELS;
  double variance = fmax(sum2 / PIXELS - mean * mean, 0);
  assert_int_equal(stats.cut, 0);
  return (estimate){mean, sqrt(variance / (PIXELS - 1))};
}

static void check(const char *what, estimate e, double want) {
  double z = (e.mean - want) / (e.error + 1e-6 * want);
  print_message("# %s: %.6f +- %.6f, expected %.6f, z = %.2f\n", what, e.mean,
                e.error, want, z);
  assert_true(fabs(z) < 4);
}

static void add_floor(world *w, uint32_t of) {
  world_quad(w, (vec3){-50, 0, 50}, (vec3){100, 0, 0}, (vec3){0, 0, -100}, of);
}

// A lamp of 2 x 1 at height 1.2 above the floor gives E = pi L F with the
// form factor of a rectangle; a point light of 3 W/sr beside it adds
// I cos / d^2, and a far one its E cos.
static void lamp(void **state) {
  (void)state;
  for (sampler_kind kind = SAMPLER_SOBOL; kind <= SAMPLER_RANDOM; kind++) {
    world *w = world_new();
    w->materials[0] =
        world_material(MATERIAL_BLINN_PHONG, vec3_all(0.5f), BLACK);
    w->materials[1] = world_material(MATERIAL_BLINN_PHONG, BLACK, BLACK);
    w->materials[1].ke = vec3_all(7);
    add_floor(w, 0);
    world_quad(w, (vec3){-1, 1.2f, -0.5f}, (vec3){2, 0, 0}, (vec3){0, 0, 1}, 1);
    w->lights[0] = (light){LIGHT_POINT, {3, 1, 0}, vec3_all(3)};
    w->lights[1] = (light){LIGHT_DIR, {-0.8f, -0.6f, 0}, vec3_all(2)};
    world_ready(w, 2);
    double lamp = 0.5 * 7 * 4 * corner_factor(1, 0.5, 1.2);
    double lights = 0.5 / 3.141592653589793 * (3 / sqrt(1000) + 2 * 0.6);
    ray r = ray_from((vec3){0, 0.5f, -2}, (vec3){0, -0.5f, 2});
    check("lamp and lights", mean_along(w, kind, r, 1024), lamp + lights);
    w->path.lights = false;
    check("lamp alone", mean_along(w, kind, r, 1024), lamp);
    ray above = ray_from((vec3){0, 5, 0}, (vec3){0, -1, 0});
    assert_true(mean_along(w, kind, above, 1).mean == 0);
    world_free(w);
  }
}

// Under a uniform sky with a black ball of radius R, centre at height h and
// distance d, the floor receives E = pi L (1 - R^2 h / d^3).
static void black_ball(void **state) {
  (void)state;
  for (float x = 0; x < 3.5f; x += 1) {
    world *w = world_new();
    w->materials[0] = world_material(MATERIAL_BLINN_PHONG, WHITE, BLACK);
    w->materials[1] = world_material(MATERIAL_BLINN_PHONG, BLACK, BLACK);
    w->scene.env =
        (env){.kind = ENV_CONSTANT, .constant = {1, 1, 1}, .scale = 1};
    add_floor(w, 0);
    world_ball(w, (vec3){0, 1.5f, 0}, 1, 5, false, 1);
    world_ready(w, 0);
    float d2 = x * x + 1.5f * 1.5f;
    ray r = ray_from((vec3){x, 0.3f, -3}, (vec3){0, -0.3f, 3});
    check("black ball", mean_along(w, SAMPLER_RANDOM, r, 2048),
          1 - 1.5 / pow((double)d2, 1.5));
    world_free(w);
  }
}

// In a closed room whose walls emit 1 and reflect rho the radiance is 1 / (1 -
// rho) everywhere; max_depth n shows the first n terms of 1 + rho + rho^2 ...
static void glowing_room(void **state) {
  (void)state;
  world *w = world_new();
  w->materials[0] = world_material(MATERIAL_BLINN_PHONG, vec3_all(0.9f), BLACK);
  w->materials[0].ke = vec3_all(1);
  world_box(w, vec3_all(-1), vec3_all(1), true, 0);
  world_ready(w, 0);
  ray r = ray_from((vec3){0.2f, 0.1f, 0.3f}, (vec3){0.36f, 0.48f, 0.8f});
  check("room", mean_along(w, SAMPLER_SOBOL, r, 1024), 10);
  double want = 0, term = 1;
  for (int depth = 1; depth <= 4; depth++, term *= 0.9) {
    w->path.max_depth = depth;
    want += term;
    check("room to a depth", mean_along(w, SAMPLER_RANDOM, r, 1024), want);
  }
  world_free(w);
}

// Two sheets of opacity 0.4 before a lamp let 0.36 of its light through, looked
// at and to the floor.
static void sheets(void **state) {
  (void)state;
  world *w = world_new();
  w->materials[0] = world_material(MATERIAL_BLINN_PHONG, vec3_all(0.5f), BLACK);
  w->materials[1] = world_material(MATERIAL_BLINN_PHONG, BLACK, BLACK);
  w->materials[1].ke = vec3_all(7);
  w->materials[2] = world_material(MATERIAL_BLINN_PHONG, BLACK, BLACK);
  w->materials[2].d = 0.4f;
  w->materials[2].passes = true;
  add_floor(w, 0);
  world_quad(w, (vec3){-1, 1.2f, -0.5f}, (vec3){2, 0, 0}, (vec3){0, 0, 1}, 1);
  for (int i = 0; i < 2; i++)
    world_quad(w, (vec3){-9, 0.4f + 0.2f * (float)i, -9}, (vec3){18, 0, 0},
               (vec3){0, 0, 18}, 2);
  w->lights[0] = (light){LIGHT_POINT, {3, 1, 0}, vec3_all(3)};
  world_ready(w, 1);
  double lamp = 0.5 * 7 * 4 * corner_factor(1, 0.5, 1.2);
  double point = 0.5 / 3.141592653589793 * 3 / sqrt(1000);
  ray r = ray_from((vec3){0, 0.2f, -2}, (vec3){0, -0.2f, 2});
  check("under sheets", mean_along(w, SAMPLER_RANDOM, r, 4096),
        0.36 * (lamp + point));
  ray up = ray_from((vec3){0, 0.2f, 0}, (vec3){0, 1, 0});
  check("through sheets", mean_along(w, SAMPLER_RANDOM, up, 4096), 0.36 * 7);
  world_free(w);
}

// A dark floor of opacity d shows d of its albedo and 1 - d of what is below:
// chance that lets a path through and chance that ends it do not know of each
// other.
static void dark_sheet(void **state) {
  (void)state;
  world *w = world_new();
  w->scene.env =
      (env){.kind = ENV_CONSTANT, .constant = vec3_all(1), .scale = 1};
  w->materials[0] = world_material(MATERIAL_BLINN_PHONG, vec3_all(0.2f), BLACK);
  w->materials[0].d = 0.5f;
  w->materials[0].passes = true;
  add_floor(w, 0);
  world_ready(w, 0);
  ray down = ray_from((vec3){0, 1, 0}, (vec3){0.3f, -1, 0});
  check("dark sheet", mean_along(w, SAMPLER_SOBOL, down, 4096),
        0.5 * 0.2 + 0.5);
  world_free(w);
}

// A scene from its file, with a tree.
typedef struct set {
  arena mem;
  scene scene;
  bvh tree;
  path_world path;
} set;

enum { WIDTH = 48, HEIGHT = 36 };

static void set_load(set *s, const char *path) {
  report r = {.mem = &s->mem};
  error err;
  scene_options o = {0};
  assert_true(scene_load(&s->scene, path, &o, &s->mem, NULL, &r, &err));
  const mesh *m = &s->scene.mesh;
  bvh_build(&s->tree, m->positions, m->position_index,
            (uint32_t)m->triangle_count, BVH_SAH, &s->mem, NULL);
  s->path = (path_world){
      .scene = &s->scene, .tracer = bvh_tracer(&s->tree), .lights = true};
  s->path.dfg = matter_table(&s->scene, PBR_GGX, &s->mem, NULL);
}

static void set_walker(walker *k, set *s, sampler_kind kind, uint64_t seed) {
  walker_ready(k, &s->path, seed, &s->mem);
  k->tracer.sampler = kind;
  k->camera = *scene_camera(&s->scene, NULL);
  k->width = WIDTH, k->height = HEIGHT;
}

static const char *const scenes[] = {
    "scenes/cornell.scene",    "scenes/cornell-balls.scene",
    "scenes/furnace.scene",    "scenes/materials.scene",
    "scenes/terminator.scene", "scenes/garden.scene",
};

// The z-scores of the blocks of naive against new pictures look normal: none
// of 72 beyond 4, and their squares are about 1 each or, where variance is
// overestimated, less.
static void same_pictures(void **state) {
  (void)state;
  double squares = 0;
  int blocks = 0;
  for (size_t k = 0; k < sizeof scenes / sizeof *scenes; k++) {
    set s = {0};
    set_load(&s, scenes[k]);
    walker w;
    set_walker(&w, &s, SAMPLER_RANDOM, 77);
    int spp = (int)shortened(400);
    render_result naive = walker_draw_naive(&w, spp, 1);
    render_result mis = walker_draw(&w, (spp + 3) / 4, NULL);
    likeness l = likeness_of(&naive, &mis, 12);
    squares += l.square * l.blocks;
    blocks += l.blocks;
    print_message("# %s: worst z %.2f\n", scenes[k], l.worst);
    assert_true(l.worst < 4);
    arena_free(&s.mem);
  }
  print_message("# mean square %.2f of %d blocks\n", squares / blocks, blocks);
  assert_true(squares / blocks < 1.5);
}

// Neither threads nor the size of a batch show: the picture of 1, 2 and 7
// threads, and samples asked one by one.
static void same_bytes(void **state) {
  (void)state;
  set s = {0};
  set_load(&s, "scenes/cornell-balls.scene");
  walker w;
  set_walker(&w, &s, SAMPLER_SOBOL, 3);
  render_result first = walker_draw(&w, 5, NULL);
  for (int n = 2; n < 8; n += 5) {
    pool *threads = pool_new(&s.mem, n);
    render_result other = walker_draw(&w, 5, threads);
    assert_same_bytes(&first, &other);
    pool_free(threads);
  }
  camera_view view = walker_view(&w, 1);
  void *room = w.by.room(w.by.self, &s.mem);
  path_stats stats = {0};
  for (size_t i = 0; i < WIDTH * HEIGHT; i += 7) {
    double sum = 0;
    for (uint32_t k = 0; k < 5; k++) {
      vec2 at = w.by.place(w.by.self, i, k);
      ray r = camera_ray(&view, (float)(i % WIDTH) + at.x,
                         (float)(i / WIDTH) + at.y);
      path_start start = {r, i, k};
      vec3 one;
      w.by.radiance(w.by.self, &start, 1, &one, &stats, room);
      sum += (double)one.x;
    }
    assert_true((float)(sum / 5) == first.color.pixels[i].x);
  }
  arena_free(&s.mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lamp),         cmocka_unit_test(black_ball),
      cmocka_unit_test(glowing_room), cmocka_unit_test(sheets),
      cmocka_unit_test(dark_sheet),   cmocka_unit_test(same_pictures),
      cmocka_unit_test(same_bytes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
