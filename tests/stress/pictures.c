// pictures.c — whole pictures: a sun beside darkness, scenes that nobody should
// model, and one integrator against another.

#include "../worlds.h"

#include "num.h"
#include "path.h"
#include "ready.h"
#include "stress.h"

#include <string.h>

// Render w with one of the integrators; 0 naive, 1 that which looks for lights.
static render_result draw(world *w, stress *s, const camera_view *v, int side,
                          int spp, int how) {
  light_set lights;
  light_set_build(&lights, &w->scene, true, true, &w->mem, s->threads);
  path_naive naive = {&w->path, 11 + s->slice};
  path_tracer looking = {.world = &w->path,
                         .lights = &lights,
                         .ready = ready_best(),
                         .sampler = SAMPLER_RANDOM,
                         .seed = 12 + s->slice};
  integrator by =
      how == 0 ? path_naive_integrator(&naive) : path_integrator(&looking);
  render_settings settings = {.width = side,
                              .height = side,
                              .spp = spp,
                              .by = &by,
                              .aovs = RENDER_AOV_VARIANCE};
  render_result out = {0};
  render_run(&out, &w->path, v, &settings, &w->mem, s->threads);
  return out;
}

static double pixels_wrong(const image *im) {
  double wrong = 0;
  for (int i = 0; i < im->width * im->height; i++)
    wrong += !vec3_finite(im->pixels[i]) || !(im->pixels[i].x >= 0);
  return wrong;
}

// A map that is 1e-6 but for one texel of 1e6.
static void sun_map(world *w) {
  enum { WIDTH = 64, HEIGHT = 32 };
  image map = image_new(&w->mem, WIDTH, HEIGHT);
  for (int i = 0; i < WIDTH * HEIGHT; i++)
    map.pixels[i] = vec3_all(1e-6f);
  map.pixels[8 * WIDTH + 48] = vec3_all(1e6f);  // 42 degrees up in +X
  w->scene.env = (env){.kind = ENV_MAP, .map = map, .scale = 1};
}

// The irradiance from that map on a floor, by a sum over 64 x 64 directions a
// texel.
static double irradiance(const world *w) {
  const int nu = 64 * 64, nv = 16 * 64;
  double pi = 3.141592653589793, e = 0;
  for (int v = 0; v < nv; v++) {
    double theta = (v + 0.5) / (2 * nv) * pi;
    double share = sin(theta) * cos(theta) * (pi / (2 * nv)) * (2 * pi / nu);
    for (int u = 0; u < nu; u++) {
      vec2 uv = {(float)((u + 0.5) / nu), (float)((v + 0.5) / (2 * nv))};
      e += (double)env_radiance(&w->scene.env, env_direction(uv)).x * share;
    }
  }
  return e;
}

// A floor of albedo 1/2 under that map.
static world *sunny_floor(void) {
  world *w = world_new();
  w->materials[0] =
      world_material(MATERIAL_BLINN_PHONG, vec3_all(0.5f), vec3_all(0));
  w->materials[1] =
      world_material(MATERIAL_BLINN_PHONG, vec3_all(0), vec3_all(0));
  sun_map(w);
  world_quad(w, (vec3){-50, 0, 50}, (vec3){100, 0, 0}, (vec3){0, 0, -100}, 0);
  return w;
}

// Straight down at the floor left of x = 0.5.
static camera_view floor_view(int side) {
  return world_view((vec3){0.4f, 0.3f, 0.01f}, (vec3){0.4f, 0, 0}, 10, side,
                    side);
}

