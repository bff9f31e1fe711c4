// The rasteriser against the path engine: the same light, pixel by pixel.

#include "gl_worlds.h"

#include "matter.h"

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
  w->materials[0] = world_material(MATERIAL_BLINN_PHONG, vec3_all(0.6f), BLACK);
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

// With shadow maps fewer than 1 % of the pixels differ by more than 8/255,
// those on shadows' edges; without them many do.
static void shadows_are_the_same(void **state) {
  (void)state;
  arena mem = {0};
  gl *g = gl_or_skip(GL_BACKEND_AUTO, &mem);
  material balls[2];
  for (int i = 0; i < 2; i++)
    balls[i] =
        world_material(MATERIAL_BLINN_PHONG, (vec3){0.7f, 0.5f, 0.2f}, BLACK);
  world *w = stage(balls, 2);
  raster_settings set = plain_settings();
  set.shadows = true;
  assert_true(share_apart(w, g, set, 8.0f / 255) < 0.01);
  world_free(w);
  gl_close(g);
  arena_free(&mem);
}

// A scene a million units away is drawn like one at the origin, to the floats
// that its own vertices are.
static void far_from_the_origin(void **state) {
  (void)state;
  arena mem = {0};
  gl *g = gl_or_skip(GL_BACKEND_AUTO, &mem);
  material ball =
      world_material(MATERIAL_BLINN_PHONG, (vec3){0.7f, 0.5f, 0.2f}, BLACK);
  world *near = stage(&ball, 1), *far = stage(&ball, 1);
  const vec3 away = {1 << 17, -(1 << 17), 1 << 17};
  mesh *m = &far->scene.mesh;
  for (size_t i = 0; i < m->position_count; i++) {
    vec3 p = vec3_add(m->positions[i], away);
    m->positions[i] = p;
    near->scene.mesh.positions[i] = vec3_sub(p, away);
  }
  for (int i = 0; i < 2; i++)
    far->lights[i].at = vec3_add(far->lights[i].at, away);
  world_ready(far, 3);
  world_ready(near, 3);
  raster_settings set = plain_settings();
  set.shadows = true;
  camera_view v = stage_view(), u = v;
  u.eye = vec3_add(u.eye, away);
  image a = drawn(near, g, &v, &set, &mem), b = drawn(far, g, &u, &set, &mem);
  int apart = 0;
  for (int i = 0; i < WIDTH * HEIGHT; i++)
    apart += far_apart(a.pixels[i], b.pixels[i]) > 1.0f / 255;
  print_message("# %d pixels apart\n", apart);
  assert_true(apart < WIDTH * HEIGHT / 1000);
  world_free(near);
  world_free(far);
  gl_close(g);
  arena_free(&mem);
}

// Render w by the path engine with one sample in the middle of each pixel, as
// far as the first surface: what render_run does to one ray.
static vec3 first_seen(const world *w, const camera_view *v, int x, int y,
                       raster_shading shading, float farthest) {
  hit h;
  ray r = camera_ray(v, (float)x + 0.5f, (float)y + 0.5f);
  if (!w->path.tracer.closest(w->path.tracer.tree, &r, &h))
    return vec3_all(shading == RASTER_DEPTH ? 1 : 0);
  surface s = surface_at(&w->scene, &h, r.d);
  if (shading == RASTER_NORMAL)
    return vec3_scale(vec3_add(s.ns, vec3_all(1)), 0.5f);
  if (shading == RASTER_ALBEDO) return matter_albedo(&s);
  return vec3_all(vec3_dot(vec3_sub(s.p, v->eye), v->forward) / farthest);
}

static float farthest_of(const scene *s, const camera_view *v) {
  float far = 0;
  for (int i = 0; i < 8; i++) {
    vec3 c = {i & 1 ? s->hi.x : s->lo.x, i & 2 ? s->hi.y : s->lo.y,
              i & 4 ? s->hi.z : s->lo.z};
    far = fmaxf(far, vec3_dot(vec3_sub(c, v->eye), v->forward));
  }
  return far;
}

