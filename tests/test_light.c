// test_light.c — laws of the samplers of light.

#include "chi.h"
#include "light.h"
#include "light_emission.h"
#include "num.h"
#include "skies.h"
#include "worlds.h"

// Chi-square tests that go wrong by chance once in a thousand.
#define LEAST_PROBABILITY 1e-3

// Probabilities are whole units: each number of the 2^24 picks one, in order,
// and as many as the share says.
static void picks_are_exact(void **state) {
  (void)state;
  arena mem = {0};
  enum { N = 1000 };
  pick p = pick_new(&mem, N);
  double weights[N], sums[N];
  rng r = rng_of(1, 2, 3);
  for (int i = 0; i < N; i++)
    weights[i] = i % 7 == 0 ? 0 : i == 500 ? 1e6 : pow((double)rng_next(&r), 8);
  double sum;
  memcpy(sums, weights, sizeof sums);
  pick_weigh(&p, sums, &sum);
  static uint32_t count[N];
  for (uint32_t unit = 0; unit < PICK_UNITS; unit += 1) {
    float u = (float)unit / PICK_UNITS, share;
    uint32_t i = pick_at(&p, &u, &share);
    assert_true(i < N && share > 0 && u >= 0 && u < 1);
    count[i]++;
  }
  for (uint32_t i = 0; i < N; i++) {
    assert_true(pick_share(&p, i) == (float)count[i] / PICK_UNITS);
    double want = weights[i] / sum;
    assert_true(fabs((double)pick_share(&p, i) - want) < 1.01 / PICK_UNITS);
  }
  arena_free(&mem);
}

// Maps that are hard in one way each.
typedef enum map_kind {
  NOISE,
  HOT,
  DARK,
  GREY,
  SMALL,
  SKY,
  MAP_KINDS
} map_kind;

static const sky_plan PLANS[MAP_KINDS] = {
    [NOISE] = {SKY_NOISE, 32, 16, .rotate = 0.3f},
    [HOT] = {SKY_HOT, 32, 16, 200, 0.3f},
    [DARK] = {SKY_DARK, 32, 16, .rotate = 0.3f},
    [GREY] = {SKY_EVEN, 32, 16, .rotate = 0.3f},
    [SMALL] = {SKY_NOISE, 3, 1, .rotate = 0.3f},
    [SKY] = {SKY_BUILT_IN, 32, 16, .rotate = 0.3f},
};

enum { CELLS_X = 48, CELLS_Y = 24, CELLS = CELLS_X * CELLS_Y };

static int cell_of(vec3 wi) {
  vec2 uv = env_uv(wi);
  int x = (int)(uv.x * CELLS_X), y = (int)(uv.y * CELLS_Y);
  return (y < CELLS_Y ? y : CELLS_Y - 1) * CELLS_X + (x < CELLS_X ? x : 0);
}

// Many who wait together are given what each would be given alone.
static void many_samples_are_those_of_one(void **state) {
  (void)state;
  enum { MANY = 300 };  // in more rounds than one, and the last not full
  arena mem = {0};
  for (map_kind kind = 0; kind < MAP_KINDS; kind++) {
    env e = sky_env(&PLANS[kind], &mem);
    light_env l;
    light_env_build(&l, &e, &mem, NULL);
    vec2 u[MANY];
    env_sample all[MANY];
    rng r = rng_of(6, (uint64_t)kind, 0);
    for (int i = 0; i < MANY; i++)
      u[i] = (vec2){rng_next(&r), rng_next(&r)};
    light_env_samples(&l, u, MANY, all);
    for (int i = 0; i < MANY; i++) {
      env_sample one = light_env_sample(&l, u[i]);
      assert_memory_equal(&one, &all[i], sizeof one);
      if (!(one.pdf > 0)) continue;
      vec3 seen = env_radiance(&e, one.wi);
      float off = vec3_peak(vec3_abs(vec3_sub(one.radiance, seen)));
      assert_true(kind == HOT || off < 1e-3f * vec3_peak(seen));
    }
  }
  arena_free(&mem);
}