// Behind a black wall that stands in the floor there is only the dark, 12
// orders below the sun.
static void dark(stress *s) {
  world *w = sunny_floor();
  world_quad(w, (vec3){0.5f, -1, -40}, (vec3){0, 0, 80}, (vec3){0, 60, 0}, 1);
  world_ready(w, 0);
  int side = 16, spp = (int)stress_count(s, 64, 1024, 65536);
  camera_view v = floor_view(side);
  render_result r = draw(w, s, &v, side, spp, 1);
  double wrong = pixels_wrong(&r.color) + (double)r.non_finite, most = 0;
  for (int i = 0; i < side * side; i++)
    most = fmax(most, (double)r.color.pixels[i].x);
  stress_print(s, (stress_row){"shadow of 1e-6 beside a sun of 1e6: brightest "
                               "pixel",
                               (double)(side * side) * spp, wrong, most, 0.5e-6,
                               "none"});
  world_free(w);
}

// Without the wall: the mean of all pixels against the integral.
static void lit(stress *s) {
  world *w = sunny_floor();
  world_ready(w, 0);
  int side = 16, spp = (int)stress_count(s, 64, 1024, 65536);
  camera_view v = floor_view(side);
  render_result r = draw(w, s, &v, side, spp, 1);
  double wrong = pixels_wrong(&r.color) + (double)r.non_finite;
  double mean = 0, variance = 0, n = (double)(side * side);
  for (int i = 0; i < side * side; i++) {
    mean += (double)r.color.pixels[i].x / n;
    variance += (double)r.aov[3].pixels[i].x / (n * n);
  }
  double want = 0.5 / 3.141592653589793 * irradiance(w);
  double z = fabs(mean - want) / (sqrt(variance) + 1e-4 * want);
  stress_print(s, (stress_row){"the floor in that sun: z against the integral",
                               n * spp, wrong, z, 4, "none"});
  world_free(w);
}

// Materials at the ends of their ranges, lamps on surfaces, faces without area.
static void fill_with_odds(world *w, rng *r) {
  const float odd[] = {0, 1, 1e-40f, 1e-3f, 0.999999f, 0.5f};
  for (int i = 0; i < WORLD_MATERIALS; i++) {
    material_kind kind = (material_kind)(i % 4);
    material *m = &w->materials[i];
    *m = world_material(kind, vec3_all(odd[(int)(rng_next(r) * 6) % 6]),
                        vec3_all(odd[(int)(rng_next(r) * 6) % 6]));
    m->ns = rng_next(r) < 0.5f ? 0 : 1e6f;
    m->ni = rng_next(r) < 0.5f ? 1 : 1 + 9 * rng_next(r);
    m->roughness = odd[(int)(rng_next(r) * 6) % 6];
    m->metallic = odd[(int)(rng_next(r) * 6) % 6];
    m->d = i == 3 ? 0.5f : 1;
    if (i == 5) m->ke = vec3_all(rng_next(r) < 0.5f ? 1e-38f : 1e12f);
  }
  for (uint32_t i = 0; i < 60; i++) {
    vec3 at = {3 * rng_next(r) - 1.5f, 3 * rng_next(r) - 1.5f,
               3 * rng_next(r) - 1.5f};
    uint32_t of = (uint32_t)(rng_next(r) * WORLD_MATERIALS) % WORLD_MATERIALS;
    float size = num_exp2(-20 * rng_next(r));
    vec3 u = {size, size * rng_next(r), 0}, v = {0, 1e-6f * rng_next(r), size};
    if (i % 3 == 0) world_ball(w, at, 0.3f * size + 0.05f, 2, i % 2, of);
    if (i % 3 == 1) world_quad(w, at, u, v, of);
    if (i % 3 == 2) world_quad(w, at, u, i % 2 ? u : vec3_all(0), of);
  }
  w->lights[0] =
      (light){LIGHT_POINT, w->scene.mesh.positions[0], vec3_all(1e20f)};
  w->lights[1] = (light){LIGHT_POINT, {0, 0, 0}, vec3_all(1e-40f)};
  w->lights[2] = (light){LIGHT_DIR, {0, -1, 0}, vec3_all(1e10f)};
  w->scene.env =
      (env){.kind = ENV_SKY, .scale = rng_next(r) < 0.5f ? 1 : 1e10f};
}

