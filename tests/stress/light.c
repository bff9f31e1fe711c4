// light.c — light in glass that was badly modelled, sums, and the two ends of
// the range of floats.

#include "../worlds.h"

#include "film.h"
#include "num.h"
#include "path.h"
#include "ready.h"
#include "stress.h"

#include <string.h>

static void white_sky(world *w, float level) {
  w->scene.env = (env){
      .kind = ENV_CONSTANT, .constant = {level, level, level}, .scale = 1};
}

// A ray from a sphere of radius 3 to the middle.
static ray random_ray(rng *r) {
  vec2 a = num_circle(rng_next(r)), b = num_circle(0.5f * rng_next(r));
  vec3 o = {3 * a.x * b.y, 3 * b.x, 3 * a.y * b.y};
  vec3 q = {rng_next(r) - 0.5f, rng_next(r) - 0.5f, rng_next(r) - 0.5f};
  return ray_from(o, vec3_unit(vec3_sub(vec3_scale(q, 1.6f), o)));
}

// How far samples of both integrators are from `level`, relative to it.
static double off_by(world *w, stress *s, size_t n, float level,
                     double *wrong) {
  double worst = 0;
  light_set lights;
  light_set_build(&lights, &w->scene, true, true, &w->mem, NULL);
  path_tracer p = {.world = &w->path,
                   .lights = &lights,
                   .ready = ready_best(),
                   .sampler = SAMPLER_SOBOL,
                   .seed = s->slice};
  integrator by = path_integrator(&p);
  void *room = by.room(by.self, &w->mem);
  path_stats stats = {0};
  for (size_t i = 0; i < n; i++) {
    rng r = rng_of(81 + s->slice, i, 0);
    ray q = random_ray(&r);
    path_start start = {q, i, 0};
    vec3 x = path_naive_radiance(&w->path, q, &r, &stats), y;
    by.radiance(by.self, &start, 1, &y, &stats, room);
    *wrong += !vec3_finite(x) || !vec3_finite(y);
    worst = fmax(worst, fabs((double)x.x / (double)level - 1));
    worst = fmax(worst, fabs((double)y.x / (double)level - 1));
  }
  *wrong += (double)stats.cut;
  return worst;
}

// The other side of triangle t becomes its front.
static void turn_face(mesh *m, size_t t) {
  uint32_t a = m->position_index[3 * t], b = m->normal_index[3 * t];
  m->position_index[3 * t] = m->position_index[3 * t + 1];
  m->normal_index[3 * t] = m->normal_index[3 * t + 1];
  m->position_index[3 * t + 1] = a;
  m->normal_index[3 * t + 1] = b;
}

// Glass balls under light from everywhere: whatever the normals and the
// windings, light is neither made nor lost.
static void bad_glass(stress *s) {
  size_t n = stress_count(s, 2e3, 2e5, 2e6);
  double wrong = 0, worst = 0;
  for (int kind = 0; kind < 4; kind++) {
    world *w = world_new();
    w->materials[0] = world_material(MATERIAL_GLASS, vec3_all(1), vec3_all(1));
    white_sky(w, 1);
    world_ball(w, vec3_all(0), 1, 3, true, 0);
    mesh *m = &w->scene.mesh;
    rng r = rng_of(82, s->slice, (uint64_t)kind);
    for (size_t i = 0; i < m->position_count; i++) {
      vec3 *v = &m->normals[i];
      vec3 odd = {rng_next(&r) - 0.5f, rng_next(&r) - 0.5f,
                  rng_next(&r) - 0.5f};
      if (kind == 0) *v = vec3_neg(*v);        // all point in
      if (kind == 1) *v = vec3_scale(odd, 7);  // any
      if (kind == 2 && rng_next(&r) < 0.3f)    // none, or not numbers
        *v = rng_next(&r) < 0.5f ? vec3_all(0) : vec3_all(NAN);
    }
    for (size_t t = 0; t < m->triangle_count && kind == 3; t++)
      if (rng_next(&r) < 0.5f) turn_face(m, t);
    world_ready(w, 0);
    worst = fmax(worst, off_by(w, s, n / 4, 1, &wrong));
    world_free(w);
  }
  stress_print(s, (stress_row){"glass with normals in, at random, NaN, faces "
                               "turned: furnace",
                               2 * (double)n, wrong, worst, 1e-4, "none"});
}