// Normals, depth and base colours are the path engine's, as pictures and as
// AOVs; also with colours at the vertices, a mirror and a crop.
static void first_surfaces_are_the_same(void **state) {
  (void)state;
  arena mem = {0};
  error err;
  gl *g = gl_or_skip(GL_BACKEND_AUTO, &mem);
  const material balls[3] = {
      world_material(MATERIAL_MIRROR, BLACK, (vec3){0.9f, 0.8f, 0.7f}),
      world_material(MATERIAL_GLASS, BLACK, BLACK),
      world_material(MATERIAL_BLINN_PHONG, (vec3){0.9f, 0.8f, 0.7f}, BLACK)};
  world *w = stage(balls, 3);
  mesh *m = &w->scene.mesh;
  m->colors = ARENA_NEW(&w->mem, vec3, m->position_count);
  for (size_t i = 0; i < m->position_count; i++)
    m->colors[i] = (vec3){(float)(i % 3) * 0.5f, 1, (float)(i % 7) / 6};
  camera_view v = stage_view();
  float far = farthest_of(&w->scene, &v);
  raster_settings set = plain_settings();
  set.x0 = 20, set.y0 = 10, set.x1 = 150, set.y1 = 115;
  int wide = set.x1 - set.x0;
  for (int k = 1; k <= 3; k++) {
    set.shading = (raster_shading)k;
    raster *r;
    image aov;
    assert_true(raster_new(&r, g, &w->scene, &set, &mem, &err));
    assert_true(raster_draw(r, &v, &err));
    image im = raster_read(r, &mem);
    assert_true(raster_read_aov(&aov, r, set.shading, &mem, &err));
    assert_int_equal(im.width, wide);
    assert_int_equal(im.height, set.y1 - set.y0);
    for (int y = set.y0; y < set.y1; y++)
      for (int x = set.x0; x < set.x1; x++) {
        if (on_edge(w, &v, x, y)) continue;
        vec3 want = first_seen(w, &v, x, y, set.shading, far);
        vec3 got = im.pixels[(y - set.y0) * wide + x - set.x0];
        assert_true(far_apart(got, want) < 1e-4f);
        vec3 mean = aov.pixels[(y - set.y0) * wide + x - set.x0];
        bool empty = k == RASTER_DEPTH ? want.x == 1 : vec3_peak(want) == 0;
        if (k == RASTER_NORMAL)
          want = vec3_sub(vec3_scale(want, 2), vec3_all(1));
        if (k == RASTER_DEPTH) mean = vec3_scale(mean, 1 / far);
        if (empty) want = vec3_all(0);
        assert_true(vec3_peak(vec3_abs(vec3_sub(mean, want))) < 2e-4f);
      }
    raster_free(r);
  }
  world_free(w);
  gl_close(g);
  arena_free(&mem);
}

// The picture of a crop is that window of the whole picture.
static void crop_is_a_window(void **state) {
  (void)state;
  arena mem = {0};
  gl *g = gl_or_skip(GL_BACKEND_AUTO, &mem);
  material ball =
      world_material(MATERIAL_BLINN_PHONG, (vec3){0.7f, 0.5f, 0.2f}, BLACK);
  world *w = stage(&ball, 1);
  w->scene.env = (env){.kind = ENV_SKY, .scale = 0.2f};
  camera_view v = stage_view();
  raster_settings set = plain_settings();
  set.sky = true;
  image all = drawn(w, g, &v, &set, &mem);
  set.x0 = 31, set.y0 = 17, set.x1 = 92, set.y1 = 101;
  image part = drawn(w, g, &v, &set, &mem);
  int wide = set.x1 - set.x0, apart = 0;
  for (int i = 0; i < part.width * part.height; i++) {
    int at = (i / wide + set.y0) * WIDTH + i % wide + set.x0;
    apart += far_apart(part.pixels[i], all.pixels[at]) > 1e-4f;
  }
  assert_true(apart < 20);
  world_free(w);
  gl_close(g);
  arena_free(&mem);
}

