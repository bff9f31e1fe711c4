// test_view.c — laws of the viewer without a window: flight, keys, scripts, and
// the path tracer that works beside it.

#include "path.h"
#include "view_paths.h"
#include "view_script.h"

#include "worlds.h"

#include <stdatomic.h>
#include <string.h>
#include <time.h>

static const camera FRONT = {NULL, {0, 1, 5}, {0, 1, 0}, {0, 1, 0}, 40};

// A flight in a box whose diagonal is 5: one unit a second.
static view_state start(void) {
  return view_start(&FRONT, (vec3){0, 0, 0}, (vec3){3, 4, 0}, true);
}

static void assert_near(vec3 a, vec3 b, float tolerance) {
  vec3 d = vec3_abs(vec3_sub(a, b));
  assert_true(vec3_peak(d) <= tolerance);
}

static void tap(view_state *s, view_key key) {
  view_press(s, key, true);
  view_press(s, key, false);
}

// Each key of flight moves the eye its own way, one unit a second, and the
// target with it.
static void keys_fly(void **state) {
  (void)state;
  static const struct {
    view_key key;
    vec3 way;
  } KEYS[] = {{VIEW_W, {0, 0, -1}}, {VIEW_UP, {0, 0, -1}},
              {VIEW_S, {0, 0, 1}},  {VIEW_DOWN, {0, 0, 1}},
              {VIEW_A, {-1, 0, 0}}, {VIEW_LEFT, {-1, 0, 0}},
              {VIEW_D, {1, 0, 0}},  {VIEW_RIGHT, {1, 0, 0}},
              {VIEW_Q, {0, 1, 0}},  {VIEW_Z, {0, -1, 0}}};
  for (size_t i = 0; i < sizeof KEYS / sizeof *KEYS; i++) {
    view_state s = start();
    view_press(&s, KEYS[i].key, true);
    view_fly(&s, 2);
    view_press(&s, KEYS[i].key, false);
    view_fly(&s, 100);
    vec3 moved = vec3_scale(KEYS[i].way, 2);
    assert_near(vec3_sub(s.look.camera.eye, FRONT.eye), moved, 1e-5f);
    assert_near(vec3_sub(s.look.camera.target, FRONT.target), moved, 1e-5f);
  }
}

// Opposite keys cancel; two ways at once are not faster than one; both keys of
// one way are as fast as one.
static void keys_add_up(void **state) {
  (void)state;
  view_state s = start();
  view_press(&s, VIEW_W, true);
  view_press(&s, VIEW_DOWN, true);
  view_fly(&s, 1);
  assert_near(s.look.camera.eye, FRONT.eye, 0);
  view_press(&s, VIEW_DOWN, false);
  view_press(&s, VIEW_UP, true);
  view_press(&s, VIEW_D, true);
  view_fly(&s, 1);
  float half = sqrtf(0.5f);
  assert_near(s.look.camera.eye, (vec3){half, 1, 5 - half}, 1e-5f);
}

// A second of flight ends at the same place in 1, 60 or 1000 frames: the
// difference is the rounding of each frame's sum, half of the last bit of 5.
static void frames_do_not_change_speed(void **state) {
  (void)state;
  static const int FRAMES[] = {1, 7, 60, 1000};
  for (int k = 0; k < 4; k++) {
    view_state s = start();
    view_turn(&s, 123, -45);
    view_press(&s, VIEW_W, true);
    view_press(&s, VIEW_Q, true);
    for (int i = 0; i < FRAMES[k]; i++)
      view_fly(&s, 1.0 / FRAMES[k]);
    float way = vec3_length(vec3_sub(s.look.camera.eye, FRONT.eye));
    assert_true(fabsf(way - 1) < 1e-6f + 2.4e-7f * (float)FRAMES[k]);
  }
}

