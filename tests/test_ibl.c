// test_ibl.c — light from environments against closed forms and against the
// sum over all texels; the cache.

#include "cache_folder.h"
#include "ibl.h"
#include "ibl_cache.h"
#include "ibl_methods.h"
#include "num.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

// All levels that the goals name.
static const float ROUGHNESS[] = {0.1f, 0.2f, 0.35f, 0.5f, 0.6f, 0.75f, 1};

enum { ROUGHNESSES = 7 };

static ibl_need need_all(pbr_model model) {
  return (ibl_need){.model = model,
                    .diffuse = true,
                    .roughness = ROUGHNESS,
                    .count = ROUGHNESSES};
}

// The i-th of n directions of a spiral over the sphere.
static vec3 spiral(int i, int n) {
  float turn = (float)i * 0.61803399f, y = 1 - (2 * (float)i + 1) / (float)n;
  vec2 around = num_circle(turn - floorf(turn));
  float r = sqrtf(1 - y * y);
  return (vec3){r * around.x, y, r * around.y};
}

// A map of 1024 x 512 texels (fewer in a hurry) of f at their middles.
static env map_of(float (*f)(vec3 d), arena *mem) {
  int h = getenv("FACET_QUICK") != NULL ? 256 : 512;
  env e = {.kind = ENV_MAP, .map = image_new(mem, 2 * h, h), .scale = 1};
  for (int y = 0; y < h; y++)
    for (int x = 0; x < 2 * h; x++) {
      vec2 uv = {((float)x + 0.5f) / (float)(2 * h),
                 ((float)y + 0.5f) / (float)h};
      e.map.pixels[y * 2 * h + x] = vec3_all(f(env_direction(uv)));
    }
  return e;
}

static float white(vec3 d) {
  (void)d;
  return 1;
}

// The cosine to an axis, and nothing behind it.
static float cosine_lobe(vec3 d) {
  return fmaxf(0.48f * d.x + 0.6f * d.y - 0.64f * d.z, 0);
}

static float gradient(vec3 d) {
  return 1 + 0.9f * d.y;
}

// Five degrees across.
static float broad_sun(vec3 d) {
  return 0.48f * d.x + 0.6f * d.y - 0.64f * d.z > 0.99905f ? 1000 : 0;
}

// 0.27 degrees from its middle to its rim, as the real one: of texels of a
// third of a degree.
static float small_sun(vec3 d) {
  return 0.48f * d.x + 0.6f * d.y - 0.64f * d.z > 0.9999889f ? 5e4f : 0;
}

static float sky_and_sun(vec3 d) {
  float c = 0.48f * d.x + 0.6f * d.y - 0.64f * d.z;
  return (d.y > 0 ? 0.3f + 0.7f * d.y : 0.2f) + (c > 0.99999f ? 1.6e5f : 0);
}

static float million(vec3 d) {
  return 0.48f * d.x + 0.6f * d.y - 0.64f * d.z > 0.99998f ? 1e6f : 1e-3f;
}

// Under L = 1 the irradiance is pi and every mean is 1, to 1e-5; under a
// gradient 1 + g y, E = pi (1 + 2/3 g y), and a lobe's mean is 1 + k g y with
// its own k.
static void closed_forms(void **state) {
  (void)state;
  arena mem = {0};
  env e = map_of(white, &mem), g = map_of(gradient, &mem);
  env flat = {.kind = ENV_CONSTANT, .constant = {1, 1, 1}, .scale = 1};
  ibl white_map, slope, constant;
  ibl_need need = need_all(PBR_GGX);
  ibl_make(&white_map, &e, &need, &mem, NULL);
  ibl_make(&constant, &flat, &need, &mem, NULL);
  ibl_make(&slope, &g, &need, &mem, NULL);
  for (int i = 0; i < 200; i++) {
    vec3 d = spiral(i, 200);
    assert_true(fabsf(ibl_irradiance(&white_map, d).x - PI) < 1e-5f);
    assert_true(fabsf(ibl_irradiance(&constant, d).y - PI) < 1e-5f);
    float expected = PI * (1 + 0.6f * d.y);
    assert_true(fabsf(ibl_irradiance(&slope, d).z - expected) < 1e-4f);
    for (int k = 0; k < ROUGHNESSES; k++) {
      float r = ROUGHNESS[k];
      assert_true(fabsf(ibl_radiance(&white_map, d, r).x - 1) < 1e-5f);
      assert_true(fabsf(ibl_radiance(&constant, d, r).x - 1) < 1e-5f);
      float up = ibl_radiance(&slope, (vec3){0, 1, 0}, r).x - 1;
      float here = ibl_radiance(&slope, d, r).x - 1;
      if (!(fabsf(here - up * d.y) < 1e-4f && up > 0.1f && up < 0.9f))
        fail_msg("roughness %g: %g at height %g, %g at 1", (double)r,
                 (double)here, (double)d.y, (double)up);
    }
  }
  arena_free(&mem);
}