// The integral of the density over each cell of the sphere; their sum.
static double integrate_env(const light_env *l, double *cells) {
  enum { FINE = 40 };
  const int w = CELLS_X * FINE, h = CELLS_Y * FINE;
  double total = 0;
  for (int i = 0; i < w * h; i++) {
    vec2 uv = {((float)(i % w) + 0.5f) / (float)w,
               ((float)(i / w) + 0.5f) / (float)h};
    double sine = sin(3.14159265358979 * (double)uv.y);
    double area = 2 * 9.869604401089358 * sine / w / h;
    double share = (double)light_env_pdf(l, env_direction(uv)) * area;
    cells[i / w / FINE * CELLS_X + i % w / FINE] += share;
    total += share;
  }
  return total;
}

// Directions come as often as the density says, which integrates to 1; and it
// is the same for a direction that was found in another way.
static void env_samples_follow_their_density(void **state) {
  (void)state;
  arena mem = {0};
  const long n = shortened(1000000);
  for (map_kind kind = 0; kind < MAP_KINDS; kind++) {
    env e = sky_env(&PLANS[kind], &mem);
    light_env l;
    light_env_build(&l, &e, &mem, NULL);
    bool any = kind != DARK && kind != GREY;
    assert_true(any == (l.irradiance > 0));
    if (!any) continue;
    double want[CELLS] = {0}, got[CELLS] = {0}, worst = 0;
    double total = integrate_env(&l, want);
    rng r = rng_of(2, (uint64_t)kind, 0);
    for (long i = 0; i < n; i++) {
      float u1 = rng_next(&r), u2 = rng_next(&r);
      env_sample s = light_env_sample(&l, (vec2){u1, u2});
      assert_true(s.pdf > 0);
      double off = fabs((double)(light_env_pdf(&l, s.wi) / s.pdf) - 1);
      worst = fmax(worst, off);
      got[cell_of(s.wi)]++;
    }
    for (int i = 0; i < CELLS; i++)
      want[i] *= (double)n;
    double p = chi_probability(got, want, CELLS);
    print_message("# map %d: integral %.6f, p %.3f, densities within %.1e\n",
                  (int)kind, total, p, worst);
    assert_true(fabs(total - 1) < 1e-5 && p > LEAST_PROBABILITY &&
                worst < 5e-3);
  }
  arena_free(&mem);
}

// Grid over a triangle: s = b + c by its square, and b / s.
enum { GRID = 20 };

static size_t grid_cell(double b, double c) {
  double s = b + c;
  int x = (int)(s * s * GRID), y = s > 0 ? (int)(b / s * GRID) : 0;
  x = x < GRID ? x : GRID - 1;
  y = y < GRID ? y : GRID - 1;
  return (size_t)(x * GRID + y);
}

// The density over each cell of the grid, by solid angle; the sum.
static double integrate_triangle(const light_triangle *t, vec3 p,
                                 double *cells) {
  const int fine = GRID * 50;
  double total = 0;
  for (int i = 0; i < fine * fine; i++) {
    double s = sqrt((i / fine + 0.5) / fine), b = s * (i % fine + 0.5) / fine;
    vec3 q = vec3_mad(vec3_mad(t->a, (float)b, t->ab), (float)(s - b), t->ac);
    vec3 d = vec3_sub(q, p);
    double d2 = (double)vec3_dot(d, d);
    double cosine = (double)vec3_dot(t->n, d) / -sqrt(d2);
    double angle = (double)t->area * cosine / d2 / fine / fine;
    double share = (double)light_triangle_pdf(t, p, q) * angle;
    cells[grid_cell(b, s - b)] += share;
    total += share;
  }
  return total;
}

static void check_triangle(const light_triangle *t, vec3 p) {
  const long n = shortened(1000000);
  double want[GRID * GRID] = {0}, got[GRID * GRID] = {0};
  double total = integrate_triangle(t, p, want);
  rng r = rng_of(3, 0, 0);
  for (long i = 0; i < n; i++) {
    light_point q;
    float u1 = rng_next(&r), u2 = rng_next(&r);
    assert_true(light_triangle_sample(t, p, u1, u2, &q));
    assert_true(q.b >= 0 && q.c >= 0 && q.b + q.c < 1 + 1e-6f);
    assert_true(q.pdf == light_triangle_pdf(t, p, q.at));
    got[grid_cell((double)q.b, (double)q.c)]++;
  }
  for (int i = 0; i < GRID * GRID; i++)
    want[i] *= (double)n;
  double chi = chi_probability(got, want, GRID * GRID);
  print_message("# from (%g, %g, %g): integral %.6f, p %.3f\n", (double)p.x,
                (double)p.y, (double)p.z, total, chi);
  assert_true(fabs(total - 1) < 3e-3 && chi > LEAST_PROBABILITY);
}