// 600 pixels are a quarter turn: to the right, and back where it came from
// after four; up is up, and never over the top.
static void the_mouse_turns(void **state) {
  (void)state;
  view_state s = start();
  view_turn(&s, 600, 0);
  assert_near(s.look.camera.target, (vec3){5, 1, 5}, 1e-5f);
  for (int i = 0; i < 3; i++)
    view_turn(&s, 600, 0);
  assert_near(s.look.camera.target, FRONT.target, 1e-5f);
  view_turn(&s, -1, 0);
  view_turn(&s, 1, 0);
  assert_near(s.look.camera.target, FRONT.target, 1e-4f);
  view_turn(&s, 0, -200);
  float rise = 5 * sinf(30 * PI / 180);
  assert_true(fabsf(s.look.camera.target.y - (1 + rise)) < 1e-4f);
  assert_near(s.look.camera.eye, FRONT.eye, 0);
  for (int i = 0; i < 50; i++) {
    view_turn(&s, 37, i < 25 ? -100 : 100);
    camera_view v;
    error err;
    assert_true(camera_view_of(&v, &s.look.camera, 64, 48, &err));
  }
}

// A camera that looks straight down is kept, to the bit, until it is turned.
static void steep_cameras_are_kept(void **state) {
  (void)state;
  camera down = {NULL, {0, 9, 0}, {0, 0, 0.001f}, {0, 1, 0}, 40};
  view_state s = view_start(&down, vec3_all(-1), vec3_all(1), false);
  assert_memory_equal(&s.look.camera.target, &down.target, sizeof(vec3));
  view_turn(&s, 0.01f, 0);
  camera_view v;
  error err;
  assert_true(camera_view_of(&v, &s.look.camera, 64, 48, &err));
  assert_near(s.look.camera.target, down.target, 0.02f);
}

// The switches, as the table of keys says; held down they do not flicker.
static void switches_switch(void **state) {
  (void)state;
  view_state s = start();
  bool *const on[] = {&s.frosted, &s.paths, &s.look.only_rough};
  static const view_key KEYS[] = {VIEW_SHIFT, VIEW_SPACE, VIEW_0};
  for (int i = 0; i < 3; i++) {
    assert_false(*on[i]);
    for (int k = 0; k < 4; k++)
      view_press(&s, KEYS[i], true);
    assert_true(*on[i]);
    view_press(&s, KEYS[i], false);
    assert_true(*on[i]);
    tap(&s, KEYS[i]);
    assert_false(*on[i]);
  }
  tap(&s, VIEW_P);
  tap(&s, VIEW_F12);
  tap(&s, VIEW_H);
  assert_true(s.print && s.save && s.help && !s.leaving);
  tap(&s, VIEW_ESC);
  assert_true(s.leaving);
  view_state none = view_start(&FRONT, vec3_all(0), vec3_all(1), false);
  tap(&none, VIEW_0);
  assert_false(none.look.only_rough);
}

// Keys 1 to 4 move metallic and roughness by a tenth, of metal-rough materials
// alone and never out of 0..1; and back again.
static void steps_change_materials(void **state) {
  (void)state;
  material base[3] = {
      {.kind = MATERIAL_METAL_ROUGH, .metallic = 0, .roughness = 0.45f},
      {.kind = MATERIAL_BLINN_PHONG, .metallic = 0.5f, .roughness = 0.5f},
      {.kind = MATERIAL_METAL_ROUGH, .metallic = 0.95f, .roughness = 0.05f}};
  material out[3];
  view_state s = start();
  for (int i = 0; i < 3; i++)
    tap(&s, VIEW_2);
  tap(&s, VIEW_3);
  view_materials(out, base, 3, &s.look);
  assert_true(fabsf(out[0].metallic - 0.3f) < 1e-6f);
  assert_true(fabsf(out[0].roughness - 0.35f) < 1e-6f);
  assert_memory_equal(&out[1], &base[1], sizeof *base);
  assert_true(out[2].metallic == 1 && out[2].roughness == 0);
  for (int i = 0; i < 40; i++)
    tap(&s, VIEW_4);
  view_materials(out, base, 3, &s.look);
  assert_true(out[0].roughness == 1 && out[2].roughness == 1);
  for (int i = 0; i < 3; i++)
    tap(&s, VIEW_1);
  for (int i = 0; i < 10; i++)
    tap(&s, VIEW_3);
  view_materials(out, base, 3, &s.look);
  assert_memory_equal(out, base, sizeof base);
}

static bool read_text(view_script *out, const char *text, arena *mem,
                      error *err) {
  return view_script_read(out, (span){text, strlen(text)}, "s", mem, err);
}

