// test_surface_normal.c — shading normals: interpolated, bent, bumped, and
// what light makes of them.

#include "num.h"
#include "rng.h"
#include "solids.h"
#include "surface.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

static long fewer(long n) {
  return getenv("FACET_QUICK") != NULL ? n / 50 : n;
}

// Uniform over the sphere: num_circle times a uniform height.
static vec3 sphere_point(rng *r) {
  float z = 2 * rng_next(r) - 1, rho = sqrtf(fmaxf(0, 1 - z * z));
  vec2 c = num_circle(rng_next(r));
  return (vec3){rho * c.x, rho * c.y, z};
}

// Uniform over the hemisphere around n, and cosine-weighted.
static vec3 hemisphere_point(vec3 n, rng *r) {
  vec3 v = sphere_point(r);
  return vec3_dot(v, n) < 0 ? vec3_neg(v) : v;
}

static vec3 cosine_point(vec3 n, rng *r) {
  return vec3_unit(vec3_add(n, vec3_scale(sphere_point(r), 0.99999f)));
}

static hit hit_somewhere(rng *r, size_t triangles) {
  float root = sqrtf(rng_next(r)), b = rng_next(r);
  uint32_t t = (uint32_t)(rng_next(r) * (float)triangles);
  return (hit){.t = 1, .b1 = root * (1 - b), .b2 = root * b, .triangle = t};
}

static vec3 mirrored(vec3 wo, vec3 n) {
  return vec3_sub(vec3_scale(n, 2 * vec3_dot(wo, n)), wo);
}

// Of the pixels of an icosphere seen from afar, the share in percent whose
// mirror direction about a normal lies below the facet.
static double below_facet(int level, bool bent) {
  arena mem = {0};
  solid s = solid_icosphere(&mem, level);
  scene w = solid_scene(&s, true);
  bvh tree = solid_tree(&s, &mem);
  long seen = 0, below = 0;
  const int side = getenv("FACET_QUICK") != NULL ? 250 : 500;
  for (int i = 0; i < side * side; i++) {
    float x = ((float)(i % side) + 0.5f) / (float)side;
    float y = ((float)(i / side) + 0.5f) / (float)side;
    ray r = ray_from((vec3){2 * x - 1, 2 * y - 1, 5}, (vec3){0, 0, -1});
    hit h;
    if (!bvh_closest(&tree, &r, &h)) continue;
    surface at = surface_at(&w, &h, r.d);
    vec3 wo = {0, 0, 1};
    vec3 n = bent ? surface_bend(at.ns, at.ng, wo) : at.ns;
    seen++;
    below += vec3_dot(mirrored(wo, n), at.ng) <= 0;
  }
  arena_free(&mem);
  return 100 * (double)below / (double)seen;
}

// Mirror directions fall below the facet on 3.2, 0.84 and 0.21 % of an
// icosphere of level 1, 2 and 3, and on none once the normal is bent.
static void bent_mirrors_stay_above(void **state) {
  (void)state;
  const double share[3] = {3.2, 0.84, 0.21};
  for (int level = 1; level <= 3; level++) {
    double expected = share[level - 1];
    assert_true(fabs(below_facet(level, false) - expected) < 0.3 * expected);
    assert_true(below_facet(level, true) == 0);
  }
}