// Points of a triangle come as often as the density says: from near and far,
// over it and beside it, grazing, and from almost on it; of a needle too.
static void triangle_samples_follow_their_density(void **state) {
  (void)state;
  static const vec3 FROM[] = {{0.3f, 0.3f, 0.5f},   {0.3f, 0.3f, 0.02f},
                              {5, 2, 0.3f},         {0.4f, 0.3f, 5.7f},
                              {0.4f, 0.3f, 30},     {100, -50, 10},
                              {-0.5f, 0.1f, 0.05f}, {0.9f, 0.01f, 0.1f}};
  light_triangle t, needle;
  vec3 a = {0, 0, 0}, b = {1, 0, 0}, c = {0.3f, 1, 0}, d = {0.5f, 0.002f, 0};
  assert_true(light_triangle_of(&t, a, b, c));
  assert_true(light_triangle_of(&needle, a, b, d));
  for (size_t i = 0; i < sizeof FROM / sizeof *FROM; i++)
    check_triangle(&t, FROM[i]);
  check_triangle(&needle, FROM[0]);
  check_triangle(&needle, FROM[2]);
}

// Irradiance on a floor at p from a polygon of radiance 1 that is all above it:
// half the sum over its edges of the angle times how upright its plane with p
// is.  Source: Lambert 1760, section 2 of Baum et al. 1989.
static double lambert(vec3 p, const vec3 *corners) {
  double sum = 0, v[4][3];
  for (int i = 0; i < 4; i++) {
    vec3 d = vec3_sub(corners[i % 3], p);
    double x = (double)d.x, y = (double)d.y, z = (double)d.z;
    double length = sqrt(x * x + y * y + z * z);
    v[i][0] = x / length, v[i][1] = y / length, v[i][2] = z / length;
  }
  for (int i = 0; i < 3; i++) {
    const double *a = v[i], *b = v[i + 1];
    double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2];
    double z = a[0] * b[1] - a[1] * b[0], sine = sqrt(x * x + y * y + z * z);
    double cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    if (sine > 0) sum += atan2(sine, cosine) * y / sine;
  }
  return fabs(sum) / 2;
}

// A ceiling of n by n separate triangles that shine down with radiance 1.
static void add_ceiling(world *w, int n, float size) {
  w->materials[1] =
      world_material(MATERIAL_BLINN_PHONG, vec3_all(0.5f), vec3_all(0));
  w->materials[1].ke = vec3_all(1);
  float step = 4 / (float)n;
  for (int i = 0; i < n * n; i++) {
    float x = (float)(i % n) * step - 2, z = (float)(i / n) * step - 2;
    uint32_t a = world_vertex(w, (vec3){x, 2, z});
    uint32_t b = world_vertex(w, (vec3){x + size * step, 2, z});
    uint32_t c = world_vertex(w, (vec3){x, 2, z + size * step});
    world_triangle(w, (uint32_t[]){a, b, c}, 1);
  }
}

static double ceiling_irradiance(const world *w, vec3 p) {
  const mesh *m = &w->scene.mesh;
  double sum = 0;
  for (size_t t = 0; t < m->triangle_count; t++) {
    vec3 corners[3];
    for (size_t i = 0; i < 3; i++)
      corners[i] = m->positions[m->position_index[3 * t + i]];
    sum += lambert(p, corners);
  }
  return sum;
}

static double squared(double x) {
  return x * x;
}

// What a cosine-distributed ray finds, with the weight of the balance
// heuristic against light sampling.
static double by_scattering(const world *w, const light_set *l, vec3 p,
                            rng *random) {
  float u1 = rng_next(random), u2 = rng_next(random), s = sqrtf(u2);
  vec2 c = num_circle(u1);
  vec3 n = {0, 1, 0}, wi = {s * c.x, sqrtf(1 - u2), s * c.y};
  ray r = {.o = p, .d = wi, .tmin = 0, .tmax = INFINITY};
  float pdf = wi.y / PI, other, radiance;
  hit h;
  if (w->path.tracer.closest(w->path.tracer.tree, &r, &h)) {
    radiance = light_emission(&w->scene, h.triangle, h.b1, h.b2).x;
    other = light_pdf_triangle(l, p, n, h.triangle, vec3_mad(p, h.t, wi));
  } else {
    radiance = env_radiance(&w->scene.env, wi).x;
    other = light_pdf_env(l, p, n, env_uv(wi));
  }
  return (double)(radiance * PI * pdf / (pdf + other));
}

