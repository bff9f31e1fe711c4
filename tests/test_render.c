// test_render.c — what does not change a picture, and what its numbers mean.

#include "film.h"
#include "metric.h"
#include "worlds.h"

#include <pthread.h>
#include <string.h>
#include <time.h>

enum { WIDTH = 50, HEIGHT = 37, TRUTH_SPP = 1000 };

// A floor, a diffuse ball, a glass ball and a mirror under the sky, with a
// point light.
static world *still_life(void) {
  world *w = world_new();
  vec3 white = {1, 1, 1}, black = {0, 0, 0};
  w->materials[0] =
      world_material(MATERIAL_BLINN_PHONG, vec3_all(0.5f), vec3_all(0.1f));
  w->materials[0].ns = 30;
  w->materials[1] =
      world_material(MATERIAL_BLINN_PHONG, (vec3){0.8f, 0.3f, 0.1f}, black);
  w->materials[2] = world_material(MATERIAL_GLASS, white, white);
  w->materials[3] = world_material(MATERIAL_MIRROR, black, vec3_all(0.9f));
  w->scene.env = (env){.kind = ENV_SKY, .scale = 1};
  world_quad(w, (vec3){-4, 0, 4}, (vec3){8, 0, 0}, (vec3){0, 0, -8}, 0);
  world_ball(w, (vec3){-1.2f, 1, 0}, 1, 3, true, 1);
  world_ball(w, (vec3){1, 0.8f, 0.6f}, 0.8f, 3, true, 2);
  world_quad(w, (vec3){-2, 0, -2}, (vec3){4, 0, 0}, (vec3){0, 2, 0}, 3);
  w->lights[0] = (light){LIGHT_POINT, {2, 4, 3}, vec3_all(8)};
  world_ready(w, 1);
  return w;
}

static camera_view still_view(void) {
  return world_view((vec3){0, 2, 6}, (vec3){0, 0.8f, 0}, 40, WIDTH, HEIGHT);
}

static render_settings still_settings(int spp) {
  return (render_settings){.width = WIDTH, .height = HEIGHT, .spp = spp};
}

static render_result render_still(const world *w, const render_settings *s,
                                  arena *mem, int threads) {
  camera_view view = still_view();
  pool *p = pool_new(mem, threads);
  render_result r;
  render_run(&r, &w->path, &view, s, mem, p);
  pool_free(p);
  return r;
}

static bool same_image(const image *a, const image *b) {
  size_t n = (size_t)a->width * (size_t)a->height;
  return a->width == b->width && a->height == b->height &&
         memcmp(a->pixels, b->pixels, n * sizeof *a->pixels) == 0;
}

// The same bytes, counts and AOVs for 1, 2 and 7 threads.
static void threads_do_not_show(void **state) {
  (void)state;
  world *w = still_life();
  arena mem = {0};
  render_settings s = still_settings(6);
  s.aovs = 31;
  render_result a = render_still(w, &s, &mem, 1);
  for (int threads = 2; threads < 8; threads += 5) {
    render_result b = render_still(w, &s, &mem, threads);
    assert_true(same_image(&a.color, &b.color));
    for (int i = 0; i < RENDER_AOV_COUNT; i++)
      assert_true(same_image(&a.aov[i], &b.aov[i]));
    assert_true(a.rays == b.rays && a.samples == b.samples);
    assert_true(a.samples == 6 * WIDTH * HEIGHT);
  }
  arena_free(&mem);
  world_free(w);
}

// What the progress function has seen.
typedef struct witness {
  pthread_t caller;
  int calls, stop_after;
  double last;
  sig_atomic_t stop;
} witness;

static void see(void *context, const render_progress *p) {
  witness *w = context;
  assert_true(pthread_equal(pthread_self(), w->caller));
  assert_true(p->done >= w->last && p->done <= 1);
  w->last = p->done;
  if (++w->calls == w->stop_after) w->stop = 1;
}

// In many passes the picture is the same as in one, the progress function is
// called by the calling thread alone, never goes back, and ends at 1.
static void passes_do_not_show(void **state) {
  (void)state;
  world *w = still_life();
  arena mem = {0};
  render_settings s = still_settings((int)shortened(150));
  render_result a = render_still(w, &s, &mem, 2);
  witness seen = {.caller = pthread_self()};
  s.progress = see;
  s.progress_context = &seen;
  render_result b = render_still(w, &s, &mem, 2);
  assert_true(same_image(&a.color, &b.color));
  assert_true(a.rays == b.rays && !b.stopped && b.spp == s.spp);
  assert_true(seen.calls >= 1 && seen.last == 1);
  arena_free(&mem);
  world_free(w);
}

