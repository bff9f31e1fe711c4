// geometry.c — rays that leave surfaces, triangles that are none, and rays that
// are none.

#include "../departures.h"

#include "../shapes.h"
#include "bvh_split.h"
#include "stress.h"
#include "wide.h"

#include <string.h>

// All solids of that size, at that distance: rays that stick or leak.
static double depart_all(stress *s, float size, float far, size_t rays) {
  double wrong = 0;
  rng r = rng_of(61, (uint64_t)(size * 1e6f) + s->slice, (uint64_t)far);
  for (int k = 0; k < DEPARTURE_SOLIDS; k++) {
    arena mem = {0};
    solid of = solid_number(k, size, far, &mem);
    departures d = depart(&of, (long)rays / 6, &r);
    wrong += (double)(d.self_hits + d.leaks);
    arena_free(&mem);
  }
  return wrong;
}

static void leave(stress *s) {
  size_t rays = stress_count(s, 6e3, 1.2e5, 1.2e6);
  double wrong = 0, tried = 0;
  for (int e = -6; e <= 6; e++) {
    wrong += depart_all(s, (float)pow(10, e), 0, rays);
    tried += (double)rays;
  }
  stress_print(s, (stress_row){"rays leave where they hit: sizes 1e-6 to 1e6",
                               tried, wrong, NO_LIMIT, NO_LIMIT,
                               "tmin 1e-3: half of them fail"});
  wrong = tried = 0;
  for (int e = 1; e <= 4; e++) {
    wrong += depart_all(s, (float)pow(10, e), 1e6f, 3 * rays);
    tried += 3 * (double)rays;
  }
  stress_print(s, (stress_row){"the same, sizes 10 to 1e4 at a distance of 1e6",
                               tried, wrong, NO_LIMIT, NO_LIMIT, "none"});
}

// Slivers as a face: a normal good to float precision, and a ray that hits and
// leaves.
static void slivers(stress *s) {
  size_t n = stress_count(s, 1e4, 1e6, 1e7);
  rng r = rng_of(62, s->slice, 0);
  double wrong = 0, worst = 0;
  for (size_t i = 0; i < n; i++) {
    vec3 along = random_direction(&r), across = random_direction(&r);
    vec3 o = random_vector(&r);
    vec3 p[3] = {o, vec3_add(o, along),
                 vec3_mad(vec3_mad(o, rng_next(&r), along), 1e-7f, across)};
    uint32_t index[3] = {0, 1, 2};
    solid of = {.p = p, .index = index, .vertices = 3, .triangles = 1};
    scene w = solid_scene(&of, false);
    hit h = random_hit(&r, 1);
    surface at = surface_at(&w, &h, across);
    wrong += !vec3_finite(at.p) || !vec3_finite(at.ng);
    double off = normal_error(p, at.ng);
    worst = fmax(worst, fmax(off, (double)fabsf(vec3_length(at.ng) - 1)));
  }
  stress_print(s,
               (stress_row){"normals of slivers, aspect 1e7: error in radians",
                            (double)n, wrong, worst, 2e-7,
                            "noise (cross product in float)"});
}

// The answers of one way to ask, as bytes that can be compared.
typedef struct answer {
  hit h;
  bool found;
} answer;

static answer ask(const tracer *t, const ray *r) {
  answer a;
  memset(&a, 0, sizeof a);
  a.h = (hit){.t = r->tmax, .triangle = HIT_NONE};
  a.found = t->closest(t->tree, r, &a.h);
  return a;
}

// Every tree over a mesh, the list first.
enum { TREES = 6 };
typedef struct trees {
  bvh b[4];
  wide_tree wide;
  tracer t[TREES];
} trees;

static void plant(trees *g, const shape *s, arena *mem, pool *threads) {
  const bvh_method how[3] = {BVH_SAH, BVH_MEDIAN, BVH_COARSE};
  for (int i = 0; i < 3; i++)
    bvh_build(&g->b[i], s->positions, s->index, s->triangles, how[i], mem,
              threads);
  bvh_split_build(&g->b[3], &g->b[2], 1e9, mem, threads);
  wide_tree_build(&g->wide, &g->b[3], mem, threads);
  g->t[0] = brute_tracer(&g->b[0]);
  for (int i = 0; i < 4; i++)
    g->t[1 + i] = bvh_tracer(&g->b[i]);
  g->t[5] = wide_tracer(&g->wide);
}