static double by_light(const light_set *l, vec3 p, bool weighed, rng *random) {
  vec3 n = {0, 1, 0}, u;
  u.x = rng_next(random), u.y = rng_next(random), u.z = rng_next(random);
  light_sample s;
  if (!light_sample_at(l, p, n, u, &s) || !(s.wi.y > 0)) return 0;
  double x = (double)(s.radiance.x * s.wi.y / s.pdf);
  double other = (double)(s.wi.y / PI);
  if (!weighed || s.delta) return x;
  return x * (double)s.pdf / ((double)s.pdf + other);
}

// The irradiance at p by n samples: of light alone, or of both kinds.
static estimate irradiance(const world *w, const light_set *l, vec3 p,
                           bool both, long n) {
  rng random = rng_of(4, 0, 0);
  double sum = 0, squares = 0;
  for (long i = 0; i < n; i++) {
    double x = by_light(l, p, both, &random);
    if (both) x += by_scattering(w, l, p, &random);
    sum += x;
    squares += x * x;
  }
  double mean = sum / (double)n;
  return (estimate){
      mean, sqrt(fmax(squares / (double)n - squared(mean), 0) / (double)n)};
}

static void check_irradiance(const world *w, const light_set *l, vec3 p,
                             bool both, double want) {
  estimate e = irradiance(w, l, p, both, shortened(400000));
  print_message("# at (%g, %g, %g) %s: %.5f +- %.5f, expected %.5f\n",
                (double)p.x, (double)p.y, (double)p.z, both ? "both" : "light",
                e.mean, e.error, want);
  assert_true(fabs(e.mean - want) <= 4 * e.error + 1e-5 * want);
}

// One light or 20,000: below a ceiling of shining triangles the irradiance is
// Lambert's sum.
static void polygons_shine_as_lambert_says(void **state) {
  (void)state;
  static const int SIDES[] = {1, 2, 3, 141};
  for (int i = 0; i < 4; i++) {
    world *w = world_new();
    add_ceiling(w, SIDES[i], 0.9f);
    world_ready(w, 0);
    light_set l;
    light_set_build(&l, &w->scene, true, true, &w->mem, NULL);
    assert_int_equal(l.near.count, SIDES[i] * SIDES[i]);
    static const vec3 AT[] = {{0, 0, 0}, {-1.5f, 1.9f, -1.5f}, {9, 1, 3}};
    for (int k = 0; k < 3; k++) {
      double want = ceiling_irradiance(w, AT[k]);
      check_irradiance(w, &l, AT[k], false, want);
      check_irradiance(w, &l, AT[k], true, want);
    }
    world_free(w);
  }
}

// The irradiance of an environment on a floor, by summing over the sphere.
static double sum_env(const env *e) {
  const int h = 1500, w = 2 * h;
  double sum = 0;
  for (int i = 0; i < h / 2; i++)
    for (int j = 0; j < w; j++) {
      vec2 uv = {((float)j + 0.5f) / (float)w, ((float)i + 0.5f) / (float)h};
      double a = 3.14159265358979 * (double)uv.y;
      sum += (double)env_radiance(e, env_direction(uv)).x * sin(a) * cos(a);
    }
  return sum * 2 * 9.869604401089358 / w / h;
}

// Both kinds of samples together find all of the light of an environment, and
// of everything at once.
static void everything_adds_up(void **state) {
  (void)state;
  for (map_kind kind = 0; kind < MAP_KINDS; kind++) {
    world *w = world_new();
    w->scene.env = sky_env(&PLANS[kind], &w->mem);
    double want = sum_env(&w->scene.env);
    world_ready(w, 0);
    light_set l;
    light_set_build(&l, &w->scene, true, true, &w->mem, NULL);
    check_irradiance(w, &l, (vec3){0, 0, 0}, true, want);
    world_free(w);
  }
  world *w = world_new();
  w->scene.env =
      (env){.kind = ENV_CONSTANT, .constant = vec3_all(0.25f), .scale = 1};
  add_ceiling(w, 3, 0.5f);
  w->lights[0] = (light){LIGHT_POINT, {1, 1, 1}, vec3_all(2)};
  w->lights[1] = (light){LIGHT_DIR, {1, -1, 0}, vec3_all(0.5f)};
  w->lights[2] = (light){LIGHT_DIR, {0, 1, 0}, vec3_all(9)};  // from below
  world_ready(w, 3);
  light_set l;
  light_set_build(&l, &w->scene, true, true, &w->mem, NULL);
  vec3 p = {0.3f, 0, -0.4f}, d = vec3_sub(w->lights[0].at, p);
  double want = 0.75 * ceiling_irradiance(w, p) + 0.25 * 3.14159265358979;
  want += 2 / pow((double)vec3_length(d), 3) + 0.5 * sqrt(0.5);
  check_irradiance(w, &l, p, true, want);
  world_free(w);
}