static void odd_scenes(stress *s) {
  int scenes = (int)stress_count(s, 4, 60, 1000), side = 24, spp = 32;
  double wrong = 0, dropped = 0, samples = 0;
  for (int i = 0; i < scenes; i++) {
    world *w = world_new();
    rng r = rng_of(91, (uint64_t)i, s->slice);
    fill_with_odds(w, &r);
    world_ready(w, 3);
    camera_view v = world_view((vec3){4, 1, 3}, vec3_all(0), 45, side, side);
    for (int how = 0; how < 2; how++) {
      render_result out = draw(w, s, &v, side, spp, how);
      wrong += pixels_wrong(&out.color) + pixels_wrong(&out.aov[3]);
      dropped += (double)out.non_finite;
      samples += (double)out.samples;
    }
    world_free(w);
  }
  stress_print(s,
               (stress_row){"odd scenes, both integrators: non-finite pixels",
                            samples, wrong, NO_LIMIT, NO_LIMIT, "none"});
  stress_print(s, (stress_row){"the same: samples that had to be dropped",
                               samples, dropped, NO_LIMIT, NO_LIMIT, "none"});
}

// A closed room with matt, rough, mirror and glossy balls and a lamp: each
// pixel of one integrator against the other's, in standard deviations.
static void z_test(stress *s) {
  int side = 24, spp = (int)stress_count(s, 512, 4096, 262144);
  world *w = world_new();
  w->materials[0] =
      world_material(MATERIAL_BLINN_PHONG, vec3_all(0.6f), vec3_all(0));
  w->materials[1] =
      world_material(MATERIAL_METAL_ROUGH, vec3_all(0.8f), vec3_all(0));
  w->materials[1].roughness = 0.4f;
  w->materials[1].metallic = 1;
  w->materials[2] =
      world_material(MATERIAL_MIRROR, vec3_all(0), vec3_all(0.9f));
  w->materials[3] =
      world_material(MATERIAL_BLINN_PHONG, vec3_all(0.3f), vec3_all(0.4f));
  w->materials[3].ns = 20;
  w->materials[4] =
      world_material(MATERIAL_BLINN_PHONG, vec3_all(0), vec3_all(0));
  w->materials[4].ke = vec3_all(3);
  world_box(w, (vec3){-2.5f, 0, -2}, (vec3){2.5f, 3, 5.2f}, true, 0);
  world_quad(w, (vec3){-1, 2.9f, -1}, (vec3){2, 0, 0}, (vec3){0, 0, 2}, 4);
  for (uint32_t i = 0; i < 4; i++)
    world_ball(w, (vec3){1.2f * (float)i - 1.8f, 0.5f, 0}, 0.5f, 3, true, i);
  world_ready(w, 0);
  camera_view v =
      world_view((vec3){0, 2, 5}, (vec3){0, 0.5f, 0}, 45, side, side);
  render_result a = draw(w, s, &v, side, spp, 0),
                b = draw(w, s, &v, side, spp, 1);
  double n = 0, largest = 0;
  double wrong = pixels_wrong(&a.color) + pixels_wrong(&b.color);
  for (int i = 0; i < side * side; i++) {
    double va = (double)a.aov[3].pixels[i].x + (double)b.aov[3].pixels[i].x;
    double d = (double)a.color.pixels[i].x - (double)b.color.pixels[i].x;
    n++;
    // A pixel without noise has roundings.
    double of = sqrt(va) + 1e-6 * (double)a.color.pixels[i].x;
    largest = fmax(largest, fabs(d) / of);
  }
  // Below 0.01 / n a pixel: of n right ones none is farther, in 99 of 100.
  double allowed = 1;
  while (erfc(allowed / sqrt(2.0)) > 0.01 / n)
    allowed += 0.01;
  stress_print(
      s, (stress_row){"z-test, naive against light-seeking paths: largest z",
                      2 * n * spp, wrong, largest, allowed,
                      "Mitsuba's tests: as strict"});
  world_free(w);
}

void stress_pictures(stress *s) {
  dark(s);
  lit(s);
  odd_scenes(s);
  z_test(s);
}