// Where there is nothing the environment is seen, as env_radiance has it: a
// constant, the built-in sky and a map, turned and scaled.
static void sky_is_the_same(void **state) {
  (void)state;
  arena mem = {0};
  gl *g = gl_or_skip(GL_BACKEND_AUTO, &mem);
  image map = image_new(&mem, 32, 16);
  for (int i = 0; i < 32 * 16; i++)
    map.pixels[i] = (vec3){(float)(i % 5) / 5, (float)(i % 7) / 7, 0.5f};
  const env envs[4] = {
      {.kind = ENV_NONE, .scale = 1},
      {.kind = ENV_CONSTANT, .constant = {0.3f, 0.5f, 0.7f}, .scale = 0.5f},
      {.kind = ENV_SKY, .rotate = 0.3f, .scale = 0.2f},
      {.kind = ENV_MAP, .map = map, .rotate = 0.7f, .scale = 0.5f}};
  world *w = world_new();
  world_ready(w, 0);
  raster_settings set = plain_settings();
  set.sky = true;
  for (int k = 0; k < 4; k++)
    for (int turn = 0; turn < 3; turn++) {
      const vec3 target[3] = {{1, 0.1f, -1}, {-1, 1.5f, 0.2f}, {0, -1, 0.3f}};
      w->scene.env = envs[k];
      camera_view v = world_view(BLACK, target[turn], 80, WIDTH, HEIGHT);
      image im = drawn(w, g, &v, &set, &mem);
      float worst = 0;
      for (int i = 0; i < WIDTH * HEIGHT; i++) {
        ray r = camera_ray(&v, (float)(i % WIDTH) + 0.5f,
                           (float)(i / WIDTH) + 0.5f);
        vec3 want = env_radiance(&w->scene.env, r.d);
        worst = fmaxf(worst, far_apart(im.pixels[i], want));
      }
      // A map is filtered with weights of 8 bits.
      assert_true(worst < (k == ENV_MAP ? 1.0f / 255 : 2e-5f));
    }
  world_free(w);
  gl_close(g);
  arena_free(&mem);
}

// Under the same radiance from everywhere mirrors and glass, of balls and of
// panes, show that radiance, and a white Lambert surface does.
static void furnace(void **state) {
  (void)state;
  arena mem = {0};
  gl *g = gl_or_skip(GL_BACKEND_AUTO, &mem);
  const material balls[3] = {
      world_material(MATERIAL_MIRROR, BLACK, WHITE),
      world_material(MATERIAL_GLASS, BLACK, BLACK),
      world_material(MATERIAL_BLINN_PHONG, WHITE, BLACK)};
  world *w = stage(balls, 3);
  w->materials[0].kd = WHITE;
  w->scene.env =
      (env){.kind = ENV_CONSTANT, .constant = vec3_all(0.5f), .scale = 1};
  camera_view v = stage_view();
  raster_settings set = plain_settings();
  set.sky = true;
  set.lights = false;
  image im = drawn(w, g, &v, &set, &mem);
  for (int i = 0; i < WIDTH * HEIGHT; i++)
    assert_true(fabsf(im.pixels[i].y - 0.5f) < 1e-3f);
  world_free(w);
  gl_close(g);
  arena_free(&mem);
}

// The direction of d after the surface of unit normal n on d's side, eta the
// index on this side over that on the other.
static vec3 refracted(vec3 d, vec3 n, float eta) {
  float c = -vec3_dot(d, n);
  float t = sqrtf(1 - eta * eta * (1 - c * c));
  return vec3_add(vec3_scale(d, eta), vec3_scale(n, eta * c - t));
}