// A bent normal is the same where nothing was wrong, faces wo, lies between
// ns and ng, and goes no farther than to the clearance.
static void bending_is_minimal(void **state) {
  (void)state;
  rng r = rng_of(8, 10, 0);
  for (long i = 0; i < fewer(1000000); i++) {
    vec3 ng = sphere_point(&r);
    vec3 ns = surface_lean(hemisphere_point(ng, &r), ng);
    vec3 wo = hemisphere_point(ng, &r);
    if (i % 4 == 0)  // grazing
      wo = vec3_unit(vec3_mad(wo, -0.9999f * vec3_dot(wo, ng), ng));
    float b = vec3_dot(wo, ng), clear = fminf(0.5f * b, 0.01f);
    if (!(b > 1e-5f)) continue;
    vec3 n = surface_bend(ns, ng, wo);
    float before = vec3_dot(mirrored(wo, ns), ng);
    float after = vec3_dot(mirrored(wo, n), ng);
    assert_true(vec3_dot(n, wo) > 0 && vec3_dot(n, ng) > 0);
    assert_true(after > 0);
    if (before > clear + 1e-6f)
      assert_true(vec3_dot(vec3_sub(n, ns), vec3_sub(n, ns)) == 0);
    else
      assert_true(fabsf(after - clear) < 3e-6f);
    vec3 plane = vec3_unit(vec3_cross(ns, ng));
    assert_true(fabsf(vec3_dot(n, plane)) < 1e-4f);
    assert_true(vec3_dot(n, ng) > vec3_dot(ns, ng) - 1e-6f);
  }
}

// About the bent normal of glass the reflection stays on wo's side of the
// facet and the refraction, where there is one, crosses it; from outside and
// from inside.
static void glass_is_consistent(void **state) {
  (void)state;
  rng r = rng_of(8, 11, 0);
  long plain_fails = 0;
  for (long i = 0; i < fewer(1000000); i++) {
    vec3 ng = sphere_point(&r), lean = vec3_scale(sphere_point(&r), 0.5f);
    vec3 ns = surface_lean(vec3_add(ng, lean), ng);
    vec3 wo = hemisphere_point(ng, &r);
    float eta = i % 2 == 0 ? 1.5f : 1 / 1.5f;
    if (!(vec3_dot(wo, ng) > 1e-4f)) continue;
    for (int bent = 0; bent < 2; bent++) {
      vec3 n = bent ? surface_bend_glass(ns, ng, wo, eta) : ns;
      float cos_i = vec3_dot(wo, n);
      float square = 1 - (1 - cos_i * cos_i) / (eta * eta);
      bool good = cos_i > 0 && vec3_dot(mirrored(wo, n), ng) > 0;
      if (square > 0) {
        float along = cos_i / eta - sqrtf(square);
        vec3 wt = vec3_mad(vec3_scale(n, along), -1 / eta, wo);
        good = good && vec3_dot(wt, ng) < 1e-6f;
      }
      if (!bent) plain_fails += !good;
      if (bent) assert_true(good);
    }
  }
  assert_true(plain_fails > fewer(1000000) / 20);
}

// surface_face turns only what faces away, and no farther than needed.
static void faced_normals_face(void **state) {
  (void)state;
  rng r = rng_of(8, 12, 0);
  for (long i = 0; i < fewer(1000000); i++) {
    vec3 ns = sphere_point(&r), wo = sphere_point(&r);
    vec3 n = surface_face(ns, wo);
    float c = vec3_dot(ns, wo), moved = vec3_length(vec3_sub(n, ns));
    assert_true(vec3_dot(n, wo) > 0 && fabsf(vec3_length(n) - 1) < 1e-6f);
    assert_true(c > 0 ? moved == 0 : moved < 1.5f * -c + 2e-3f);
  }
  vec3 z = {0, 0, 1};
  assert_true(vec3_dot(surface_face(vec3_neg(z), z), z) > 0);
}

// How an icosphere of level 2 is lit by a directional light, against the
// sphere that it stands for.
typedef struct terminator {
  double rms;    // of the cosine, shadow included
  double black;  // share of the lit points that get nothing, in percent
} terminator;

typedef enum ball { BALL_FACETS, BALL_SMOOTH, BALL_LIFTED } ball;