// Whether all trees say of r what the list says, and say nothing absurd.
static bool agree(const trees *g, const ray *r) {
  answer first = ask(&g->t[0], r);
  bool good = !first.found || (isfinite(first.h.t) && isfinite(first.h.b1) &&
                               isfinite(first.h.b2) && first.h.t >= r->tmin &&
                               first.h.t <= r->tmax);
  for (int i = 0; i < TREES; i++) {
    answer a = ask(&g->t[i], r);
    good = good && memcmp(&a, &first, sizeof a) == 0;
    good = good && g->t[i].any(g->t[i].tree, r) == first.found;
  }
  return good;
}

// Each triangle four times, among points, lines, and corners that are no
// numbers: the lowest number wins in every tree.
static shape rubble(arena *mem) {
  enum { SOUND = 40 };
  shape s = shape_new(mem, "rubble", 3 * 8 * SOUND, 8 * SOUND);
  uint64_t state = 5;
  const float odd[4] = {NAN, INFINITY, -INFINITY, 3e38f};
  for (uint32_t i = 0; i < SOUND; i++) {
    vec3 p = shape_point(&state), q = shape_point(&state);
    vec3 c = shape_point(&state);
    for (int k = 0; k < 4; k++)
      shape_three(&s, p, q, c);
    shape_three(&s, p, p, p);
    shape_three(&s, p, q, p);
    shape_three(&s, p, vec3_lerp(p, p, 0.5f), q);
    shape_three(&s, p, q, (vec3){c.x, odd[i % 4], c.z});
  }
  return s;
}

static void coincide(stress *s) {
  arena mem = {0};
  shape of = rubble(&mem);
  trees g;
  plant(&g, &of, &mem, s->threads);
  size_t n = stress_count(s, 5e3, 2e5, 2e6);
  rng r = rng_of(63, s->slice, 0);
  double wrong = 0;
  for (size_t i = 0; i < n; i++) {
    vec3 o = vec3_scale(random_vector(&r), 2);
    ray q = ray_from(o, vec3_sub(random_vector(&r), o));
    answer a = ask(&g.t[5], &q);
    wrong += !agree(&g, &q);
    // Of the four copies the first, and never what has no area.
    wrong += a.found && a.h.triangle % 8 != 0 && a.h.triangle % 8 != 7;
  }
  stress_print(s, (stress_row){"coincident, degenerate, infinite triangles: "
                               "5 trees = list",
                               (double)n, wrong, NO_LIMIT, NO_LIMIT, "none"});
  arena_free(&mem);
}

// Rays with -0, denormals, infinities and NaN anywhere.
static void odd_rays(stress *s) {
  static const float odd[] = {
      0,       -0.0f,    1,        -1,        0.3f, 1e-45f, -1e-40f, FLT_MIN,
      3.4e38f, -3.4e38f, INFINITY, -INFINITY, NAN,  1e-20f, -0.7f,   0.5f};
  enum { ODD = sizeof odd / sizeof *odd };
  arena mem = {0};
  shape of = shape_sphere(&mem, 3);
  trees g;
  plant(&g, &of, &mem, s->threads);
  size_t n = stress_count(s, 2e4, 1e6, 1e7);
  rng r = rng_of(64, s->slice, 0);
  double wrong = 0;
  for (size_t i = 0; i < n; i++) {
    float v[8];
    for (int k = 0; k < 8; k++)
      v[k] = odd[(int)(rng_next(&r) * ODD) % ODD];
    ray q = {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, 0, INFINITY};
    if (i % 4 == 0) q.tmin = v[6];
    if (i % 4 == 0) q.tmax = v[7];
    wrong += !agree(&g, &q);
    // -0 is 0.
    ray p = q;
    float *x[6] = {&p.o.x, &p.o.y, &p.o.z, &p.d.x, &p.d.y, &p.d.z};
    for (int k = 0; k < 6; k++)
      if (*x[k] == 0) *x[k] = 0;
    wrong += ask(&g.t[5], &p).h.triangle != ask(&g.t[5], &q).h.triangle;
  }
  stress_print(
      s, (stress_row){"rays of -0, denormal, infinite, NaN: 5 trees = list",
                      (double)n, wrong, NO_LIMIT, NO_LIMIT, "none"});
  arena_free(&mem);
}

void stress_geometry(stress *s) {
  leave(s);
  slivers(s);
  coincide(s);
  odd_rays(s);
}
