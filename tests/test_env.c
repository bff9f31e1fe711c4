// test_env.c — directions and texels of an environment, and the built-in sky.

#include "env.h"

#include "picture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static void assert_vec3_close(vec3 got, vec3 want, float within) {
  vec3 apart = vec3_abs(vec3_sub(got, want));
  if (!(vec3_peak(apart) <= within))
    fail_msg("got %g %g %g, expected %g %g %g", (double)got.x, (double)got.y,
             (double)got.z, (double)want.x, (double)want.y, (double)want.z);
}

// A map whose six axis directions have colours of their own: 32 x 16 texels,
// each as the axis nearest to its centre says.
static env six_colors(arena *mem, vec3 colors[6]) {
  const vec3 axes[6] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                        {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
  env e = {.kind = ENV_MAP, .map = image_new(mem, 32, 16), .scale = 1};
  for (int i = 0; i < 6; i++)
    colors[i] = (vec3){(float)(i + 1), (float)(i * i), (float)(7 - i)};
  for (int y = 0; y < 16; y++)
    for (int x = 0; x < 32; x++) {
      double u = (x + 0.5) / 32, v = (y + 0.5) / 16, pi = 3.14159265358979;
      // From the definition: u = 0.5 + atan2(x, -z) / 2 pi, v = acos(y) / pi.
      double a = (u - 0.5) * 2 * pi, s = sin(v * pi);
      vec3 d = {(float)(sin(a) * s), (float)cos(v * pi), (float)(-cos(a) * s)};
      int best = 0;
      for (int i = 1; i < 6; i++)
        if (vec3_dot(d, axes[i]) > vec3_dot(d, axes[best])) best = i;
      e.map.pixels[32 * y + x] = colors[best];
    }
  return e;
}

// Row 0 is +Y, the centre of the map is -Z, and u grows towards +X.
static void axes_are_where_the_page_says(void **state) {
  (void)state;
  arena mem = {0};
  vec3 c[6];
  env e = six_colors(&mem, c);
  assert_vec3_close(env_radiance(&e, (vec3){1, 0, 0}), c[0], 0);
  assert_vec3_close(env_radiance(&e, (vec3){-1, 0, 0}), c[1], 0);
  assert_vec3_close(env_radiance(&e, (vec3){0, 1, 0}), c[2], 0);
  assert_vec3_close(env_radiance(&e, (vec3){0, -1, 0}), c[3], 0);
  assert_vec3_close(env_radiance(&e, (vec3){0, 0, 1}), c[4], 0);
  assert_vec3_close(env_radiance(&e, (vec3){0, 0, -1}), c[5], 0);
  vec2 uv = env_uv((vec3){0, 0, -1});
  assert_true(uv.x == 0.5f && uv.y == 0.5f);
  assert_true(env_uv((vec3){1, 0, 0}).x == 0.75f);
  assert_true(env_uv((vec3){0, 1, 0}).y == 0);
  assert_true(env_uv((vec3){0, 0, 1}).x == 0);
  // A quarter added to u: what was seen at -Z is now what lay at +X.
  e.rotate = 0.25f;
  assert_vec3_close(env_radiance(&e, (vec3){0, 0, -1}), c[0], 0);
  assert_vec3_close(env_radiance(&e, (vec3){1, 0, 0}), c[4], 0);
  e.rotate = -7.75f;
  assert_vec3_close(env_radiance(&e, (vec3){0, 0, -1}), c[0], 0);
  arena_free(&mem);
}

// env_direction undoes env_uv, everywhere but at the poles, where u is free.
static void directions_survive_the_round_trip(void **state) {
  (void)state;
  for (int y = 0; y <= 400; y++)
    for (int x = 0; x < 400; x++) {
      vec2 uv = {(float)x / 400, (float)y / 400};
      vec3 d = env_direction(uv);
      assert_true(fabsf(vec3_length(d) - 1) < 4e-7f);
      vec2 back = env_uv(d);
      assert_true(back.x >= 0 && back.x < 1 && back.y >= 0 && back.y <= 1);
      assert_true(fabsf(back.y - uv.y) < 5e-7f);
      assert_vec3_close(env_direction(back), d, 2e-6f);
      if (y < 20 || y > 380) continue;
      float apart = fabsf(back.x - uv.x);
      assert_true(fminf(apart, 1 - apart) < 5e-7f);
    }
}

// A lookup at a texel's centre gives the texel, half way to the next one their
// mean; across the seam and at the
// poles the radiance has no jump.
static void maps_have_no_seam(void **state) {
  (void)state;
  arena mem = {0};
  env e = {.kind = ENV_MAP, .map = image_new(&mem, 16, 8), .scale = 1};
  for (int i = 0; i < 128; i++)
    e.map.pixels[i] = vec3_all((float)(i * 37 % 101) / 100);
  for (int y = 0; y < 8; y++)
    for (int x = 0; x < 16; x++) {
      vec2 uv = {((float)x + 0.5f) / 16, ((float)y + 0.5f) / 8};
      vec3 got = env_radiance(&e, env_direction(uv));
      assert_vec3_close(got, e.map.pixels[16 * y + x], 2e-5f);
      vec3 next = e.map.pixels[16 * y + (x + 1) % 16];
      uv.x = fmodf(uv.x + 1.0f / 32, 1);
      got = env_radiance(&e, env_direction(uv));
      next = vec3_lerp(e.map.pixels[16 * y + x], next, 0.5f);
      assert_vec3_close(got, next, 2e-5f);
    }
  for (int i = 1; i < 100; i++) {
    float v = (float)i / 100;
    vec3 left = env_radiance(&e, env_direction((vec2){1e-6f, v}));
    vec3 right = env_radiance(&e, env_direction((vec2){1 - 1e-6f, v}));
    assert_vec3_close(left, right, 1e-4f);
  }
  arena_free(&mem);
}

// A constant is the same all around, `scale` multiplies every kind, none is
// black, and directions that are not finite see nothing.
static void kinds_do_what_they_say(void **state) {
  (void)state;
  env c = {.kind = ENV_CONSTANT, .constant = {1, 2, 3}, .scale = 2};
  env none = {.kind = ENV_NONE, .constant = {1, 2, 3}, .scale = 2};
  env sky = {.kind = ENV_SKY, .scale = 1};
  env twice = {.kind = ENV_SKY, .scale = 2};
  for (int i = 0; i < 100; i++) {
    vec3 d = env_direction((vec2){(float)i / 100, (float)(i * 7 % 100) / 100});
    assert_vec3_close(env_radiance(&c, d), (vec3){2, 4, 6}, 0);
    assert_vec3_close(env_radiance(&none, d), vec3_all(0), 0);
    assert_vec3_close(env_radiance(&twice, d),
                      vec3_scale(env_radiance(&sky, d), 2), 0);
  }
  const env *all[] = {&c, &sky, &none};
  for (int i = 0; i < 3; i++) {
    assert_vec3_close(env_radiance(all[i], (vec3){NAN, 0, 1}), vec3_all(0), 0);
    assert_vec3_close(env_radiance(all[i], (vec3){0, INFINITY, 1}), vec3_all(0),
                      0);
  }
}

// The mean of the sky over all directions is what its formula integrates to:
// half of the integral over the height, plus the sun's 1 / 34 of its centre.
static void sky_has_the_mean_of_its_formula(void **state) {
  (void)state;
  env sky = {.kind = ENV_SKY, .scale = 1};
  const int n = getenv("FACET_QUICK") == NULL ? 1000 : 200;
  double sum[3] = {0};
  for (int y = 0; y < n; y++)
    for (int x = 0; x < 2 * n; x++) {
      // Equal areas: the height is uniform on a sphere.
      double h = 1 - 2 * (y + 0.5) / n, a = 3.14159265358979 * (x + 0.5) / n;
      double s = sqrt(1 - h * h);
      vec3 d = {(float)(s * cos(a)), (float)h, (float)(s * sin(a))};
      vec3 l = env_radiance(&sky, d);
      assert_true(l.x > 0 && l.y > 0 && l.z > 0);
      sum[0] += (double)l.x;
      sum[1] += (double)l.y;
      sum[2] += (double)l.z;
    }
  const double zenith[] = {0.16, 0.30, 0.60}, horizon[] = {0.62, 0.68, 0.74};
  const double ground[] = {0.19, 0.18, 0.17}, sun[] = {4.6, 4.2, 3.5};
  for (int i = 0; i < 3; i++) {
    double above = zenith[i] + (horizon[i] - zenith[i]) / 5;
    double below = ground[i] + (horizon[i] - ground[i]) / 17;
    double want = (above + below) / 2 + sun[i] / 34;
    assert_true(fabs(sum[i] / (2.0 * n * n) - want) < 2e-4 * want);
  }
}

// The sky is a function of the direction alone: turning it by a quarter moves
// its sun by a quarter.
static void sky_turns(void **state) {
  (void)state;
  env sky = {.kind = ENV_SKY, .scale = 1};
  env turned = {.kind = ENV_SKY, .scale = 1, .rotate = 0.25f};
  for (int i = 0; i < 100; i++) {
    vec2 uv = {(float)i / 100, (float)(i * 37 % 100) / 100};
    vec2 ahead = {uv.x + (uv.x < 0.75f ? 0.25f : -0.75f), uv.y};
    assert_vec3_close(env_radiance(&turned, env_direction(uv)),
                      env_radiance(&sky, env_direction(ahead)), 2e-4f);
  }
}

// A map from disk: linear formats as they are, 8-bit ones as sRGB; what cannot
// be read leaves the environment alone.
static void maps_are_loaded(void **state) {
  (void)state;
  arena mem = {0};
  char folder[] = "/tmp/facet-env-XXXXXX";
  assert_non_null(mkdtemp(folder));
  vec3 pixels[2] = {{0.5f, 2, 100}, {0.25f, 0.5f, 1}};
  image im = {2, 1, pixels};
  char *pfm = arena_format(&mem, "%s/e.pfm", folder);
  char *png = arena_format(&mem, "%s/e.png", folder);
  error err = {{0}};
  assert_true(picture_write(&im, pfm, PICTURE_PFM, 8, &err));
  assert_true(picture_write(&im, png, PICTURE_PNG, 8, &err));
  env e;
  assert_true(env_load(&e, pfm, &mem, NULL, &err));
  assert_true(e.kind == ENV_MAP && e.scale == 1 && e.rotate == 0);
  assert_vec3_close(env_radiance(&e, (vec3){-1, 0, 0}), pixels[0], 1e-4f);
  assert_true(env_load(&e, png, &mem, NULL, &err));
  assert_vec3_close(env_radiance(&e, (vec3){1, 0, 0}), pixels[1], 5e-3f);
  remove(pfm);
  remove(png);
  rmdir(folder);
  e.scale = 9;
  assert_false(env_load(&e, pfm, &mem, NULL, &err));
  assert_true(e.scale == 9);
  assert_non_null(strstr(err.text, pfm));
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(axes_are_where_the_page_says),
      cmocka_unit_test(directions_survive_the_round_trip),
      cmocka_unit_test(maps_have_no_seam),
      cmocka_unit_test(kinds_do_what_they_say),
      cmocka_unit_test(sky_has_the_mean_of_its_formula),
      cmocka_unit_test(sky_turns),
      cmocka_unit_test(maps_are_loaded),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