static float ball_lit(const scene *w, const bvh *tree, const hit *h, vec3 l,
                      ball kind) {
  surface at = surface_at(w, h, vec3_neg(w->mesh.normals[0]));
  vec3 from = {5 * at.ng.x, 5 * at.ng.y, 5 * at.ng.z};
  at = surface_at(w, h, vec3_sub(at.p, from));
  float cosine = vec3_dot(kind == BALL_FACETS ? at.ng : at.ns, l);
  if (!(cosine > 0)) return 0;
  if (kind != BALL_LIFTED && vec3_dot(at.ng, l) <= 0) return 0;
  ray r =
      kind == BALL_LIFTED ? surface_smooth_ray(&at, l) : surface_ray(&at, l);
  return bvh_any(tree, &r) ? 0 : cosine;
}

static terminator terminator_of(ball kind) {
  arena mem = {0};
  solid s = solid_icosphere(&mem, 2);
  scene w = solid_scene(&s, true);
  bvh tree = solid_tree(&s, &mem);
  rng r = rng_of(8, 13, 0);
  double sum = 0;
  long black = 0, n = fewer(400000);
  for (long i = 0; i < n; i++) {
    hit h = hit_somewhere(&r, s.triangles);
    vec3 l = sphere_point(&r);
    float got = ball_lit(&w, &tree, &h, l, kind);
    surface at = surface_at(&w, &h, l);
    float truth = fmaxf(vec3_dot(vec3_unit(at.p), l), 0);
    sum += (double)((got - truth) * (got - truth));
    black += got == 0 && truth > 1e-5f;
  }
  arena_free(&mem);
  return (terminator){sqrt(sum / (double)n), 100 * (double)black / (double)n};
}

// Against the true sphere, facets are off by .036 rms and plain smooth
// normals leave 1.3 % wrongly black; from the lifted point no point is black
// and the light is that of the sphere.
static void terminator_follows_the_sphere(void **state) {
  (void)state;
  terminator facets = terminator_of(BALL_FACETS);
  terminator plain = terminator_of(BALL_SMOOTH);
  terminator lifted = terminator_of(BALL_LIFTED);
  assert_true(fabs(facets.rms - 0.0357) < 0.003);
  assert_true(fabs(plain.black - 1.3) < 0.3);
  assert_true(plain.rms > 0.004);
  assert_true(lifted.rms < 1e-5);
  assert_true(lifted.black == 0);
}

// The lifted point is never inside the sphere, and no farther above it than
// the facet is below; from inside, where the surface is hollow, it is the
// point itself.
static void lifted_points_clear_the_sphere(void **state) {
  (void)state;
  arena mem = {0};
  solid s = solid_icosphere(&mem, 2);
  scene w = solid_scene(&s, true);
  rng r = rng_of(8, 14, 0);
  for (long i = 0; i < fewer(100000); i++) {
    hit h = hit_somewhere(&r, s.triangles);
    surface at = surface_at(&w, &h, vec3_neg(s.p[s.index[3 * h.triangle]]));
    assert_true(at.front);
    float below = 1 - vec3_length(at.p), above = vec3_length(at.p_smooth) - 1;
    assert_true(above > -1e-6f && above < 1.05f * below + 1e-6f);
    at = surface_at(&w, &h, s.p[s.index[3 * h.triangle]]);
    assert_false(at.front);
    assert_true(vec3_length(vec3_sub(at.p_smooth, at.p)) < 1e-7f);
  }
  arena_free(&mem);
}

