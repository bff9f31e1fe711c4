// The rasteriser against the path engine: the same light, pixel by pixel.

#include "gl_worlds.h"

#include <math.h>
#include <string.h>

enum { WIDTH = 160, HEIGHT = 120 };

static const vec3 WHITE = {1, 1, 1}, BLACK = {0, 0, 0};

static raster_settings plain_settings(void) {
  return (raster_settings){
      .width = WIDTH, .height = HEIGHT, .msaa = 1, .lights = true};
}

// Balls, smooth and flat, of several materials over a floor, under two point
// lights and a directional one; one quad shows its back.
static world *stage(const material *balls, int count) {
  world *w = world_new();
  w->materials[0] =
      world_material(MATERIAL_BLINN_PHONG, vec3_all(0.6f), BLACK);
  for (int i = 0; i < count; i++)
    w->materials[i + 1] = balls[i];
  world_quad(w, (vec3){-6, 0, 4}, (vec3){12, 0, 0}, (vec3){0, 0, -10}, 0);
  for (int i = 0; i < count; i++)
    world_ball(w, (vec3){2.1f * (float)i - 1.05f * (float)(count - 1), 1, 0}, 1,
               i % 2 ? 3 : 2, i % 2 == 0, (uint32_t)(i + 1));
  world_quad(w, (vec3){-1, 2.2f, -1}, (vec3){0, 1, 0}, (vec3){2, 0, 0}, 1);
  w->lights[0] = (light){LIGHT_POINT, {3, 5, 4}, {30, 28, 20}};
  w->lights[1] = (light){LIGHT_POINT, {-4, 2, 2}, {4, 8, 12}};
  w->lights[2] = (light){LIGHT_DIR, {0.6f, -0.64f, -0.48f}, {0.7f, 0.7f, 0.9f}};
  world_ready(w, 3);
  return w;
}

static camera_view stage_view(void) {
  return world_view((vec3){0.5f, 2.5f, 8}, (vec3){0, 1, 0}, 36, WIDTH, HEIGHT);
}

// Draw w and trace it: the share of pixels that differ by more than `most`,
// not counting those on edges.  Prints the largest difference.
static double share_apart(const world *w, gl *g, raster_settings set,
                          float most) {
  arena mem = {0};
  camera_view v = stage_view();
  image im = drawn(w, g, &v, &set, &mem);
  float worst = 0;
  int bad = 0, edges = 0;
  for (int y = 0; y < HEIGHT; y++)
    for (int x = 0; x < WIDTH; x++) {
      if (on_edge(w, &v, x, y)) {
        edges++;
        continue;
      }
      vec3 want = traced(w, &v, x, y, set.shadows);
      float d = far_apart(im.pixels[y * WIDTH + x], want);
      worst = fmaxf(worst, d);
      bad += !(d <= most);
    }
  arena_free(&mem);
  print_message("# worst %.5f of 255, %d pixels beyond, %d on edges\n",
                255 * (double)worst, bad, edges);
  assert_true(edges < WIDTH * HEIGHT / 10);
  return (double)bad / (WIDTH * HEIGHT);
}

// Without shadows the direct light of Blinn-Phong is the same picture from
// both engines: every pixel off the edges within 1/255.
static void direct_light_is_the_same(void **state) {
  (void)state;
  arena mem = {0};
  gl *g = gl_or_skip(GL_BACKEND_AUTO, &mem);
  material balls[4];
  const float ns[4] = {0, 8, 90, 4000};
  for (int i = 0; i < 4; i++) {
    balls[i] = world_material(MATERIAL_BLINN_PHONG, (vec3){0.7f, 0.5f, 0.2f},
                              vec3_all(0.1f + 0.2f * (float)i));
    balls[i].ns = ns[i];
  }
  balls[0].ks = BLACK;
  world *w = stage(balls, 4);
  assert_true(share_apart(w, g, plain_settings(), 1.0f / 255) == 0);
  world_free(w);
  gl_close(g);
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(direct_light_is_the_same),
  };
  (void)WHITE;
  return cmocka_run_group_tests(tests, NULL, NULL);
}