// Emitters of all sizes and directions in a cloud.
static world *cloud_of_lights(int n) {
  world *w = world_new();
  rng r = rng_of(6, 0, 0);
  w->materials[1].ke = (vec3){1, 0.5f, 0.25f};
  for (int i = 0; i < n; i++) {
    vec3 c = {rng_next(&r), rng_next(&r), rng_next(&r)};
    float size = powf(rng_next(&r), 6);
    uint32_t v[3];
    for (int k = 0; k < 3; k++) {
      vec3 o = {rng_next(&r) - 0.5f, rng_next(&r) - 0.5f, rng_next(&r) - 0.5f};
      v[k] = world_vertex(w, vec3_mad(c, size, o));
    }
    world_triangle(w, v, 1);
  }
  for (int i = 0; i < 4; i++)
    w->lights[i] =
        (light){LIGHT_POINT, {(float)i, 0.5f, 1}, vec3_all(0.1f * (float)i)};
  world_ready(w, 4);
  return w;
}

// Going down the tree picks an emitter as often as its share says, inside the
// cloud and outside, for every normal; what the shares lack to 1 is how often
// the way down ends at lights that all look away.
static void picks_follow_their_shares(void **state) {
  (void)state;
  enum { N = 1000, POINTS = 30 };
  world *w = cloud_of_lights(N);
  light_set l;
  light_set_build(&l, &w->scene, true, true, &w->mem, NULL);
  const light_tree *t = &l.near;
  assert_in_range(t->count, N * 9 / 10, N + 3);
  rng r = rng_of(7, 0, 0);
  for (int k = 0; k < POINTS; k++) {
    double want[N + 4] = {0}, got[N + 4] = {0}, total = 0, n = 50000;
    vec3 p = {4 * rng_next(&r) - 1.5f, 4 * rng_next(&r) - 1.5f, rng_next(&r)};
    vec3 normal = vec3_unit(
        (vec3){rng_next(&r) - 0.5f, rng_next(&r) - 0.5f, rng_next(&r) - 0.5f});
    light_place at = light_place_of(p, k % 3 == 0 ? vec3_all(0) : normal);
    bool seen = false;
    for (uint32_t i = 0; i < t->count; i++) {
      double share = (double)light_tree_share(t, &at, i);
      assert_true((share > 0) <=
                  (light_bound_emitter(&t->emitters[i], &at) > 0));
      want[i] = share * n;
      total += share;
      seen |= light_bound_emitter(&t->emitters[i], &at) > 0;
    }
    for (int i = 0; i < (int)n; i++) {
      uint32_t e;
      float share;
      double u = (double)rng_next(&r) + (double)rng_next(&r) * 0x1p-24;
      if (!light_tree_pick(t, &at, u, &e, &share)) {
        got[t->count]++;
        continue;
      }
      double off = fabs((double)(share / light_tree_share(t, &at, e)) - 1);
      assert_true(off < 1e-5);
      got[e]++;
    }
    want[t->count] = fmax(1 - total, 0) * n;
    double chi = chi_probability(got, want, t->count + 1);
    print_message("# place %d: shares add up to %.4f, p %.3f\n", k, total, chi);
    assert_true(total < 1.00001 && (total > 0) == seen);
    assert_true(chi > LEAST_PROBABILITY / POINTS);
  }
  world_free(w);
}

