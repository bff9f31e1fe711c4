// test_texture.c — texels, filters, channels, curves.

#include "texture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

// A folder for the pictures of one test program.
typedef struct desk {
  arena mem;
  texture_store store;
  char folder[64];
} desk;

static desk *desk_new(void) {
  desk *d = calloc(1, sizeof *d);
  strcpy(d->folder, "/tmp/facet-texture-XXXXXX");
  assert_non_null(mkdtemp(d->folder));
  d->store.mem = &d->mem;
  return d;
}

static void desk_free(desk *d) {
  rmdir(d->folder);
  arena_free(&d->mem);
  free(d);
}

// The texture of a file with these bytes, which is removed again.
static const texture *load(desk *d, const char *name, const uint8_t *head,
                           size_t head_size, const void *body,
                           size_t body_size) {
  char *path = arena_format(&d->mem, "%s/%s", d->folder, name);
  FILE *f = fopen(path, "wb");
  assert_non_null(f);
  fwrite(head, 1, head_size, f);
  fwrite(body, 1, body_size, f);
  fclose(f);
  error err = {{0}};
  const texture *t = texture_get(&d->store, path, NULL, &err);
  if (t == NULL) fail_msg("%s", err.text);
  remove(path);
  return t;
}

// A true-colour TGA, rows from the top; samples are BGR or BGRA.
static const texture *tga(desk *d, const char *name, int w, int h, int channels,
                          const uint8_t *samples) {
  uint8_t head[18] = {0};
  head[2] = channels == 1 ? 3 : 2;
  head[12] = (uint8_t)w;
  head[14] = (uint8_t)h;
  head[16] = (uint8_t)(8 * channels);
  head[17] = (uint8_t)(0x20 | (channels == 4 ? 8 : 0));
  return load(d, name, head, 18, samples, (size_t)(w * h * channels));
}

static texture_map map_of(const texture *t, bool is_color) {
  return (texture_map){t, {.scale = {1, 1, 1}, .bump = 1}, is_color, NULL};
}

static void assert_close(float got, float want) {
  if (!(fabsf(got - want) <= 2e-6f))
    fail_msg("got %.9g, expected %.9g", (double)got, (double)want);
}

// Texel centres lie at (i + 0.5) / n and give the texel itself; v = 0 is the
// bottom row; half way between two centres is their mean; the last texel and
// the first are neighbours.
static void filter_passes_through_texels(void **state) {
  (void)state;
  desk *d = desk_new();
  const uint8_t grey[12] = {0, 51, 102, 153, 204, 255, 10, 20, 30, 40, 50, 60};
  texture_map m = map_of(tga(d, "grey.tga", 4, 3, 1, grey), false);
  for (int y = 0; y < 3; y++)
    for (int x = 0; x < 4; x++) {
      vec2 uv = {((float)x + 0.5f) / 4, 1 - ((float)y + 0.5f) / 3};
      assert_close(texture_number(&m, uv), (float)grey[4 * y + x] / 255);
      uv.x += 0.125f;
      float pair = (float)(grey[4 * y + x] + grey[4 * y + (x + 1) % 4]) / 2;
      assert_close(texture_number(&m, uv), pair / 255);
      uv.x += 17, uv.y -= 5;
      assert_close(texture_number(&m, uv), pair / 255);
    }
  // Between rows: the bottom row is 30 40 50 60, above it 204 255 10 20.
  assert_close(texture_number(&m, (vec2){0.125f, 1.0f / 3}),
               (204 + 30) / 2.0f / 255);
  assert_close(texture_number(&m, (vec2){0.125f, 0}), 30 / 2.0f / 255);
  desk_free(d);
}

// With clamping the outermost texels go on for ever.
static void clamp_keeps_the_edge(void **state) {
  (void)state;
  desk *d = desk_new();
  const uint8_t grey[4] = {0, 255, 100, 200};
  texture_map m = map_of(tga(d, "grey.tga", 2, 2, 1, grey), false);
  m.options.clamp = true;
  assert_close(texture_number(&m, (vec2){-3, 5}), 0);
  assert_close(texture_number(&m, (vec2){1, 1}), 1);
  assert_close(texture_number(&m, (vec2){0, -1}), 100 / 255.0f);
  assert_close(texture_number(&m, (vec2){9, 0}), 200 / 255.0f);
  desk_free(d);
}

// -s scales and -o shifts the coordinates, in this order.
static void options_move_the_picture(void **state) {
  (void)state;
  desk *d = desk_new();
  const uint8_t grey[4] = {0, 80, 160, 240};
  texture_map m = map_of(tga(d, "grey.tga", 4, 1, 1, grey), false);
  m.options.scale = (vec3){2, 1, 1};
  m.options.offset = (vec3){0.25f, 0, 0};
  assert_close(texture_number(&m, (vec2){0.0625f, 0}), 80 / 255.0f);
  assert_close(texture_number(&m, (vec2){0.3125f, 0}), 240 / 255.0f);
  desk_free(d);
}

// Colours are decoded from sRGB before they are mixed, data are not; red, green
// and blue come out in this order.
static void colors_are_decoded_and_data_are_not(void **state) {
  (void)state;
  desk *d = desk_new();
  const uint8_t bgr[6] = {0, 128, 255, 255, 188, 0};
  const texture *t = tga(d, "color.tga", 2, 1, 3, bgr);
  texture_map color = map_of(t, true), data = map_of(t, false);
  float g = (float)srgb_decode(128 / 255.0),
        h = (float)srgb_decode(188 / 255.0);
  vec3 c = texture_rgb(&color, (vec2){0.25f, 0});
  assert_close(c.x, 1);
  assert_close(c.y, g);
  assert_close(c.z, 0);
  assert_close(texture_rgb(&color, (vec2){0.5f, 0}).y, (g + h) / 2);
  assert_close(texture_rgb(&data, (vec2){0.25f, 0}).y, 128 / 255.0f);
  desk_free(d);
}