// Stopped early it is the picture of the samples that were finished: the same
// as asking for so many, and so N + M is N and then M.
static void stopped_is_shorter(void **state) {
  (void)state;
  world *w = still_life();
  arena mem = {0};
  render_settings s = still_settings(1 << 20);
  witness seen = {.caller = pthread_self(), .stop_after = 2};
  s.progress = see;
  s.progress_context = &seen;
  s.stop = &seen.stop;
  render_result a = render_still(w, &s, &mem, 2);
  assert_true(a.stopped && a.spp > 1 && a.spp < 1 << 20);
  s = still_settings(a.spp);
  render_result b = render_still(w, &s, &mem, 1);
  assert_true(same_image(&a.color, &b.color) && !b.stopped);
  arena_free(&mem);
  world_free(w);
}

// A crop is that part of the whole picture, to the bit, also where the shading
// is depth.
static void crop_is_a_part(void **state) {
  (void)state;
  world *w = still_life();
  arena mem = {0};
  for (int mode = RENDER_RADIANCE; mode <= RENDER_ALBEDO; mode++) {
    render_settings s = still_settings(3);
    s.shading = (render_shading)mode;
    render_result a = render_still(w, &s, &mem, 1);
    s.x0 = 7, s.y0 = 5, s.x1 = 41, s.y1 = 30;
    render_result b = render_still(w, &s, &mem, 1);
    assert_true(b.color.width == 34 && b.color.height == 25);
    for (int y = 0; y < 25; y++)
      assert_true(memcmp(b.color.pixels + 34 * y,
                         a.color.pixels + WIDTH * (y + 5) + 7,
                         34 * sizeof(vec3)) == 0);
  }
  arena_free(&mem);
  world_free(w);
}

// Another seed is another picture, and no two pixels see the same numbers: on
// a plane of one brightness neighbours' errors do not resemble each other.
static void pixels_are_independent(void **state) {
  (void)state;
  world *w = still_life();
  w->path.lights = false;
  arena mem = {0};
  camera_view view;
  view = world_view((vec3){0.1f, 3, 3}, (vec3){0, 0, 3}, 1, 64, 64);
  render_settings s = {.width = 64, .height = 64, .spp = 1};
  render_result a, b;
  render_run(&a, &w->path, &view, &s, &mem, NULL);
  s.seed = 1;
  render_run(&b, &w->path, &view, &s, &mem, NULL);
  assert_false(same_image(&a.color, &b.color));
  double mean = 0, variance = 0, right = 0, seeds = 0;
  const int n = 64 * 64;
  for (int i = 0; i < n; i++)
    mean += (double)a.color.pixels[i].x / n;
  for (int i = 0; i + 1 < n; i++) {
    double d = (double)a.color.pixels[i].x - mean;
    variance += d * d;
    right += d * ((double)a.color.pixels[i + 1].x - mean);
    seeds += d * ((double)b.color.pixels[i].x - mean);
  }
  assert_true(variance > 0);
  assert_true(fabs(right / variance) < 4 / sqrt(n));
  assert_true(fabs(seeds / variance) < 4 / sqrt(n));
  arena_free(&mem);
  world_free(w);
}

// The mean of 65,536 samples between 0 and 1000 is exact to 1e-6 relative,
// as is the variance of the mean of an arithmetic progression.
static void long_sums(void **state) {
  (void)state;
  arena mem = {0};
  film f = film_new(&mem, 2, 1, true);
  const int n = 65536;
  for (int i = 0; i < n; i++) {
    float x = 1000.0f * (float)((unsigned)i * 40503u % 65536u) / (float)n;
    film_add(&f, 1, (vec3){x, 0.1f, -x});
  }
  double mean = 500.0 * (n - 1) / n, variance = 1e6 / 12 * (1 + 1.0 / n) / n;
  vec3 m = film_mean(&f, 1), v = film_variance(&f, 1);
  assert_true(fabs((double)m.x / mean - 1) < 1e-6 && m.z == -m.x);
  assert_true(m.y == 0.1f && v.y < 1e-15f);
  assert_true(fabs((double)v.x / variance - 1) < 1e-6);
  assert_true(film_mean(&f, 0).x == 0 && film_variance(&f, 0).x == 0);
  // A variance beyond floats is the largest of them.
  film_add(&f, 0, vec3_all(0));
  film_add(&f, 0, vec3_all(1e30f));
  assert_true(film_variance(&f, 0).x == FLT_MAX);
  arena_free(&mem);
}

