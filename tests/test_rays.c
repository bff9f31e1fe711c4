// test_rays.c — ray sets are what their names say, and files keep them.

#include "bvh.h"
#include "rays.h"
#include "shapes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

// A sphere of radius 1 as a mesh, its tree, and where rays come from.
typedef struct ball {
  arena mem;
  mesh m;
  bvh b;
  ray_source from;
} ball;

static void ball_make(ball *t) {
  *t = (ball){0};
  shape s = shape_sphere(&t->mem, 20);
  t->m = (mesh){.position_count = s.vertices,
                .positions = s.positions,
                .triangle_count = s.triangles,
                .position_index = s.index};
  bvh_build(&t->b, s.positions, s.index, s.triangles, BVH_SAH, &t->mem, NULL);
  t->from = (ray_source){
      .m = &t->m, .tree = bvh_tracer(&t->b), .size = 64, .limit = 6000};
}

// Names and kinds are one to one.
static void names(void **unused) {
  (void)unused;
  for (int k = 0; k < RAYS_KINDS; k++) {
    ray_kind kind = RAYS_KINDS;
    assert_true(rays_kind_of(&kind, rays_kind_name((ray_kind)k)));
    assert_int_equal(kind, k);
  }
  ray_kind kind = RAYS_KINDS;
  assert_false(rays_kind_of(&kind, "Primary"));
  assert_false(rays_kind_of(&kind, ""));
  assert_int_equal(kind, RAYS_KINDS);
}

// Directions have unit length within rounding, tmin is 0, the counts keep to
// the limits, and every kind hits as its geometry says: primary rays fill the
// part of the square that the sphere's disc covers, rays that leave a sphere
// outwards never hit it.
static void kinds(void **unused) {
  (void)unused;
  ball t;
  ball_make(&t);
  size_t hits[RAYS_KINDS], count[RAYS_KINDS];
  for (int k = 0; k < RAYS_KINDS; k++) {
    ray_set s;
    rays_generate(&s, (ray_kind)k, &t.from, &t.mem);
    for (size_t i = 0; i < s.count; i++) {
      vec3 d = s.rays[i].d;
      assert_true(fabsf(vec3_dot(d, d) - 1) < 3e-7f);
      assert_true(s.rays[i].tmin == 0);
      assert_true((k == RAYS_AOD) == (s.rays[i].tmax < INFINITY));
    }
    assert_int_equal(s.any, k == RAYS_AO || k == RAYS_AOD);
    hit *h = ARENA_NEW(&t.mem, hit, s.count);
    rays_trace(h, &s, t.from.tree, NULL, 1);
    hits[k] = rays_count_hits(h, s.count);
    count[k] = s.count;
  }
  assert_int_equal(count[RAYS_PRIMARY], 64 * 64);
  // The eye is at 0.75 sqrt(3) / tan(20 deg) = 3.569 radii; the disc's radius
  // in the square of half side 1 is tan(asin(1 / 3.569)) / tan(20 deg).
  double radius = 1 / sqrt(3.569 * 3.569 - 1) / 0.36397;
  double share = (double)hits[RAYS_PRIMARY] / (double)count[RAYS_PRIMARY];
  assert_true(fabs(share - 3.14159 / 4 * radius * radius) < 0.01);
  assert_int_equal(count[RAYS_RANDOM], 6000);
  assert_true(count[RAYS_AO] <= 6000 + 16 && count[RAYS_AO] > 4000);
  assert_int_equal(count[RAYS_AO], count[RAYS_AOD]);
  assert_int_equal(count[RAYS_BOUNCE], hits[RAYS_PRIMARY]);
  assert_int_equal(hits[RAYS_AO] + hits[RAYS_AOD] + hits[RAYS_BOUNCE], 0);
  assert_true(hits[RAYS_RANDOM] > 3000);
  arena_free(&t.mem);
}

// Secondary rays are distributed as the cosine: the mean of cos is 2/3, that
// of its square 1/2, within 4 standard deviations of 6000 samples.
static void cosine(void **unused) {
  (void)unused;
  ball t;
  ball_make(&t);
  ray_set s;
  rays_generate(&s, RAYS_AO, &t.from, &t.mem);
  double sum = 0, squares = 0;
  for (size_t i = 0; i < s.count; i++) {
    // On a fine sphere the normal is nearly the point itself.
    double c = (double)vec3_dot(vec3_unit(s.rays[i].o), s.rays[i].d);
    sum += c;
    squares += c * c;
  }
  double n = (double)s.count;
  assert_true(fabs(sum / n - 2.0 / 3) < 4 * 0.2357 / sqrt(n));
  assert_true(fabs(squares / n - 0.5) < 4 * 0.2887 / sqrt(n));
  arena_free(&t.mem);
}