// A round ball of glass shows the sky where geometry says: in at one end of a
// chord of the sphere and out at the other.
static void glass_balls_are_round(void **state) {
  (void)state;
  arena mem = {0};
  gl *g = gl_or_skip(GL_BACKEND_AUTO, &mem);
  world *w = world_new();
  w->materials[0] = world_material(MATERIAL_GLASS, BLACK, BLACK);
  world_ball(w, BLACK, 1, 5, true, 0);
  w->scene.env = (env){.kind = ENV_SKY, .scale = 0.15f};
  world_ready(w, 0);
  camera_view v = world_view((vec3){1, 2, 8}, BLACK, 16, WIDTH, HEIGHT);
  raster_settings set = plain_settings();
  set.sky = true;
  image im = drawn(w, g, &v, &set, &mem);
  float worst = 0;
  int seen = 0;
  for (int i = 0; i < WIDTH * HEIGHT; i++) {
    ray r =
        camera_ray(&v, (float)(i % WIDTH) + 0.5f, (float)(i / WIDTH) + 0.5f);
    float b = -vec3_dot(r.o, r.d), c = vec3_dot(r.o, r.o) - 1;
    if (!(b * b - c > 0.1f)) continue;
    vec3 n = vec3_mad(r.o, b - sqrtf(b * b - c), r.d);
    vec3 inside = refracted(r.d, n, 1 / 1.5f);
    vec3 far = vec3_mad(n, -2 * vec3_dot(n, inside), inside);
    vec3 out = refracted(inside, vec3_neg(far), 1.5f);
    vec3 back = vec3_mad(r.d, -2 * vec3_dot(n, r.d), n);
    float cos_t, share = fresnel_dielectric(-vec3_dot(n, r.d), 1.5f, &cos_t);
    vec3 want = vec3_lerp(env_radiance(&w->scene.env, out),
                          env_radiance(&w->scene.env, back), share);
    worst = fmaxf(worst, far_apart(im.pixels[i], want));
    seen++;
  }
  print_message("# worst %.3f of 255\n", 255 * (double)worst);
  assert_true(seen > 5000 && worst < 2.0f / 255);
  world_free(w);
  gl_close(g);
  arena_free(&mem);
}

// One wall that fills the view from -1..1 at z = 0, by its front or its back,
// and things before it.
static world *wall(bool back) {
  world *w = world_new();
  w->materials[0] = world_material(MATERIAL_BLINN_PHONG, BLACK, BLACK);
  w->materials[0].ke = (vec3){0.25f, 0.5f, 0.75f};
  vec3 x = {20, 0, 0}, y = {0, 20, 0};
  world_quad(w, (vec3){-10, -10, 0}, back ? y : x, back ? x : y, 0);
  return w;
}

static camera_view wall_view(void) {
  return world_view((vec3){0, 0, 4}, BLACK, 20, WIDTH, HEIGHT);
}

// A surface glows on its front alone; sheets in front of it show d of
// themselves each, and what is behind them the rest, whatever their order in
// the file.
static void sheets_blend(void **state) {
  (void)state;
  arena mem = {0};
  gl *g = gl_or_skip(GL_BACKEND_AUTO, &mem);
  camera_view v = wall_view();
  raster_settings set = plain_settings();
  for (int order = 0; order < 3; order++) {
    world *w = wall(order == 2);
    for (int i = 1; i <= 2; i++) {
      w->materials[i] = w->materials[0];
      w->materials[i].ke = i == 1 ? (vec3){1, 0, 0} : (vec3){0, 1, 0};
      w->materials[i].d = i == 1 ? 0.5f : 0.25f;
      w->materials[i].passes = true;
      // Material 1 is the nearer one.
      float z = (i == 1) == (order == 0) ? 2 : 1;
      uint32_t of = order == 0 ? (uint32_t)i : (uint32_t)(3 - i);
      world_quad(w, (vec3){-9, -9, order == 0 ? z : 3 - z}, (vec3){18, 0, 0},
                 (vec3){0, 18, 0}, of);
    }
    world_ready(w, 0);
    image im = drawn(w, g, &v, &set, &mem);
    vec3 c = vec3_all(0);
    if (order < 2) c = w->materials[0].ke;
    bool first_near = w->scene.mesh.positions[4].z > 1.5f;
    for (int k = 0; k < 2; k++) {
      size_t sheet = first_near ? 1 - (size_t)k : (size_t)k;
      const material *m = &w->materials[w->scene.material_of[2 + 2 * sheet]];
      c = vec3_lerp(c, m->ke, m->d);
    }
    for (int i = 0; i < WIDTH * HEIGHT; i++)
      assert_true(far_apart(im.pixels[i], c) < 1e-5f);
    world_free(w);
  }
  gl_close(g);
  arena_free(&mem);
}