// Directions near the light and all around, n of them.
static vec3 probe(int i, int n, float width) {
  vec3 d = spiral(i, n), axis = {0.48f, 0.6f, -0.64f};
  return i % 2 == 0 ? d : vec3_unit(vec3_mad(axis, width, d));
}

// The largest difference to the sum over all texels, over the largest value;
// that of the tree of blocks is no more than a fiftieth.
static double distance_to_sum(const ibl *b, ibl_methods *m, float roughness,
                              pbr_model model) {
  int n = getenv("FACET_QUICK") != NULL ? 4 : 24;
  bool matt = roughness < 0;
  double worst = 0, peak = 0, tree = 0;
  ibl_methods_aim(m, matt ? lobe_cosine() : lobe_rough(model, roughness));
  for (int i = 0; i < n; i++) {
    vec3 d = probe(i, n, matt ? 1 : 2 * roughness * roughness);
    double want = (double)ibl_method_at(m, IBL_BRUTE_FORCE, d).x;
    vec3 got = matt ? ibl_irradiance(b, d) : ibl_radiance(b, d, roughness);
    assert_true(vec3_finite(got) && got.x >= 0);
    worst = fmax(worst, fabs((double)got.x - want));
    peak = fmax(peak, want);
    double blocks = (double)ibl_method_at(m, IBL_TREE, d).x;
    tree = fmax(tree, fabs(blocks - want));
  }
  if (!(tree < 2e-2 * peak)) fail_msg("tree of blocks: %g", tree / peak);
  return worst / peak;
}

// Every prepared sum, as it is looked up, is that over all texels: for skies,
// broad suns and small ones, by both sets of formulas.  Of the largest value
// irradiance is within 3e-4, radiance within 5e-4, under small suns within
// 3e-3, and at roughness 0.1 within 2e-2.
static void sums_are_the_sums_over_texels(void **state) {
  (void)state;
  float (*const skies[])(vec3) = {white,     cosine_lobe, gradient,
                                  broad_sun, small_sun,   sky_and_sun};
  for (int s = 0; s < 6; s++) {
    arena mem = {0};
    env e = map_of(skies[s], &mem);
    bool sharp = s >= 4;
    pbr_model model = s % 2 == 0 ? PBR_GGX : PBR_REPORT;
    ibl b;
    ibl_methods m;
    ibl_need need = need_all(model);
    ibl_make(&b, &e, &need, &mem, NULL);
    ibl_methods_open(&m, &e, &mem, NULL);
    double matt = distance_to_sum(&b, &m, -1, model);
    print_message("# sky %d: irradiance %.1e", s, matt);
    if (!(matt < 3e-4)) fail_msg("sky %d, irradiance: %g", s, matt);
    for (int k = 0; k < ROUGHNESSES; k++) {
      double goal = ROUGHNESS[k] < 0.2f ? 2e-2 : sharp ? 3e-3 : 5e-4;
      double far = distance_to_sum(&b, &m, ROUGHNESS[k], model);
      if (!(far < goal))
        fail_msg("sky %d, roughness %g: %g", s, (double)ROUGHNESS[k], far);
      print_message(", %g: %.1e", (double)ROUGHNESS[k], far);
    }
    print_message("\n");
    arena_free(&mem);
  }
}

// A sun of a million: finite and not negative anywhere, and falling off from
// the sun on, so no dots.
static void a_bright_sun_makes_no_dots(void **state) {
  (void)state;
  arena mem = {0};
  env e = map_of(million, &mem);
  ibl b;
  ibl_need need = need_all(PBR_GGX);
  ibl_make(&b, &e, &need, &mem, NULL);
  vec3 axis = {0.48f, 0.6f, -0.64f}, side = {0.8f, 0, 0.6f};
  for (int k = 1; k < ROUGHNESSES; k++) {
    float last = INFINITY;
    for (int i = 2; i < 150; i++) {
      vec2 c = num_circle((float)i / 600);
      vec3 d = vec3_mad(vec3_scale(axis, c.x), c.y, side);
      float v = ibl_radiance(&b, d, ROUGHNESS[k]).x;
      assert_true(isfinite(v) && v >= 0);
      assert_true(v <= last * 1.001f + 2e-4f);
      last = v;
    }
  }
  arena_free(&mem);
}

