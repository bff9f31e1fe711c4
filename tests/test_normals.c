// test_normals.c — generated normals: exact on shapes with known answers.

#include "normals.h"
#include "obj.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// A cube of side 2 around the origin, in quads; the text before the faces is
// left out.
#define CUBE_VERTICES \
  "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\n" \
  "v 1 1 1\nv -1 1 1\n"
#define CUBE_FACES \
  "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"

static mesh read_text(const char *text, arena *mem) {
  mesh m;
  error err;
  obj_request q = {.path = "text.obj", .text = {text, strlen(text)}};
  if (!obj_read_request(&m, &q, mem, NULL, &err)) fail_msg("%s", err.text);
  return m;
}

// The normal of a corner; it must have one.
static vec3 normal_at(const mesh *m, size_t corner) {
  assert_non_null(m->normal_index);
  assert_true(m->normal_index[corner] < m->normal_count);
  return m->normals[m->normal_index[corner]];
}

static bool is_near(vec3 a, vec3 b) {
  return vec3_length(vec3_sub(a, b)) < 1e-6f;
}

// Smoothing a whole cube points every normal along its diagonal, although its
// quads are cut into triangles one way only: the angle is what weighs.
static void cube_normals_are_diagonals(void **state) {
  (void)state;
  static const char *const GROUPS[] = {"", "s 1\n"};
  for (int i = 0; i < 2; i++) {
    arena mem = {0};
    char text[512];
    snprintf(text, sizeof text, "%s%s%s", CUBE_VERTICES, GROUPS[i], CUBE_FACES);
    mesh m = read_text(text, &mem);
    normals_generate(&m, i == 0 ? NORMALS_SMOOTH : NORMALS_AUTO, 180, &mem,
                     NULL);
    assert_int_equal(m.normal_count, 8);
    for (size_t c = 0; c < 36; c++) {
      vec3 p = m.positions[m.position_index[c]];
      assert_true(is_near(normal_at(&m, c), vec3_unit(p)));
    }
    arena_free(&mem);
  }
}

// A crease angle below 90 degrees keeps the cube's faces apart, one above
// does not; s off, no s and the flat modes give no normals at all.
static void creases_and_flat_faces(void **state) {
  (void)state;
  arena mem = {0};
  mesh m = read_text(CUBE_VERTICES "s 2\n" CUBE_FACES, &mem);
  normals_generate(&m, NORMALS_AUTO, 89, &mem, NULL);
  for (size_t c = 0; c < 36; c++) {
    vec3 n = normal_at(&m, c);
    assert_true(fabsf(fabsf(n.x) + fabsf(n.y) + fabsf(n.z) - 1) < 1e-6f);
  }
  normals_generate(&m, NORMALS_SMOOTH, 91, &mem, NULL);
  for (size_t c = 0; c < 36; c++)
    assert_true(
        is_near(normal_at(&m, c), vec3_unit(m.positions[m.position_index[c]])));
  normals_generate(&m, NORMALS_FLAT, 180, &mem, NULL);
  assert_null(m.normal_index);
  normals_generate(&m, NORMALS_FILE, 180, &mem, NULL);
  assert_null(m.normal_index);
  m = read_text(CUBE_VERTICES "s off\n" CUBE_FACES, &mem);
  normals_generate(&m, NORMALS_AUTO, 180, &mem, NULL);
  assert_null(m.normal_index);
  m = read_text(CUBE_VERTICES CUBE_FACES, &mem);
  normals_generate(&m, NORMALS_AUTO, 180, &mem, NULL);
  assert_null(m.normal_index);
  arena_free(&mem);
}

// Groups meet at a hard edge: a roof of two slopes in groups 1 and 2 keeps
// both normals, in one group it has the mean at the ridge.
static void groups_meet_at_hard_edges(void **state) {
  (void)state;
  static const char ROOF[] = "v -1 0 0\nv 0 1 0\nv 0 1 1\nv -1 0 1\nv 1 0 0\n"
                             "v 1 0 1\ns 1\nf 4 3 2 1\ns %d\nf 3 6 5 2\n";
  const float h = 0.70710678f;
  for (int group = 1; group <= 2; group++) {
    arena mem = {0};
    char text[256];
    snprintf(text, sizeof text, ROOF, group);
    mesh m = read_text(text, &mem);
    normals_generate(&m, NORMALS_AUTO, 180, &mem, NULL);
    for (size_t c = 0; c < 12; c++) {
      float side = c < 6 ? -h : h;
      bool ridge = m.positions[m.position_index[c]].y == 1;
      vec3 wanted = {side, h, 0};
      if (ridge && group == 1) wanted = (vec3){0, 1, 0};
      assert_true(is_near(normal_at(&m, c), wanted));
    }
    arena_free(&mem);
  }
}

// Faces of a group belong together also when those of another lie between
// them in the file: a pyramid whose sides are in groups 1, 2, 1, 2.
static void groups_may_alternate(void **state) {
  (void)state;
  arena mem = {0};
  mesh m = read_text("v 0 1 0\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nv -1 0 1\n"
                     "s 1\nf 1 2 3\ns 2\nf 1 3 4\ns 1\nf 1 4 5\ns 2\nf 1 5 2\n",
                     &mem);
  normals_generate(&m, NORMALS_AUTO, 180, &mem, NULL);
  for (size_t t = 0; t < 4; t++)
    assert_true(is_near(normal_at(&m, 3 * t), (vec3){0, 1, 0}));
  assert_int_equal(m.normal_index[0], m.normal_index[6]);
  assert_int_equal(m.normal_index[3], m.normal_index[9]);
  arena_free(&mem);
}