// A thousand hollow balls of glass, one inside the other: two thousand
// surfaces. Paths of thousands of segments play roulette, so that the law is
// one of the mean.
static void shells(stress *s) {
  size_t n = stress_count(s, 20, 400, 1e5);
  world *w = world_new();
  w->materials[0] = world_material(MATERIAL_GLASS, vec3_all(1), vec3_all(1));
  white_sky(w, 1);
  mesh *m = &w->scene.mesh;
  for (int i = 0; i < 2000; i++) {
    size_t from = m->triangle_count;
    world_ball(w, vec3_all(0), 0.5f + 0.00025f * (float)i, 0, false, 0);
    for (size_t t = from; i % 2 == 0 && t < m->triangle_count; t++)
      turn_face(m, t);
  }
  world_ready(w, 0);
  path_stats stats = {0};
  double wrong = 0, sum = 0, sum2 = 0;
  for (size_t i = 0; i < n; i++) {
    rng r = rng_of(84 + s->slice, i, 0);
    double x =
        (double)path_naive_radiance(&w->path, random_ray(&r), &r, &stats).x;
    wrong += !isfinite(x);
    sum += x;
    sum2 += x * x;
  }
  double mean = sum / (double)n, variance = sum2 / (double)n - mean * mean;
  double z = fabs(mean - 1) / (sqrt(fmax(variance, 0) / (double)n) + 1e-4);
  wrong += (double)stats.cut;
  stress_print(
      s, (stress_row){"1000 nested shells of glass: furnace, z of the mean",
                      (double)n, wrong, z, 4, "none"});
  world_free(w);
}

// A cube of diamond with the camera inside: most light never comes out, and
// its paths end all the same.
static void trapped(stress *s) {
  size_t n = stress_count(s, 500, 1e4, 1e6);
  double wrong = 0;
  world *w = world_new();
  w->materials[0] = world_material(MATERIAL_GLASS, vec3_all(1), vec3_all(1));
  w->materials[0].ni = 2.4f;
  white_sky(w, 1);
  world_box(w, (vec3){-1, -1, -1}, (vec3){1, 1, 1}, false, 0);
  world_ready(w, 0);
  path_stats stats = {0};
  for (size_t i = 0; i < n; i++) {
    rng r = rng_of(83 + s->slice, i, 0);
    vec3 o = {rng_next(&r) - 0.5f, rng_next(&r) - 0.5f, rng_next(&r) - 0.5f};
    ray q = ray_from(o, vec3_unit(vec3_sub(random_ray(&r).o, o)));
    wrong += !vec3_finite(path_naive_radiance(&w->path, q, &r, &stats));
  }
  wrong += (double)stats.cut;
  stress_print(
      s, (stress_row){"light shut in a cube of diamond: paths without end",
                      (double)n, wrong, NO_LIMIT, NO_LIMIT, "none"});
  world_free(w);
}

// Light of 1e-40, which is denormal, and of 1e30, among grey and glass balls.
static void both_ends(stress *s) {
  const float level[] = {1e-40f, 1e-38f, 1e-30f, 1e30f, 1e37f};
  size_t n = stress_count(s, 500, 2e4, 2e5);
  double wrong = 0, worst = 0;
  for (int i = 0; i < 5; i++) {
    world *w = world_new();
    w->materials[0] = world_material(MATERIAL_GLASS, vec3_all(1), vec3_all(1));
    w->materials[1] =
        world_material(MATERIAL_BLINN_PHONG, vec3_all(1), vec3_all(0));
    w->materials[2] =
        world_material(MATERIAL_METAL_ROUGH, vec3_all(1), vec3_all(0));
    w->materials[2].metallic = 0;
    w->materials[2].roughness = 0.5f;
    white_sky(w, level[i]);
    world_ball(w, (vec3){-0.6f, 0, 0}, 0.5f, 3, true, 0);
    world_ball(w, (vec3){0.6f, 0, 0}, 0.5f, 3, true, 1);
    world_ready(w, 0);
    worst = fmax(worst, off_by(w, s, n, level[i], &wrong));
    world_free(w);
  }
  stress_print(
      s, (stress_row){"light of 1e-40 (denormal) to 1e37: furnace of white",
                      10 * (double)n, wrong, worst, 1e-3, "none"});
}