// Every statement is read as the header says; a tap is two events.
static void scripts_are_read(void **state) {
  (void)state;
  arena mem = {0};
  error err;
  view_script s;
  assert_true(read_text(&s,
                        "# nothing\n\nkey w down # go\r\nmouse 10 -4.5\n"
                        "wait 0.5\nkey f12\nspp 3\nframe \"a b.png\"",
                        &mem, &err));
  assert_int_equal(s.count, 7);
  const view_event *e = s.events;
  assert_true(e[0].kind == VIEW_EVENT_KEY && e[0].key == VIEW_W && e[0].down);
  assert_int_equal(e[0].line, 3);
  assert_true(e[1].kind == VIEW_EVENT_MOUSE && e[1].dx == 10 &&
              e[1].dy == -4.5f);
  assert_true(e[2].kind == VIEW_EVENT_WAIT && e[2].seconds == 0.5f);
  assert_true(e[3].key == VIEW_F12 && e[3].down && !e[4].down);
  assert_true(e[5].kind == VIEW_EVENT_SPP && e[5].spp == 3);
  assert_string_equal(e[6].path, "a b.png");
  for (int key = 0; key < VIEW_KEY_COUNT; key++) {
    char line[32];
    snprintf(line, sizeof line, "key %s up", VIEW_KEYS[key].name);
    assert_true(read_text(&s, line, &mem, &err));
    assert_true(s.count == 1 && s.events[0].key == (view_key)key);
  }
  arena_free(&mem);
}

// What is wrong is said with its line and what was expected; the script is
// untouched.
static void bad_scripts_are_refused(void **state) {
  (void)state;
  static const char *const BAD[][2] = {
      {"\nkey x\n", "s:2: unknown key 'x'"},
      {"key spce", "nearest is space"},
      {"frmae a.png", "unknown statement 'frmae'; the nearest is frame"},
      {"key w sideways", "key NAME down"},
      {"mouse 1", "mouse DX DY"},
      {"mouse inf 0", "mouse DX DY"},
      {"wait -1", "wait SECONDS"},
      {"wait nan", "wait SECONDS"},
      {"wait", "wait SECONDS"},
      {"spp 0", "spp N"},
      {"spp 1.5", "spp N"},
      {"frame", "frame FILE"},
      {"wait 1 2", "'2' is too much"},
  };
  arena mem = {0};
  for (size_t i = 0; i < sizeof BAD / sizeof *BAD; i++) {
    view_script s = {.count = 77};
    error err;
    assert_false(read_text(&s, BAD[i][0], &mem, &err));
    assert_non_null(strstr(err.text, BAD[i][1]));
    assert_int_equal(s.count, 77);
  }
  arena_free(&mem);
}

enum { WIDTH = 60, HEIGHT = 40 };

// A diffuse ball and a metal-rough one on a floor, under the sky.
static world *two_balls(void) {
  world *w = world_new();
  vec3 black = {0, 0, 0};
  w->materials[0] = world_material(MATERIAL_BLINN_PHONG, vec3_all(0.5f), black);
  w->materials[1] =
      world_material(MATERIAL_METAL_ROUGH, (vec3){0.8f, 0.3f, 0.1f}, black);
  w->materials[1].roughness = 0.4f;
  w->scene.env = (env){.kind = ENV_SKY, .scale = 1};
  world_quad(w, (vec3){-4, 0, 4}, (vec3){8, 0, 0}, (vec3){0, 0, -8}, 0);
  world_ball(w, (vec3){-1.1f, 1, 0}, 1, 2, true, 0);
  world_ball(w, (vec3){1.1f, 1, 0}, 1, 2, true, 1);
  world_ready(w, 2);
  return w;
}

static view_paths *paths_of(const world *w, pool *p, arena *mem) {
  view_paths_settings set = {
      .width = WIDTH, .height = HEIGHT, .seed = 5, .world = w->path};
  return view_paths_new(&set, p, mem);
}

static bool same_pixels(const image *a, const image *b) {
  return memcmp(a->pixels, b->pixels, WIDTH * HEIGHT * sizeof(vec3)) == 0;
}

