// test_camera.c — which ray belongs to which point of the picture.

#include "camera.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

// The view of a camera that must be sound.
static camera_view view_of(camera c, int width, int height) {
  camera_view v;
  error err = {{0}};
  if (!camera_view_of(&v, &c, width, height, &err)) fail_msg("%s", err.text);
  return v;
}

// Where p appears, in pixels, in double precision: the inverse of camera_ray.
// z of the result is the depth along the view.
static void project(const camera *c, const camera_view *v, vec3 p, int width,
                    int height, double out[3]) {
  double d[3] = {(double)p.x - (double)c->eye.x, (double)p.y - (double)c->eye.y,
                 (double)p.z - (double)c->eye.z};
  vec3 r = vec3_unit(v->right), u = vec3_unit(vec3_neg(v->down));
  vec3 axis[3] = {r, u, v->forward};
  double k[3];
  for (int i = 0; i < 3; i++)
    k[i] = d[0] * (double)axis[i].x + d[1] * (double)axis[i].y +
           d[2] * (double)axis[i].z;
  double t = tan((double)c->fov_deg * 3.14159265358979 / 360);
  out[0] = width / 2.0 + k[0] / k[2] / t * height / 2.0;
  out[1] = height / 2.0 - k[1] / k[2] / t * height / 2.0;
  out[2] = k[2];
}

// The middle of the film looks at the target; the fov is the vertical angle
// between the middles of the upper and the lower edge; up is up and right is
// right; directions have length 1.
static void film_and_angles_agree(void **state) {
  (void)state;
  camera c = {"c", {0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 60};
  camera_view v = view_of(c, 200, 100);
  ray middle = camera_ray(&v, 100, 50);
  assert_true(vec3_length(vec3_sub(middle.d, (vec3){0, 0, -1})) < 1e-6f);
  assert_true(middle.tmin == 0 && middle.tmax == INFINITY);
  ray top = camera_ray(&v, 100, 0), bottom = camera_ray(&v, 100, 100);
  assert_true(fabsf(vec3_dot(top.d, bottom.d) - 0.5f) < 1e-6f);
  assert_true(top.d.y > 0 && fabsf(top.d.x) < 1e-6f);
  ray right = camera_ray(&v, 200, 50);
  assert_true(right.d.x > 0 && fabsf(right.d.y) < 1e-6f);
  // Square pixels: half the width is twice half the height away.
  assert_true(fabsf(right.d.x / -right.d.z - 2 * tanf(PI / 6)) < 1e-5f);
  for (int i = 0; i <= 200; i += 7)
    assert_true(fabsf(vec3_length(camera_ray(&v, (float)i, 3).d) - 1) < 1e-6f);
}

// A ray through the point where a corner of a box projects to meets that
// corner.
static void rays_go_where_projection_says(void **state) {
  (void)state;
  camera c = {"c", {3, 4, 5}, {0.5f, -0.2f, 0}, {0.1f, 1, 0.3f}, 35};
  camera_view v = view_of(c, 640, 360);
  for (int i = 0; i < 8; i++) {
    vec3 p = {i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1};
    double at[3];
    project(&c, &v, p, 640, 360, at);
    ray r = camera_ray(&v, (float)at[0], (float)at[1]);
    vec3 to = vec3_unit(vec3_sub(p, c.eye));
    assert_true(vec3_length(vec3_sub(r.d, to)) < 2e-6f);
  }
}

// The framing camera sees all of a box: flat, thin, tiny, huge, far away, at
// any aspect; and the box fills a good part of the picture.
static void framing_shows_the_whole_box(void **state) {
  (void)state;
  const vec3 boxes[][2] = {
      {{-1, -1, -1}, {1, 1, 1}},
      {{0, 0, 0}, {10, 0.1f, 0.1f}},
      {{-3, 0, -5}, {7, 0, 9}},
      {{0, -5, 0}, {0, 5, 0}},
      {{0, 0, -50}, {0.1f, 0.1f, 50}},
      {{-1e-6f, -1e-6f, 0}, {1e-6f, 0, 0}},
      {{-1e18f, 0, 0}, {1e18f, 1e18f, 1}},
      {{999, 999, 999}, {1001, 1001, 1001}},
  };
  const float aspects[] = {0.01f, 0.5f, 1, 16.0f / 9, 3, 50};
  for (size_t b = 0; b < sizeof boxes / sizeof *boxes; b++)
    for (size_t a = 0; a < sizeof aspects / sizeof *aspects; a++) {
      camera c = camera_framing(boxes[b][0], boxes[b][1], aspects[a]);
      int width = aspects[a] < 1 ? 100 : (int)lroundf(100 * aspects[a]);
      int height = aspects[a] < 1 ? (int)lroundf(100 / aspects[a]) : 100;
      camera_view v = view_of(c, width, height);
      double most = 0;
      for (int i = 0; i < 8; i++) {
        double at[3];
        vec3 p = {boxes[b][i & 1].x, boxes[b][i >> 1 & 1].y,
                  boxes[b][i >> 2 & 1].z};
        project(&c, &v, p, width, height, at);
        assert_true(at[2] > 0);
        double x = fabs(at[0] / width * 2 - 1),
               y = fabs(at[1] / height * 2 - 1);
        assert_true(x <= 1 && y <= 1);
        most = fmax(most, fmax(x, y));
      }
      assert_true(most > 0.5);
    }
}

// Nothing to frame still gives a camera that makes rays: a point, also far
// from the origin, the empty box, boxes that are not finite.
static void framing_nothing_works(void **state) {
  (void)state;
  const float inf = INFINITY;
  const vec3 boxes[][2] = {
      {{0, 0, 0}, {0, 0, 0}},
      {{1e6f, -1e6f, 1e6f}, {1e6f, -1e6f, 1e6f}},
      {{inf, inf, inf}, {-inf, -inf, -inf}},
      {{NAN, 0, 0}, {1, 1, 1}},
  };
  for (size_t b = 0; b < sizeof boxes / sizeof *boxes; b++) {
    camera c = camera_framing(boxes[b][0], boxes[b][1], 1.5f);
    camera_view v = view_of(c, 30, 20);
    assert_true(vec3_finite(camera_ray(&v, 3, 4).d));
  }
}

// What makes no picture is refused in words.
static void bad_cameras_are_refused(void **state) {
  (void)state;
  const camera good = {"c", {0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 60};
  camera bad[7];
  for (int i = 0; i < 7; i++)
    bad[i] = good;
  bad[0].target = good.eye;
  bad[1].up = (vec3){0, 0, -3};
  bad[2].up = vec3_all(0);
  bad[3].fov_deg = 0;
  bad[4].fov_deg = 180;
  bad[5].fov_deg = NAN;
  bad[6].eye.y = INFINITY;
  const char *words[] = {"same point", "up",  "up",    "fov",
                         "fov",        "fov", "finite"};
  for (int i = 0; i < 7; i++) {
    camera_view v = {.eye = {7, 7, 7}};
    error err = {{0}};
    assert_false(camera_view_of(&v, &bad[i], 10, 10, &err));
    assert_non_null(strstr(err.text, words[i]));
    assert_true(v.eye.x == 7);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(film_and_angles_agree),
      cmocka_unit_test(rays_go_where_projection_says),
      cmocka_unit_test(framing_shows_the_whole_box),
      cmocka_unit_test(framing_nothing_works),
      cmocka_unit_test(bad_cameras_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