// A choice by one float among 50,000 equal lights reaches each of them.
static void all_of_many_lights_are_reached(void **state) {
  (void)state;
  world *w = world_new();
  const int side = 220;
  add_ceiling(w, side, 0.5f);
  world_ready(w, 0);
  light_set l;
  light_set_build(&l, &w->scene, true, true, &w->mem, NULL);
  uint32_t *count = ARENA_NEW(&w->mem, uint32_t, l.near.count);
  rng r = rng_of(8, 0, 0);
  light_place at = light_place_of((vec3){0, -100, 0}, (vec3){0, 1, 0});
  const long n = shortened(5000000);
  for (long i = 0; i < n; i++) {
    uint32_t e;
    float share;
    double u = (double)rng_next(&r);
    assert_true(light_tree_pick(&l.near, &at, u, &e, &share));
    count[e]++;
  }
  uint32_t missed = 0;
  for (uint32_t i = 0; i < l.near.count; i++)
    missed += count[i] == 0;
  assert_true(missed == 0 || n < 5000000);
  world_free(w);
}

static void check_finite(const light_set *l, vec3 p, vec3 n, vec3 u) {
  light_sample s;
  bool found = light_sample_at(l, p, n, u, &s);
  if (!found) return;
  assert_true(s.pdf > 0 && isfinite(s.pdf));
  assert_true(vec3_finite(s.wi) && vec3_finite(s.radiance));
  assert_true(fabsf(vec3_length(s.wi) - 1) < 1e-5f);
  assert_true(!s.has_end || vec3_finite(s.to));
}

// Points on a light, in its plane, at its corners, at a point light, far away
// or nowhere; lights without area or power; numbers at the ends of their range.
static void nothing_is_ever_not_finite(void **state) {
  (void)state;
  world *w = world_new();
  w->scene.env = sky_env(&PLANS[HOT], &w->mem);
  add_ceiling(w, 1, 1);
  w->materials[2] = w->materials[1];
  w->materials[2].ke = vec3_all(1e30f);
  uint32_t a = world_vertex(w, (vec3){0, 1, 0});
  uint32_t b = world_vertex(w, (vec3){1, 1, 0});
  uint32_t c = world_vertex(w, (vec3){2, 1, 0});
  uint32_t d = world_vertex(w, (vec3){0, 1, 1e-30f});
  uint32_t f = world_vertex(w, (vec3){NAN, 1, 0});
  uint32_t g = world_vertex(w, (vec3){1e30f, 1e30f, 0});
  world_triangle(w, (uint32_t[]){a, b, c}, 1);  // no area
  world_triangle(w, (uint32_t[]){a, a, a}, 1);
  world_triangle(w, (uint32_t[]){a, b, d}, 1);
  world_triangle(w, (uint32_t[]){a, b, f}, 1);
  world_triangle(w, (uint32_t[]){a, b, g}, 2);
  w->lights[0] = (light){LIGHT_POINT, {0, 0, 0}, vec3_all(1)};
  w->lights[1] = (light){LIGHT_POINT, {0, 0, 0}, vec3_all(0)};
  w->lights[2] = (light){LIGHT_DIR, {0, -1, 0}, vec3_all(1)};
  world_ready(w, 3);
  light_set l;
  light_set_build(&l, &w->scene, true, true, &w->mem, NULL);
  static const vec3 AT[] = {
      {0, 0, 0},    {0, 2, 0},   {-2, 2, -2},      {-2, 1.9999f, -2},
      {2, 2, 2},    {50, 2, 50}, {0, 1e-30f, 0},   {1e30f, 1e30f, 1e30f},
      {0, 1, 0},    {NAN, 0, 0}, {INFINITY, 0, 0}, {0, 1.99999f, 0},
      {1e19f, 0, 0}};
  static const vec3 TO[] = {{0, 1, 0}, {0, -1, 0}, {1, 0, 0}, {0, 0, 0}};
  static const float U[] = {0, 0x1p-24f, 0.3f, 0.5f, 0.9f, 1 - 0x1p-24f};
  for (size_t i = 0; i < sizeof AT / sizeof *AT; i++)
    for (size_t k = 0; k < sizeof TO / sizeof *TO; k++) {
      for (int j = 0; j < 6 * 6 * 6; j++)
        check_finite(&l, AT[i], TO[k],
                     (vec3){U[j % 6], U[j / 6 % 6], U[j / 36]});
      for (uint32_t t = 0; t < w->scene.mesh.triangle_count; t++) {
        float pdf = light_pdf_triangle(&l, AT[i], TO[k], t, AT[(i + 1) % 9]);
        assert_true(pdf >= 0 && isfinite(pdf));
      }
      float pdf = light_pdf_env(&l, AT[i], TO[k], (vec2){0, 0});
      assert_true(pdf >= 0 && isfinite(pdf));
    }
  world_free(w);
}