// On a saddle only the corners whose tangent planes rise above p lift it: here
// corner 0, by b0 times its height along its normal, and no other.
static void saddles_lift_by_their_ridges(void **state) {
  (void)state;
  vec3 p[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  vec3 n[3] = {
      vec3_unit((vec3){-1, 0, 2}), vec3_unit((vec3){-1, 0, 2}), {0, 0, 1}};
  uint32_t index[3] = {0, 1, 2};
  solid s = {.p = p, .n = n, .index = index, .vertices = 3, .triangles = 1};
  scene w = solid_scene(&s, true);
  hit h = {.t = 1, .b1 = 0.5f, .b2 = 0.25f};
  surface at = surface_at(&w, &h, (vec3){0, 0, -1});
  float rise = 0.5f / sqrtf(5);
  vec3 want = vec3_mad(at.p, 0.25f * rise, n[0]);
  assert_true(vec3_length(vec3_sub(at.p_smooth, want)) < 2e-7f);
  at = surface_at(&w, &h, (vec3){0, 0, 1});
  want = vec3_mad(at.p, -0.5f * rise, n[1]);
  assert_true(vec3_length(vec3_sub(at.p_smooth, want)) < 2e-7f);
}

// What a path of perfectly white Lambert bounces does on a smooth cube; false
// when it is still there after 1000.
static bool walk_escapes(const scene *w, const bvh *tree, ray q, rng *r,
                         int *bounces) {
  hit h;
  for (*bounces = 0; *bounces < 1000; ++*bounces) {
    if (!bvh_closest(tree, &q, &h)) return true;
    surface at = surface_at(w, &h, q.d);
    vec3 ns = at.front ? at.ns : vec3_neg(at.ns);
    ns = surface_face(ns, vec3_unit(vec3_neg(q.d)));
    q = surface_smooth_ray(&at, cosine_point(ns, r));
  }
  return false;
}

// In a white furnace a smooth-shaded convex body loses nothing, however much
// its normals lean: at albedo .8 it reflects .8 within 1e-3, although most
// directions near an edge of the cube lie below the facet.
static void smooth_bodies_lose_nothing(void **state) {
  (void)state;
  for (int body = 0; body < 2; body++) {
    arena mem = {0};
    solid s = body == 0 ? solid_cube(&mem) : solid_icosphere(&mem, 1);
    scene w = solid_scene(&s, true);
    bvh tree = solid_tree(&s, &mem);
    rng r = rng_of(8, 15, (uint64_t)body);
    double reflected = 0;
    long hits = 0;
    for (long i = 0; i < fewer(400000); i++) {
      vec3 aim = vec3_scale(sphere_point(&r), 0.9f), d = sphere_point(&r);
      int bounces;
      ray q = ray_from(vec3_mad(aim, -9, d), d);
      assert_true(walk_escapes(&w, &tree, q, &r, &bounces));
      if (bounces == 0) continue;
      hits++;
      double left = 1;
      for (int k = 0; k < bounces; k++)
        left *= 0.8;
      reflected += left;
    }
    assert_true(fabs(reflected / (double)hits - 0.8) < 1e-3 * 0.8);
    arena_free(&mem);
  }
}

// ns is unit and on ng's side whatever the file's normals are: missing, of
// any length, zero, NaN, turned round or leaning beyond the horizon.
static void bad_normals_are_mended(void **state) {
  (void)state;
  arena mem = {0};
  solid s = solid_tetrahedron(&mem);
  vec3 n[4] = {{0, 0, 0}, {NAN, 1, 0}, {1e-30f, 1e-30f, 0}, {-1e30f, 2, 1e30f}};
  uint32_t index[12];
  rng r = rng_of(8, 16, 0);
  for (long i = 0; i < fewer(100000); i++) {
    scene w = solid_scene(&s, true);
    w.mesh.normals = n;
    w.mesh.normal_index = index;
    if (i % 2 == 0) n[i / 2 % 4] = sphere_point(&r);
    for (int k = 0; k < 12; k++) {
      uint32_t pick = (uint32_t)(5 * rng_next(&r));
      index[k] = pick == 4 ? MESH_NONE : pick;
    }
    hit h = hit_somewhere(&r, 4);
    surface at = surface_at(&w, &h, sphere_point(&r));
    assert_true(fabsf(vec3_length(at.ns) - 1) < 1e-6f);
    assert_true(vec3_dot(at.ns, at.ng) > 0.009f);
    assert_true(vec3_finite(at.p_smooth));
  }
  arena_free(&mem);
}

// A mesh whose normals all point inwards shades as if they pointed outwards:
// the winding decides.
static void winding_decides_the_side(void **state) {
  (void)state;
  arena mem = {0};
  solid s = solid_icosphere(&mem, 1);
  scene w = solid_scene(&s, true);
  rng r = rng_of(8, 17, 0);
  for (long i = 0; i < fewer(20000); i++) {
    hit h = hit_somewhere(&r, s.triangles);
    vec3 d = sphere_point(&r);
    surface out = surface_at(&w, &h, d);
    for (uint32_t k = 0; k < s.vertices; k++)
      s.n[k] = vec3_neg(s.n[k]);
    surface in = surface_at(&w, &h, d);
    assert_true(vec3_length(vec3_sub(out.ns, in.ns)) < 1e-6f);
    assert_true(vec3_length(vec3_sub(out.p_smooth, in.p_smooth)) < 1e-6f);
  }
  arena_free(&mem);
}

// A parallelogram over the whole texture square: corner, u side, v side.
typedef struct sheet {
  vec3 p[4], n[1];
  vec2 uv[4];
  uint32_t index[6], material_of[2];
  material material;
  scene scene;
} sheet;

static void sheet_set(sheet *s, vec3 corner, vec3 u, vec3 v) {
  static const uint32_t index[6] = {0, 1, 3, 0, 3, 2};
  *s = (sheet){.uv = {{0, 0}, {1, 0}, {0, 1}, {1, 1}}};
  for (int k = 0; k < 4; k++) {
    s->p[k] = vec3_mad(corner, (float)(k % 2), u);
    s->p[k] = vec3_mad(s->p[k], (float)(k / 2), v);
  }
  for (int k = 0; k < 6; k++)
    s->index[k] = index[k];
  solid all = {.p = s->p, .index = s->index, .vertices = 4, .triangles = 2};
  s->scene = solid_scene(&all, false);
  s->scene.mesh.texcoords = s->uv;
  s->scene.mesh.texcoord_count = 4;
  s->scene.mesh.texcoord_index = s->index;
  s->scene.materials = &s->material;
  s->scene.material_of = s->material_of;
  s->scene.material_count = 1;
}

// A hit well inside the texture, and the mapped normal there.
static vec3 sheet_normal(sheet *s, rng *r) {
  hit h = hit_somewhere(r, 2);
  float b0 = 1 - h.b1 - h.b2;
  h.b1 = 0.8f * h.b1 + 0.2f / 3;
  h.b2 = 0.8f * h.b2 + 0.2f / 3;
  assert_true(b0 > -1e-6f);
  surface at = surface_at(&s->scene, &h, vec3_neg(sphere_point(r)));
  return surface_mapped_normal(&s->scene, &at, &h);
}

// A height that rises by `rise` along u and `climb` along v over the picture
// gives the normal of the tilted plane, on a parallelogram of any shape and
// with u and v exchanged; the height is in world units, times -bm.
static void bumps_tilt_the_normal(void **state) {
  (void)state;
  enum { SIZE = 16 };
  float height[SIZE * SIZE];
  const float rise = 0.3f, climb = -0.2f, bm = 2;
  for (int y = 0; y < SIZE; y++)
    for (int x = 0; x < SIZE; x++)
      height[y * SIZE + x] = 0.5f + rise * ((float)x + 0.5f) / SIZE +
                             climb * (SIZE - 0.5f - (float)y) / SIZE;
  texture map = {.width = SIZE,
                 .height = SIZE,
                 .channels = 1,
                 .floats = height,
                 .is_linear = true};
  rng r = rng_of(8, 18, 0);
  for (long i = 0; i < fewer(20000); i++) {
    vec3 u = vec3_scale(sphere_point(&r), 3), v = sphere_point(&r);
    vec3 ng = vec3_cross(u, v);
    if (vec3_length(ng) < 1) continue;
    sheet s;
    sheet_set(&s, sphere_point(&r), u, v);
    s.material.map_bump = (texture_map){
        .image = &map, .options = {.scale = {1, 1, 1}, .bump = bm}};
    vec3 up = vec3_unit(ng);
    vec3 tilted =
        vec3_cross(vec3_mad(u, bm * rise, up), vec3_mad(v, bm * climb, up));
    vec3 got = sheet_normal(&s, &r);
    assert_true(vec3_length(vec3_sub(got, vec3_unit(tilted))) < 2e-4f);
    sheet_set(&s, sphere_point(&r), v, u);  // turned over: ng is -up
    s.material.map_bump = (texture_map){
        .image = &map, .options = {.scale = {1, 1, 1}, .bump = bm}};
    up = vec3_neg(up);
    tilted =
        vec3_cross(vec3_mad(v, bm * rise, up), vec3_mad(u, bm * climb, up));
    got = sheet_normal(&s, &r);
    assert_true(vec3_length(vec3_sub(got, vec3_unit(tilted))) < 2e-4f);
  }
}

// A normal map that says (0, 0, 1) changes nothing; red leans along +u, green
// along +v, also where u is mirrored; a frameless triangle is left alone.
static void normal_maps_lean_along_uv(void **state) {
  (void)state;
  rng r = rng_of(8, 19, 0);
  for (long i = 0; i < fewer(20000); i++) {
    vec3 u = sphere_point(&r), v = sphere_point(&r);
    v = vec3_unit(vec3_mad(v, -vec3_dot(u, v), u));
    sheet s;
    sheet_set(&s, sphere_point(&r), u, v);
    vec3 up = vec3_unit(vec3_cross(u, v)), lean = {0.6f, 0, 0.8f};
    if (i % 3 == 0) lean = (vec3){0, 0.6f, 0.8f};
    if (i % 3 == 1) lean = (vec3){0, 0, 1};
    vec3 stored = vec3_mad(vec3_all(0.5f), 0.5f, lean);
    float texel[3] = {stored.x, stored.y, stored.z};
    texture map = {.width = 1,
                   .height = 1,
                   .channels = 3,
                   .floats = texel,
                   .is_linear = true};
    s.material.map_norm =
        (texture_map){.image = &map, .options = {.scale = {1, 1, 1}}};
    vec3 want = vec3_scale(u, lean.x);
    want = vec3_mad(vec3_mad(want, lean.y, v), lean.z, up);
    vec3 got = sheet_normal(&s, &r);
    assert_true(vec3_length(vec3_sub(got, want)) < 1e-5f);
    for (int k = 0; k < 4; k++)
      s.uv[k].x = 1 - s.uv[k].x;  // mirrored
    want = vec3_mad(want, -2 * lean.x, u);
    got = sheet_normal(&s, &r);
    assert_true(vec3_length(vec3_sub(got, want)) < 1e-5f);
    for (int k = 0; k < 4; k++)
      s.uv[k] = (vec2){0.5f, 0.5f};
    got = sheet_normal(&s, &r);
    assert_true(vec3_length(vec3_sub(got, up)) < 1e-5f);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bent_mirrors_stay_above),
      cmocka_unit_test(bending_is_minimal),
      cmocka_unit_test(glass_is_consistent),
      cmocka_unit_test(faced_normals_face),
      cmocka_unit_test(terminator_follows_the_sphere),
      cmocka_unit_test(lifted_points_clear_the_sphere),
      cmocka_unit_test(saddles_lift_by_their_ridges),
      cmocka_unit_test(smooth_bodies_lose_nothing),
      cmocka_unit_test(bad_normals_are_mended),
      cmocka_unit_test(winding_decides_the_side),
      cmocka_unit_test(bumps_tilt_the_normal),
      cmocka_unit_test(normal_maps_lean_along_uv),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