// -imfchan picks a channel; without it a number is the luminance; opacity is
// the alpha where there is one.
static void channels_are_picked(void **state) {
  (void)state;
  desk *d = desk_new();
  const uint8_t bgra[4] = {51, 102, 204, 25};
  texture_map m = map_of(tga(d, "rgba.tga", 1, 1, 4, bgra), false);
  vec2 uv = {0.5f, 0.5f};
  float r = 0.8f, g = 0.4f, b = 0.2f, a = 25 / 255.0f;
  assert_close(texture_number(&m, uv), 0.2126f * r + 0.7152f * g + 0.0722f * b);
  assert_close(texture_alpha(&m, uv), a);
  const char names[] = "rgbm";
  const float want[] = {r, g, b, a};
  for (int i = 0; i < 4; i++) {
    m.options.channel = names[i];
    assert_close(texture_number(&m, uv), want[i]);
    assert_close(texture_alpha(&m, uv), want[i]);
  }
  m.options.channel = 'l';
  assert_close(texture_alpha(&m, uv), 0.2126f * r + 0.7152f * g + 0.0722f * b);
  const uint8_t bgr[3] = {51, 102, 204};
  m = map_of(tga(d, "rgb.tga", 1, 1, 3, bgr), false);
  assert_close(texture_alpha(&m, uv), texture_number(&m, uv));
  m.options.channel = 'm';
  assert_close(texture_alpha(&m, uv), 1);
  desk_free(d);
}

// A float map is linear light as it stands, whatever it is used for, and may
// exceed 1.
static void float_maps_are_linear(void **state) {
  (void)state;
  desk *d = desk_new();
  const char head[] = "PF\n1 1\n-1.0\n";
  const float rgb[3] = {0.25f, 7, 1e-3f};
  const texture *t =
      load(d, "one.pfm", (const uint8_t *)head, sizeof head - 1, rgb, 12);
  texture_map m = map_of(t, true);
  vec3 c = texture_rgb(&m, (vec2){0.3f, 0.9f});
  assert_true(c.x == 0.25f && c.y == 7 && c.z == 1e-3f);
  desk_free(d);
}

// 16-bit samples keep their precision and are decoded by the same curve.
static void deep_samples_are_decoded(void **state) {
  (void)state;
  desk *d = desk_new();
  char *path = arena_format(&d->mem, "%s/deep.png", d->folder);
  vec3 pixels[2] = {{0.2f, 0.001f, 0.7f}, {0.5f, 0.25f, 1}};
  image im = {2, 1, pixels};
  error err = {{0}};
  assert_true(picture_write(&im, path, PICTURE_PNG, 16, &err));
  const texture *t = texture_get(&d->store, path, NULL, &err);
  remove(path);
  assert_non_null(t);
  assert_non_null(t->floats);
  texture_map m = map_of(t, true);
  for (int i = 0; i < 2; i++) {
    vec3 c = texture_rgb(&m, (vec2){0.25f + 0.5f * (float)i, 0.5f});
    vec3 apart = vec3_abs(vec3_sub(c, pixels[i]));
    assert_true(vec3_peak(apart) < 3e-5f);
  }
  desk_free(d);
}

// Any coordinate gives a value between the least and the largest texel.
static void any_coordinate_is_safe(void **state) {
  (void)state;
  desk *d = desk_new();
  const uint8_t grey[6] = {100, 120, 140, 160, 180, 200};
  texture_map m = map_of(tga(d, "grey.tga", 3, 2, 1, grey), false);
  const float odd[] = {NAN,    INFINITY, -INFINITY, 1e30f,       -1e30f,  1e9f,
                       -1e-9f, -0.0f,    1,         0.99999994f, 16777216};
  const size_t n = sizeof odd / sizeof *odd;
  for (size_t i = 0; i < 2 * n * n; i++) {
    m.options.clamp = i % 2;
    vec2 uv = {odd[i / 2 % n], odd[i / 2 / n]};
    float x = texture_number(&m, uv);
    assert_true(x >= 100 / 255.0f - 1e-6f && x <= 200 / 255.0f + 1e-6f);
  }
  desk_free(d);
}

// A path is read once; one that fails says why, every time.
static void files_are_read_once(void **state) {
  (void)state;
  desk *d = desk_new();
  const uint8_t grey[1] = {7};
  const texture *t = tga(d, "grey.tga", 1, 1, 1, grey);
  error err = {{0}};
  assert_ptr_equal(texture_get(&d->store, t->path, NULL, &err), t);
  for (int i = 0; i < 40; i++) {
    char *path = arena_format(&d->mem, "%s/none-%d.png", d->folder, i % 20);
    assert_null(texture_get(&d->store, path, NULL, &err));
    assert_non_null(strstr(err.text, path));
  }
  assert_int_equal(d->store.count, 21);
  desk_free(d);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(filter_passes_through_texels),
      cmocka_unit_test(clamp_keeps_the_edge),
      cmocka_unit_test(options_move_the_picture),
      cmocka_unit_test(colors_are_decoded_and_data_are_not),
      cmocka_unit_test(channels_are_picked),
      cmocka_unit_test(float_maps_are_linear),
      cmocka_unit_test(deep_samples_are_decoded),
      cmocka_unit_test(any_coordinate_is_safe),
      cmocka_unit_test(files_are_read_once),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