// Normals of the file stay, faces without get theirs by group, and a normal
// without direction counts as none.
static void file_normals_stay(void **state) {
  (void)state;
  arena mem = {0};
  mesh m = read_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 1 0 0\nvn 0 0 0\n"
                     "s 1\nf 1//1 2//1 3//2\nf 1 3 4\ns 0\nf 1 2 4\n",
                     &mem);
  normals_generate(&m, NORMALS_AUTO, 180, &mem, NULL);
  assert_true(is_near(normal_at(&m, 0), (vec3){1, 0, 0}));
  assert_true(is_near(normal_at(&m, 1), (vec3){1, 0, 0}));
  assert_true(is_near(normal_at(&m, 2), (vec3){0, 0, 1}));
  for (size_t c = 3; c < 6; c++)
    assert_true(is_near(normal_at(&m, c), (vec3){0, 0, 1}));
  for (size_t c = 6; c < 9; c++)
    assert_int_equal(m.normal_index[c], MESH_NONE);
  arena_free(&mem);
}

// A sphere of latitudes and longitudes, whose faces have very different
// angles, gets normals along its radii: within half a degree, where plain
// averages are off by more.
static void sphere_normals_are_radii(void **state) {
  (void)state;
  enum { AROUND = 24, DOWN = 17 };
  static char text[200000];
  size_t n = 0;
  for (int j = 0; j <= DOWN; j++)
    for (int i = 0; i < AROUND; i++) {
      double v = 3.141592653589793 * j / DOWN;
      double u = 6.283185307179586 * i / AROUND;
      n += (size_t)snprintf(text + n, sizeof text - n, "v %.9f %.9f %.9f\n",
                            sin(v) * cos(u), cos(v), sin(v) * sin(u));
    }
  n += (size_t)snprintf(text + n, sizeof text - n, "s 1\n");
  for (int j = 0; j < DOWN; j++)
    for (int i = 0; i < AROUND; i++) {
      int a = j * AROUND + i + 1, b = j * AROUND + (i + 1) % AROUND + 1;
      n += (size_t)snprintf(text + n, sizeof text - n, "f %d %d %d %d\n", a, b,
                            b + AROUND, a + AROUND);
    }
  arena mem = {0};
  mesh m = read_text(text, &mem);
  normals_generate(&m, NORMALS_AUTO, 180, &mem, NULL);
  float worst = 1;
  for (size_t c = 0; c < 3 * m.triangle_count; c++) {
    vec3 p = m.positions[m.position_index[c]];
    if (fabsf(p.y) > 0.99f) continue;  // the poles are many positions
    worst = fminf(worst, vec3_dot(vec3_unit(p), normal_at(&m, c)));
  }
  assert_true(worst > 0.99996f);
  arena_free(&mem);
}

// The same normals, bit for bit, for 1, 2 and 7 threads; and a fan of very
// many faces around one position is done in linear time.
static void threads_do_not_show(void **state) {
  (void)state;
  int faces = getenv("FACET_QUICK") == NULL ? 200000 : 4000;
  arena mem = {0};
  mesh m = {.position_count = (size_t)faces + 1};
  m.triangle_count = (size_t)faces;
  m.positions = ARENA_NEW(&mem, vec3, m.position_count);
  m.position_index = ARENA_NEW(&mem, uint32_t, 3 * m.triangle_count);
  m.runs = ARENA_NEW(&mem, mesh_run, 2);
  m.run_count = 2;
  m.runs[0] = (mesh_run){0, (uint32_t)faces / 3, -1, -1, -1, 5};
  m.runs[1] = (mesh_run){
      (uint32_t)faces / 3, (uint32_t)(faces - faces / 3), -1, -1, -1, 2};
  for (int i = 0; i < faces; i++) {
    double a = 6.283185307179586 * i / faces;
    m.positions[i + 1] =
        (vec3){(float)cos(a), (float)(0.1 * sin(9 * a)), (float)sin(a)};
    uint32_t *t = m.position_index + 3 * i;
    t[1] = (uint32_t)i + 1;
    t[2] = (uint32_t)((i + 1) % faces) + 1;
  }
  mesh first = {0};
  for (int k = 0; k < 3; k++) {
    static const int THREADS[] = {1, 2, 7};
    mesh copy = m;
    pool *p = pool_new(&mem, THREADS[k]);
    normals_generate(&copy, NORMALS_AUTO, 40, &mem, p);
    pool_free(p);
    if (k == 0) first = copy;
    assert_int_equal(copy.normal_count, first.normal_count);
    assert_memory_equal(copy.normals, first.normals, 12 * copy.normal_count);
    assert_memory_equal(copy.normal_index, first.normal_index,
                        12 * m.triangle_count);
  }
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(cube_normals_are_diagonals),
      cmocka_unit_test(creases_and_flat_faces),
      cmocka_unit_test(groups_meet_at_hard_edges),
      cmocka_unit_test(groups_may_alternate),
      cmocka_unit_test(file_normals_stay),
      cmocka_unit_test(sphere_normals_are_radii),
      cmocka_unit_test(threads_do_not_show),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