// A magnified texture is the path engine's, in colour and in numbers, scaled,
// moved and clamped.
static void textures_are_the_same(void **state) {
  (void)state;
  arena mem = {0};
  gl *g = gl_or_skip(GL_BACKEND_AUTO, &mem);
  uint8_t bytes[8 * 4 * 3];
  float decode[256];
  for (size_t i = 0; i < sizeof bytes; i++)
    bytes[i] = (uint8_t)(i * 37 % 256);
  for (int i = 0; i < 256; i++)
    decode[i] = (float)srgb_decode(i / 255.0);
  texture t = {
      .width = 8, .height = 4, .channels = 3, .bytes = bytes, .decode = decode};
  for (int clamp = 0; clamp < 2; clamp++) {
    world *w = wall(false);
    w->materials[0].kd = (vec3){0.9f, 0.8f, 0.7f};
    w->materials[0].ke = BLACK;
    w->materials[0].map_kd = (texture_map){
        &t,
        {.scale = {1.5f, 1.2f, 1}, .offset = {0.2f, -0.1f, 0}, .clamp = clamp},
        true,
        NULL};
    vec2 uv[4] = {{-4, -4}, {5, -4}, {5, 5}, {-4, 5}};
    mesh *m = &w->scene.mesh;
    m->texcoords = uv;
    m->texcoord_count = 4;
    m->texcoord_index = m->position_index;
    world_ready(w, 0);
    camera_view v = wall_view();
    raster_settings set = plain_settings();
    set.shading = RASTER_ALBEDO;
    image im = drawn(w, g, &v, &set, &mem);
    float worst = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
      vec3 want = first_seen(w, &v, i % WIDTH, i / WIDTH, RASTER_ALBEDO, 1);
      worst = fmaxf(worst, far_apart(im.pixels[i], want));
    }
    print_message("# worst %.3f of 255\n", 255 * (double)worst);
    assert_true(worst < 1.5f / 255);
    world_free(w);
  }
  gl_close(g);
  arena_free(&mem);
}

// Four samples a pixel: the mean of an edge lies between its sides, and a
// picture without edges does not change.
static void samples_are_a_mean(void **state) {
  (void)state;
  arena mem = {0};
  gl *g = gl_or_skip(GL_BACKEND_AUTO, &mem);
  world *w = world_new();
  w->materials[0] = world_material(MATERIAL_BLINN_PHONG, BLACK, BLACK);
  w->materials[0].ke = WHITE;
  world_quad(w, (vec3){-11.5f, -10, 0}, (vec3){10, 0, 0}, (vec3){3, 20, 0}, 0);
  world_ready(w, 0);
  camera_view v = wall_view();
  double sum[2] = {0, 0};
  int between[2] = {0, 0};
  for (int k = 0; k < 2; k++) {
    raster_settings set = plain_settings();
    set.msaa = k == 0 ? 1 : 4;
    image im = drawn(w, g, &v, &set, &mem);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
      float x = im.pixels[i].x;
      sum[k] += (double)x;
      between[k] += x > 0 && x < 1;
      assert_true(x >= 0 && x <= 1);
    }
  }
  assert_int_equal(between[0], 0);
  assert_true(between[1] > HEIGHT / 2);
  assert_true(fabs(sum[0] - sum[1]) < 40);
  world_free(w);
  gl_close(g);
  arena_free(&mem);
}

// A hidden material is not there, nor is its shadow; a changed one looks
// changed, and so do new settings.
static void frames_may_change(void **state) {
  (void)state;
  arena mem = {0};
  error err;
  gl *g = gl_or_skip(GL_BACKEND_AUTO, &mem);
  material ball =
      world_material(MATERIAL_BLINN_PHONG, (vec3){0.7f, 0.5f, 0.2f}, BLACK);
  world *w = stage(&ball, 1), *bare = stage(&ball, 0);
  bare->materials[1] = ball;
  world_ready(bare, 3);
  camera_view v = stage_view();
  raster_settings set = plain_settings();
  raster *r;
  size_t count;
  assert_true(raster_new(&r, g, &w->scene, &set, &mem, &err));
  raster_hide(r, 1, true);
  set.shadows = true;
  assert_true(raster_change(r, &set, &err));
  material *m = raster_materials(r, &count);
  assert_int_equal(count, WORLD_MATERIALS);
  m[0].kd = (vec3){0.1f, 0.2f, 0.3f};
  assert_true(raster_draw(r, &v, &err));
  image a = raster_read(r, &mem);
  bare->materials[0].kd = m[0].kd;
  mesh *k = &bare->scene.mesh;
  k->triangle_count -= 2;  // the quad of material 1
  image b = drawn(bare, g, &v, &set, &mem);
  int apart = 0;
  for (int i = 0; i < WIDTH * HEIGHT; i++)
    apart += far_apart(a.pixels[i], b.pixels[i]) > 1e-3f;
  assert_true(apart < 20);
  raster_free(r);
  world_free(w);
  world_free(bare);
  gl_close(g);
  arena_free(&mem);
}