// Sums of 2^20 samples against long double, of samples that differ 1e12 times.
static void sums(stress *s) {
  size_t n = (size_t)1 << (s->size == STRESS_SHORT ? 16 : 20);
  double worst = 0, plain_worst = 0, spread = 0;
  int kinds = 4;
  for (int kind = 0; kind < kinds; kind++) {
    arena mem = {0};
    film f = film_new(&mem, 1, 1, true);
    rng r = rng_of(84, s->slice, (uint64_t)kind);
    long double sum = 0, square = 0;
    float plain = 0;
    for (size_t i = 0; i < n; i++) {
      float u = rng_next(&r), x = 0.1f;
      if (kind == 1) x = u;
      if (kind == 2) x = num_exp2(40 * u - 20);
      if (kind == 3) x = i % 1000 == 0 ? 1e6f : 1e-6f;
      film_add(&f, 0, vec3_all(x));
      plain += x;
      sum += (long double)x;
      square += (long double)x * (long double)x;
    }
    long double mean = sum / (long double)n;
    long double variance =
        (square - sum * mean) / (long double)(n - 1) / (long double)n;
    worst =
        fmax(worst, (double)fabsl((long double)film_mean(&f, 0).x / mean - 1));
    plain_worst =
        fmax(plain_worst, (double)fabsl((long double)plain / sum - 1));
    if (kind > 0)
      spread = fmax(
          spread,
          (double)fabsl((long double)film_variance(&f, 0).x / variance - 1));
    arena_free(&mem);
  }
  char what[64];
  snprintf(what, sizeof what, "2^%d samples a pixel: error of the mean",
           s->size == STRESS_SHORT ? 16 : 20);
  char plain_text[48];
  snprintf(plain_text, sizeof plain_text, "%.1g (sums in float)", plain_worst);
  stress_print(
      s, (stress_row){what, (double)n * kinds, 0, worst, 6e-8, plain_text});
  stress_print(s, (stress_row){"the same: error of its estimated variance",
                               (double)n * kinds, 0, spread, 1e-6, "none"});
}

// The curve of sRGB and its inverse in long double.
static long double curve(long double x) {
  return x <= 0.0031308L ? 12.92L * x : 1.055L * powl(x, 1 / 2.4L) - 0.055L;
}

static long double inverse(long double y) {
  return y <= 0.04045L ? y / 12.92L : powl((y + 0.055L) / 1.055L, 2.4L);
}

// The two floats on either side of each place where a code changes; in the
// long run every float from 0 to 1, whose codes never fall.
static void rounding(stress *s, int top) {
  srgb_table t = srgb_table_new();
  double wrong = 0, tried = 0;
  for (int k = 0; k < top; k++) {
    float near = (float)inverse((k + 0.5L) / top);
    for (int side = -1; side <= 1; side++) {
      float x = side == 0 ? near : nextafterf(near, side < 0 ? 0.0f : 2.0f);
      long want = (long)(top * curve((long double)x) + 0.5L);
      wrong += want != (top == 255 ? srgb_code(&t, x) : srgb_code16(x));
      tried++;
    }
  }
  int last = 0;
  uint32_t one = 0x3f800000u, step = s->size == STRESS_LONG ? 1 : 6151;
  for (uint32_t bits = 0; bits < one; bits += step) {
    float x;
    memcpy(&x, &bits, sizeof x);
    int code = top == 255 ? srgb_code(&t, x) : srgb_code16(x);
    wrong += code < last;
    last = code;
    tried++;
  }
  stress_print(s,
               (stress_row){top == 255 ? "every rounding to 8 bits of sRGB"
                                       : "every rounding to 16 bits of sRGB",
                            tried, wrong, NO_LIMIT, NO_LIMIT,
                            top == 255 ? "149 of 510 wrong (powf)" : "none"});
}

void stress_light(stress *s) {
  bad_glass(s);
  shells(s);
  trapped(s);
  both_ends(s);
  sums(s);
  rounding(s, 255);
  rounding(s, 65535);
}