// However often it was interrupted, the picture after N passes is that of the
// renderer with N samples, to the bit, for 1, 2 and 5 workers.
static void passes_are_the_renderers(void **state) {
  (void)state;
  arena mem = {0};
  world *w = two_balls();
  const int spp = 3;
  view_look look = {.camera = FRONT}, other = look;
  other.camera.eye.x = 2;
  camera_view view;
  error err;
  assert_true(camera_view_of(&view, &FRONT, WIDTH, HEIGHT, &err));
  light_set lights;
  light_set_build(&lights, &w->scene, w->path.lights, true, &mem, NULL);
  path_tracer paths = {.world = &w->path, .lights = &lights, .seed = 5};
  integrator by = path_integrator(&paths);
  render_settings set = {
      .width = WIDTH, .height = HEIGHT, .spp = spp, .by = &by};
  render_result truth;
  render_run(&truth, &w->path, &view, &set, &mem, NULL);
  static const int WORKERS[] = {1, 2, 5};
  for (int k = 0; k < 3; k++) {
    pool *p = pool_new(&mem, WORKERS[k]);
    view_paths *v = paths_of(w, p, &mem);
    for (int i = 0; i < 20; i++)
      assert_true(view_paths_restart(v, i % 2 ? &look : &other, &err));
    image im = view_paths_finish(v, spp, &mem);
    assert_int_equal(view_paths_spp(v), spp);
    assert_true(same_pixels(&im, &truth.color));
    view_paths_free(v);
    pool_free(p);
  }
  world_free(w);
  arena_free(&mem);
}

// Hidden triangles are gone and the rest is in its place; rougher metal is
// another picture, and its own roughness the first one again.
static void looks_reach_the_paths(void **state) {
  (void)state;
  arena mem = {0};
  world *w = two_balls();
  pool *p = pool_new(&mem, 2);
  view_paths *v = paths_of(w, p, &mem);
  view_look look = {.camera = FRONT};
  error err;
  image im[4];
  for (int i = 0; i < 4; i++) {
    look.only_rough = i == 1;
    look.roughness = i == 2 ? 6 : 0;
    assert_true(view_paths_restart(v, &look, &err));
    im[i] = view_paths_finish(v, 1, &mem);
  }
  assert_false(same_pixels(&im[0], &im[1]));
  assert_false(same_pixels(&im[0], &im[2]));
  assert_true(same_pixels(&im[0], &im[3]));
  // Beside the ball that is left nothing but sky: no noise, so that left and
  // right neighbours are nearly equal.
  vec3 a = im[1].pixels[30 * WIDTH + 12], b = im[1].pixels[30 * WIDTH + 13];
  assert_near(a, b, 0.02f);
  view_paths_free(v);
  pool_free(p);
  world_free(w);
  arena_free(&mem);
}

// Two milliseconds of work.
static void slow_item(void *context, size_t item, int worker) {
  (void)item, (void)worker;
  struct timespec t = {0, 2000000};
  nanosleep(&t, NULL);
  atomic_fetch_add((atomic_int *)context, 1);
}

// Asking never waits: the call that starts 2,400 slow items and the call that
// asks for them return before any could be done; and stopping waits for no
// more than those in hand.
static void starting_does_not_wait(void **state) {
  (void)state;
  arena mem = {0};
  atomic_int done = 0;
  pool *p = pool_new(&mem, 3);
  assert_true(pool_done(p));
  for (int i = 0; i < 10; i++) {
    pool_start(p, 2400, slow_item, &done);
    assert_false(pool_done(p));
    pool_cancel(p);
    pool_wait(p);
    assert_true(pool_done(p));
  }
  // Two helpers, ten rounds, an item in each hand.
  assert_true(done <= 10 * 2 * 5);
  done = 0;
  pool_start(p, 9, slow_item, &done);
  pool_wait(p);
  assert_int_equal(done, 9);
  pool_run(p, 9, slow_item, &done);
  assert_int_equal(done, 18);
  pool_free(p);
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(keys_fly),
      cmocka_unit_test(keys_add_up),
      cmocka_unit_test(frames_do_not_change_speed),
      cmocka_unit_test(the_mouse_turns),
      cmocka_unit_test(steep_cameras_are_kept),
      cmocka_unit_test(switches_switch),
      cmocka_unit_test(steps_change_materials),
      cmocka_unit_test(scripts_are_read),
      cmocka_unit_test(bad_scripts_are_refused),
      cmocka_unit_test(passes_are_the_renderers),
      cmocka_unit_test(looks_reach_the_paths),
      cmocka_unit_test(starting_does_not_wait),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