// Pixels shaded once for each triangle that they see are those of triangles
// shaded where they are drawn, but for those seen from their edge.
static void once_is_each(void **state) {
  (void)state;
  arena mem = {0};
  gl *g = gl_or_skip(GL_BACKEND_AUTO, &mem);
  material balls[4];
  for (int i = 0; i < 4; i++)
    balls[i] = world_material((material_kind)i, (vec3){0.7f, 0.5f, 0.2f},
                              (vec3){0.3f, 0.3f, 0.3f});
  balls[1].roughness = 0.4f;
  world *w = stage(balls, 4);
  w->scene.env = (env){.kind = ENV_SKY, .scale = 1};
  camera_view v = stage_view();
  raster_settings set = plain_settings();
  set.shadows = set.sky = true;
  const int most[2] = {0, 10};
  for (int k = 0; k < 2; k++) {
    set.msaa = k ? 4 : 1;
    set.each = false;
    image once = drawn(w, g, &v, &set, &mem);
    set.each = true;
    image each = drawn(w, g, &v, &set, &mem);
    int apart = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++)
      apart += far_apart(once.pixels[i], each.pixels[i]) > 1.0f / 255;
    print_message("# %d samples: %d pixels apart\n", set.msaa, apart);
    assert_true(apart <= most[k]);
  }
  world_free(w);
  gl_close(g);
  arena_free(&mem);
}

// The two libraries draw the same picture, bit for bit.
static void backends_agree(void **state) {
  (void)state;
  arena mem = {0};
  material ball =
      world_material(MATERIAL_BLINN_PHONG, (vec3){0.7f, 0.5f, 0.2f}, BLACK);
  world *w = stage(&ball, 1);
  w->scene.env = (env){.kind = ENV_SKY, .scale = 0.2f};
  camera_view v = stage_view();
  raster_settings set = plain_settings();
  set.shadows = set.sky = true;
  set.msaa = 4;
  image im[2];
  for (int k = 0; k < 2; k++) {
    gl *g = gl_or_skip(k ? GL_BACKEND_EGL : GL_BACKEND_OSMESA, &mem);
    im[k] = drawn(w, g, &v, &set, &mem);
    gl_close(g);
  }
  assert_memory_equal(im[0].pixels, im[1].pixels,
                      WIDTH * HEIGHT * sizeof *im[0].pixels);
  world_free(w);
  arena_free(&mem);
}

// More lights than the shaders have room for are an error that says so.
static void too_many_lights(void **state) {
  (void)state;
  arena mem = {0};
  error err;
  gl *g = gl_or_skip(GL_BACKEND_AUTO, &mem);
  light many[RASTER_MAX_LIGHTS + 1] = {0};
  scene s = {.lights = many, .light_count = RASTER_MAX_LIGHTS + 1};
  raster_settings set = plain_settings();
  raster *r = NULL;
  assert_false(raster_new(&r, g, &s, &set, &mem, &err));
  assert_null(r);
  assert_non_null(strstr(err.text, "at most 32"));
  gl_close(g);
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(direct_light_is_the_same),
      cmocka_unit_test(shadows_are_the_same),
      cmocka_unit_test(far_from_the_origin),
      cmocka_unit_test(first_surfaces_are_the_same),
      cmocka_unit_test(crop_is_a_window),
      cmocka_unit_test(sky_is_the_same),
      cmocka_unit_test(furnace),
      cmocka_unit_test(glass_balls_are_round),
      cmocka_unit_test(sheets_blend),
      cmocka_unit_test(textures_are_the_same),
      cmocka_unit_test(samples_are_a_mean),
      cmocka_unit_test(frames_may_change),
      cmocka_unit_test(once_is_each),
      cmocka_unit_test(backends_agree),
      cmocka_unit_test(too_many_lights),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