// A pixel is a box: half covered by white it is half white.
static void box_filter(void **state) {
  (void)state;
  world *w = world_new();
  w->materials[0] =
      world_material(MATERIAL_BLINN_PHONG, vec3_all(0), vec3_all(0));
  w->materials[0].ke = vec3_all(1);
  // Seen from z = 10, the right edge of the quad is in the middle of pixel 2.
  world_quad(w, (vec3){-9, -9, 0}, (vec3){9, 0, 0}, (vec3){0, 18, 0}, 0);
  world_ready(w, 0);
  arena mem = {0};
  camera_view view = world_view((vec3){0, 0, 10}, vec3_all(0), 20, 5, 5);
  render_settings s = {.width = 5, .height = 5, .spp = 10000};
  render_result r;
  render_run(&r, &w->path, &view, &s, &mem, NULL);
  assert_true(r.color.pixels[11].x == 1 && r.color.pixels[13].x == 0);
  assert_float_equal(r.color.pixels[12].x, 0.5f, 0.02f);
  arena_free(&mem);
  world_free(w);
}

// Samples that are not finite are dropped and counted; the first is named.
static void bad_samples_are_counted(void **state) {
  (void)state;
  world *w = still_life();
  w->scene.env = (env){.kind = ENV_CONSTANT, .constant = {1, INFINITY, 1}};
  w->scene.env.scale = 1;
  arena mem = {0};
  render_settings s = still_settings(4);
  s.aovs = RENDER_AOV_SAMPLES;
  s.x0 = 3, s.y0 = 2, s.x1 = 40, s.y1 = 30;
  render_result r = render_still(w, &s, &mem, 7);
  double kept = 0;
  for (int i = 0; i < 37 * 28; i++) {
    assert_true(vec3_finite(r.color.pixels[i]));
    kept += (double)r.aov[4].pixels[i].x;
  }
  assert_true(r.non_finite > 0 && r.samples == 4 * 37 * 28);
  assert_true(kept + (double)r.non_finite == (double)r.samples);
  assert_int_equal(r.bad_x, 3);  // sky fills the upper left corner
  assert_int_equal(r.bad_y, 2);
  assert_int_equal(r.bad_sample, 0);
  arena_free(&mem);
  world_free(w);
}

// The error falls as one over the square root of the samples.
static void slope_is_half(void **state) {
  (void)state;
  if (shortened(100) < 100) return;
  world *w = still_life();
  arena mem = {0};
  render_settings s = still_settings(TRUTH_SPP);
  s.seed = 99;
  image truth = render_still(w, &s, &mem, 2).color;
  double x = 0, y = 0, xx = 0, xy = 0;
  const int steps = 4;
  for (int i = 0; i < steps; i++) {
    s = still_settings(1 << (2 * i));
    image at = render_still(w, &s, &mem, 2).color;
    double e = log2(metric_compare(&at, &truth, &mem).rmse), n = 2 * i;
    print_message("# %4d spp: rmse %.5f\n", s.spp, exp2(e));
    x += n, y += e, xx += n * n, xy += n * e;
  }
  double slope = (steps * xy - x * y) / (steps * xx - x * x);
  print_message("# slope %.3f\n", slope);
  assert_true(fabs(slope + 0.5) < 0.05);
  arena_free(&mem);
  world_free(w);
}