// Turning or scaling the environment turns and scales the sums.
static void rotation_and_scale_come_last(void **state) {
  (void)state;
  arena mem = {0};
  env e = map_of(sky_and_sun, &mem), turned = e;
  turned.rotate = 0.25f, turned.scale = 3;
  ibl b, c;
  ibl_need need = need_all(PBR_GGX);
  ibl_make(&b, &e, &need, &mem, NULL);
  ibl_make(&c, &turned, &need, &mem, NULL);
  for (int i = 0; i < 100; i++) {
    vec3 d = spiral(i, 100), from = {-d.z, d.y, d.x};
    float want = 3 * ibl_irradiance(&b, from).x;
    assert_true(fabsf(ibl_irradiance(&c, d).x - want) < 1e-3f * want);
  }
  arena_free(&mem);
}

// The bytes of all texels.
static uint64_t sum_of(const ibl *b) {
  uint64_t h = 1;
  for (int i = 0; i < b->level_count; i++) {
    const unsigned char *p = (const unsigned char *)b->level[i].texels;
    size_t n = ibl_level_texels(&b->level[i]) * sizeof(vec3);
    for (size_t k = 0; k < n; k++)
      h = (h ^ p[k]) * 1099511628211u;
  }
  return h;
}

// A hit gives the bytes that a miss computed, whatever the number of threads;
// a broken file is not believed and is replaced; two processes at once do not
// harm each other.
static void the_cache_is_honest(void **state) {
  (void)state;
  arena mem = {0};
  char folder[] = "/tmp/facet-ibl-XXXXXX";
  assert_non_null(mkdtemp(folder));
  setenv("XDG_CACHE_HOME", folder, 1);
  env e = map_of(sky_and_sun, &mem);
  static const float roughness[] = {0.3f};
  ibl_need need = {.roughness = roughness, .count = 1, .use_cache = true};
  pool *threads = pool_new(&mem, 3);
  pid_t child = fork();
  ibl a, b, c, d;
  ibl_make(&a, &e, &need, &mem, NULL);
  if (child == 0) _exit(0);
  int status;
  waitpid(child, &status, 0);
  ibl_make(&b, &e, &need, &mem, NULL);
  assert_true(b.from_cache && sum_of(&a) == sum_of(&b));
  ibl_cache_set set = {&e, PBR_GGX, b.level, 1};
  char *path = ibl_cache_path(ibl_cache_key_of(&set), &mem);
  FILE *f = fopen(path, "r+b");
  assert_non_null(f);
  fseek(f, 3000, SEEK_SET);
  fputs("wrong", f);
  fclose(f);
  ibl_make(&c, &e, &need, &mem, threads);
  assert_true(!c.from_cache && sum_of(&a) == sum_of(&c));
  ibl_make(&d, &e, &need, &mem, NULL);
  assert_true(d.from_cache && sum_of(&a) == sum_of(&d));
  // Of two files the one not used for longer goes, once they take too much.
  ibl_level fewer = b.level[0];
  ibl_cache_set other = {&e, PBR_REPORT, &fewer, 1};
  uint64_t one = ibl_level_texels(&fewer) * sizeof(vec3);
  ibl_cache_save(&other, ibl_cache_key_of(&other), 2 * one + 1000);
  assert_true(ibl_cache_load(&set, ibl_cache_key_of(&set)));
  assert_true(ibl_cache_load(&other, ibl_cache_key_of(&other)));
  nanosleep(&(struct timespec){.tv_nsec = 50000000}, NULL);
  assert_true(ibl_cache_load(&set, ibl_cache_key_of(&set)));
  nanosleep(&(struct timespec){.tv_nsec = 50000000}, NULL);
  other.model = PBR_GGX, fewer.roughness = 0.31f;
  ibl_cache_save(&other, ibl_cache_key_of(&other), 2 * one + 1000);
  assert_true(ibl_cache_load(&set, ibl_cache_key_of(&set)));
  assert_true(ibl_cache_load(&other, ibl_cache_key_of(&other)));
  other.model = PBR_REPORT, fewer.roughness = 0.3f;
  assert_false(ibl_cache_load(&other, ibl_cache_key_of(&other)));
  e.map.pixels[0].x += 1;
  ibl_make(&d, &e, &need, &mem, NULL);
  assert_false(d.from_cache);
  pool_free(threads);
  cache_prune(0);
  assert_int_equal(rmdir(cache_folder(&mem)), 0);
  assert_int_equal(rmdir(folder), 0);
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(closed_forms),
      cmocka_unit_test(sums_are_the_sums_over_texels),
      cmocka_unit_test(a_bright_sun_makes_no_dots),
      cmocka_unit_test(rotation_and_scale_come_last),
      cmocka_unit_test(the_cache_is_honest),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