// Those who ask all kinds of light together, and one by one.
static void many_questions_are_those_of_one(void **state) {
  (void)state;
  enum { MANY = 150 };
  world *w = world_new();
  w->scene.env = sky_env(&PLANS[NOISE], &w->mem);
  add_ceiling(w, 3, 0.5f);
  w->lights[0] = (light){LIGHT_DIR, {1, -1, 0}, {3, 3, 3}};
  w->lights[1] = (light){LIGHT_POINT, {0, 0.5f, 0}, {1, 1, 1}};
  world_ready(w, 2);
  light_set l;
  light_set_build(&l, &w->scene, true, true, &w->mem, NULL);
  light_question q[MANY];
  light_sample all[MANY];
  rng r = rng_of(7, 0, 0);
  for (int i = 0; i < MANY; i++) {
    q[i].p = (vec3){rng_next(&r), rng_next(&r), rng_next(&r)};
    q[i].n = (vec3){0, i % 2 ? 1 : -1, 0};
    q[i].u = (vec3){rng_next(&r), rng_next(&r), rng_next(&r)};
  }
  light_samples_at(&l, q, MANY, all);
  int kinds = 0;
  for (int i = 0; i < MANY; i++) {
    light_sample one;
    bool found = light_sample_at(&l, q[i].p, q[i].n, q[i].u, &one);
    assert_true(found == (all[i].pdf > 0) && one.pdf == all[i].pdf);
    kinds |= !found ? 0 : one.delta ? 1 : one.has_end ? 2 : 4;
    if (!found) continue;
    assert_true(one.has_end == all[i].has_end && one.delta == all[i].delta);
    assert_memory_equal(&one.wi, &all[i].wi, sizeof one.wi);
    assert_memory_equal(&one.radiance, &all[i].radiance, sizeof one.wi);
  }
  assert_int_equal(kinds, 7);
  world_free(w);
}

// A lamp whose picture is dark but for a corner, and half see-through, shines
// as much as the mean over its points.
static void textures_shine(void **state) {
  (void)state;
  world *w = world_new();
  add_ceiling(w, 1, 1);
  static const float red[4 * 4 * 3] = {[0] = 4, [3] = 4, [12] = 4, [15] = 4};
  texture t = {
      .width = 4, .height = 4, .channels = 3, .floats = red, .is_linear = true};
  w->materials[1].map_ke = (texture_map){
      .image = &t, .options = {.scale = {1, 1, 1}, .clamp = true}};
  w->materials[1].passes = true;
  w->materials[1].d = 0.5f;
  vec2 uv[3] = {{0, 0}, {1, 0}, {0, 1}};
  uint32_t corners[3] = {0, 1, 2};
  w->scene.mesh.texcoords = uv;
  w->scene.mesh.texcoord_count = 3;
  w->scene.mesh.texcoord_index = corners;
  world_ready(w, 0);
  light_set l;
  light_set_build(&l, &w->scene, true, true, &w->mem, NULL);
  vec3 p = {0, 0, 0};
  double sum = 0;
  const int fine = 1000;
  for (int i = 0; i < fine * fine; i++) {
    float b = ((float)(i % fine) + 0.5f) / (float)fine;
    float c = ((float)(i / fine) + 0.5f) / (float)fine;
    if (b + c >= 1) continue;
    vec3 q = {4 * b - 2, 2, 4 * c - 2};
    double d2 = (double)vec3_dot(q, q), cosine = 2 / sqrt(d2);
    sum += (double)light_emission(&w->scene, 0, b, c).x * squared(cosine) / d2;
  }
  check_irradiance(w, &l, p, true, sum * 16 / fine / fine);
  world_free(w);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(picks_are_exact),
      cmocka_unit_test(many_samples_are_those_of_one),
      cmocka_unit_test(env_samples_follow_their_density),
      cmocka_unit_test(triangle_samples_follow_their_density),
      cmocka_unit_test(polygons_shine_as_lambert_says),
      cmocka_unit_test(everything_adds_up),
      cmocka_unit_test(picks_follow_their_shares),
      cmocka_unit_test(all_of_many_lights_are_reached),
      cmocka_unit_test(nothing_is_ever_not_finite),
      cmocka_unit_test(many_questions_are_those_of_one),
      cmocka_unit_test(textures_shine),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