// The variance AOV is the mean square error, and the estimated error is the
// square root of relMSE, both against a much better picture.
static void estimates_are_calibrated(void **state) {
  (void)state;
  if (shortened(100) < 100) return;
  world *w = still_life();
  arena mem = {0};
  render_settings s = still_settings(TRUTH_SPP);
  s.seed = 99;
  image truth = render_still(w, &s, &mem, 2).color;
  for (int spp = 16; spp <= 64; spp *= 4) {
    s = still_settings(spp);
    s.aovs = RENDER_AOV_VARIANCE;
    render_result r = render_still(w, &s, &mem, 2);
    metric m = metric_compare(&r.color, &truth, &mem);
    double variance = 0, n = 3 * WIDTH * HEIGHT;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
      vec3 v = r.aov[3].pixels[i];
      variance += ((double)v.x + (double)v.y + (double)v.z) / n;
    }
    print_message("# %3d spp: mse %.3e, variance %.3e; "
                  "error %.4f, estimated %.4f\n",
                  spp, m.mse, variance, sqrt(m.relmse), r.error);
    assert_true(fabs(variance / m.mse - 1) < 0.2);
    assert_true(fabs(r.error / sqrt(m.relmse) - 1) < 0.1);
  }
  s = still_settings(100000);
  s.error = 0.3;
  render_result r = render_still(w, &s, &mem, 2);
  double is = sqrt(metric_compare(&r.color, &truth, &mem).relmse);
  assert_true(r.error <= 0.3 && r.spp < 100000 && !r.stopped);
  assert_true(is < 0.33);
  arena_free(&mem);
  world_free(w);
}

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// A deadline is kept, by whole passes; one that is over still gives a picture.
static void deadline_is_kept(void **state) {
  (void)state;
  world *w = still_life();
  arena mem = {0};
  render_settings s = still_settings(1 << 20);
  double start = now();
  s.deadline = start + 0.7;
  render_result r = render_still(w, &s, &mem, 2);
  assert_true(r.spp > 1 && r.spp < 1 << 20 && !r.stopped);
  assert_true(now() - start < 1.5 && r.seconds <= now() - start);
  s.deadline = start;
  assert_int_equal(render_still(w, &s, &mem, 2).spp, 1);
  arena_free(&mem);
  world_free(w);
}

// Normal, depth and albedo of a plane seen head on.
static void first_surfaces(void **state) {
  (void)state;
  world *w = world_new();
  w->materials[0] = world_material(MATERIAL_BLINN_PHONG,
                                   (vec3){0.2f, 0.4f, 0.6f}, vec3_all(0));
  world_quad(w, (vec3){-9, -9, 0}, (vec3){18, 0, 0}, (vec3){0, 18, 0}, 0);
  world_quad(w, (vec3){-1, -1, 5}, (vec3){2, 0, 0}, (vec3){0, 2, 0}, 0);
  world_ready(w, 0);
  arena mem = {0};
  camera_view view = world_view((vec3){0, 0, 10}, vec3_all(0), 90, 9, 9);
  render_settings s = {.width = 9, .height = 9, .spp = 2, .aovs = 31};
  render_result r;
  render_run(&r, &w->path, &view, &s, &mem, NULL);
  vec3 n = r.aov[0].pixels[10], a = r.aov[2].pixels[40];
  assert_true(n.x == 0 && n.y == 0 && n.z == 1);
  assert_true(a.x == 0.2f && a.y == 0.4f && a.z == 0.6f);
  assert_float_equal(r.aov[1].pixels[10].x, 10, 1e-5f);
  assert_float_equal(r.aov[1].pixels[40].x, 5, 1e-5f);
  assert_true(r.aov[4].pixels[3].x == 2);
  s.shading = RENDER_DEPTH;
  render_run(&r, &w->path, &view, &s, &mem, NULL);
  assert_float_equal(r.color.pixels[40].y, 0.5f, 1e-6f);
  assert_float_equal(r.color.pixels[10].y, 1, 1e-6f);
  s.shading = RENDER_NORMAL;
  render_run(&r, &w->path, &view, &s, &mem, NULL);
  assert_true(r.color.pixels[40].x == 0.5f && r.color.pixels[40].z == 1);
  arena_free(&mem);
  world_free(w);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(threads_do_not_show),
      cmocka_unit_test(passes_do_not_show),
      cmocka_unit_test(stopped_is_shorter),
      cmocka_unit_test(crop_is_a_part),
      cmocka_unit_test(pixels_are_independent),
      cmocka_unit_test(long_sums),
      cmocka_unit_test(box_filter),
      cmocka_unit_test(bad_samples_are_counted),
      cmocka_unit_test(slope_is_half),
      cmocka_unit_test(estimates_are_calibrated),
      cmocka_unit_test(deadline_is_kept),
      cmocka_unit_test(first_surfaces),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