// The number of threads changes neither rays nor hits; an empty mesh gives
// empty sets.
static void threads(void **unused) {
  (void)unused;
  ball t;
  ball_make(&t);
  pool *three = pool_new(&t.mem, 3);
  for (int k = 0; k < RAYS_KINDS; k++) {
    ray_set a, b;
    t.from.threads = NULL;
    rays_generate(&a, (ray_kind)k, &t.from, &t.mem);
    t.from.threads = three;
    rays_generate(&b, (ray_kind)k, &t.from, &t.mem);
    assert_int_equal(a.count, b.count);
    assert_memory_equal(a.rays, b.rays, a.count * sizeof(ray));
    hit *ha = ARENA_NEW(&t.mem, hit, a.count);
    hit *hb = ARENA_NEW(&t.mem, hit, a.count);
    rays_trace(ha, &a, t.from.tree, NULL, 0);
    assert_true(rays_trace(hb, &a, brute_tracer(&t.b), three, 2) > 0);
    assert_memory_equal(ha, hb, a.count * sizeof(hit));
  }
  mesh none = {0};
  t.from.m = &none;
  for (int k = 0; k < RAYS_KINDS; k++) {
    ray_set s;
    rays_generate(&s, (ray_kind)k, &t.from, &t.mem);
    assert_int_equal(s.count, 0);
  }
  pool_free(three);
  arena_free(&t.mem);
}

// A name in the folder for temporary files.
static const char *temporary(arena *mem, const char *name) {
  const char *folder = getenv("TMPDIR");
  return arena_format(mem, "%s/facet-%ld-%s", folder ? folder : "/tmp",
                      (long)getpid(), name);
}

static void put_file(const char *path, const void *bytes, size_t n) {
  FILE *f = fopen(path, "wb");
  assert_non_null(f);
  assert_int_equal(fwrite(bytes, 1, n, f), n);
  fclose(f);
}

// A saved set comes back the same, NaN and infinity included, and its bytes
// are the format's.
static void files(void **unused) {
  (void)unused;
  arena mem = {0};
  error err;
  ray rays[2] = {{{1, 2, 3}, {4, 5, -0.0f}, 7, INFINITY},
                 {{NAN, 1e-40f, 0}, {1, 1, 1}, 0, 2}};
  ray_set s = {rays, 2, true}, back;
  const char *path = temporary(&mem, "a.rays");
  assert_true(rays_save(&s, path, &err));
  assert_true(rays_load(&back, path, &mem, &err));
  assert_true(back.any);
  assert_int_equal(back.count, 2);
  assert_memory_equal(back.rays, rays, sizeof rays);
  hit hits[2] = {{.t = 0.5f, .triangle = 258},
                 {.t = INFINITY, .triangle = HIT_NONE}};
  assert_true(rays_save_hits(&s, hits, path, &err));
  unsigned char bytes[40];
  FILE *f = fopen(path, "rb");
  assert_int_equal(fread(bytes, 1, sizeof bytes, f), 32);
  fclose(f);
  const unsigned char expected[32] = {
      'H', 'I', 'T', 'S', 1,    0,    0,    0,    2,    0,   0,
      0,   0,   0,   0,   0,    0,    0,    0,    0x3f, 2,   1,
      0,   0,   0,   0,   0x80, 0x7f, 0xff, 0xff, 0xff, 0xff};
  assert_memory_equal(bytes, expected, 32);
  unlink(path);
  arena_free(&mem);
}

// What is no ray file is refused by name and reason, and nothing is touched:
// none, empty, other letters, a count that the length contradicts.
static void bad_files(void **unused) {
  (void)unused;
  arena mem = {0};
  error err = {{0}};
  const char *path = temporary(&mem, "b.rays");
  unlink(path);
  ray_set s = {.count = 77};
  assert_false(rays_load(&s, path, &mem, &err));
  unsigned char bytes[80] = "RAYS";
  bytes[8] = 2;
  for (size_t n = 0; n < sizeof bytes; n++) {
    put_file(path, bytes, n);
    assert_false(rays_load(&s, path, &mem, &err));
    assert_non_null(strstr(err.text, path));
  }
  put_file(path, bytes, sizeof bytes);
  ray_set whole;
  assert_true(rays_load(&whole, path, &mem, &err));
  assert_int_equal(whole.count, 2);
  bytes[15] = 0xff;
  put_file(path, bytes, sizeof bytes);
  assert_false(rays_load(&s, path, &mem, &err));
  bytes[15] = 0;
  bytes[0] = 'H';
  put_file(path, bytes, sizeof bytes);
  assert_false(rays_load(&s, path, &mem, &err));
  assert_int_equal(s.count, 77);
  unlink(path);
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(names),  cmocka_unit_test(kinds),
      cmocka_unit_test(cosine), cmocka_unit_test(threads),
      cmocka_unit_test(files),  cmocka_unit_test(bad_files),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
