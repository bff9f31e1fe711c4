// test_plot.c — strokes cover what they should, and points stand where their
// numbers are.

#include "glyph.h"
#include "plot.h"

#include "pictures.h"

#include <math.h>
#include <string.h>

// How much ink is on the paper, in pixels.
static double ink(const image *im) {
  double sum = 0;
  for (int i = 0; i < im->width * im->height; i++)
    sum += 1 - (double)im->pixels[i].x;
  return sum;
}

// A pen of width w along a line of length l leaves l w + pi w^2 / 4 of ink at
// any angle, within what half a pixel at the edge of the round ends can be off.
static void ink_is_area(void **state) {
  (void)state;
  for (int k = 0; k < 12; k++) {
    arena mem = {0};
    sketch s = sketch_new(&mem, 100, 100);
    float a = (float)k * PI / 12, w = 1.0f + (float)k / 3, l = 60;
    vec2 d = {cosf(a) * l / 2, sinf(a) * l / 2};
    vec2 line[2] = {{50.3f - d.x, 50.1f - d.y}, {50.3f + d.x, 50.1f + d.y}};
    sketch_line(&s, (sketch_pen){{0}, w}, line, 2);
    image im = sketch_image(&s, &mem);
    double want = (double)(l * w + PI * w * w / 4);
    assert_true(fabs(ink(&im) / want - 1) < 0.02);
    arena_free(&mem);
  }
}

// A pen that goes over a place twice within a stroke leaves ink once.
static void a_stroke_covers_once(void **state) {
  (void)state;
  arena mem = {0};
  sketch once = sketch_new(&mem, 40, 20), twice = sketch_new(&mem, 40, 20);
  vec2 way[3] = {{5, 10.2f}, {35, 10.2f}, {5, 10.2f}};
  sketch_line(&once, (sketch_pen){{0}, 1}, way, 2);
  sketch_line(&twice, (sketch_pen){{0}, 1}, way, 3);
  image a = sketch_image(&once, &mem), b = sketch_image(&twice, &mem);
  assert_memory_equal(a.pixels, b.pixels, 40 * 20 * sizeof *a.pixels);
  arena_free(&mem);
}

// Dashes are half of the line, around corners too.
static void dashes_are_half(void **state) {
  (void)state;
  arena mem = {0};
  sketch s = sketch_new(&mem, 100, 100);
  vec2 way[3] = {{10, 10}, {73, 10}, {73, 67}};
  sketch_dashes(&s, (sketch_pen){{0}, 1}, way, 3, 6);
  double length = 0;
  for (const sketch_stroke *k = s.first; k != NULL; k = k->next)
    length += hypot((double)(k->points[1].x - k->points[0].x),
                    (double)(k->points[1].y - k->points[0].y));
  assert_true(fabs(length - 60) < 1e-3);
  arena_free(&mem);
}

// Every printable character is pairs of digits, fits the grid and is as wide
// as it says.
static void letters_are_on_the_grid(void **state) {
  (void)state;
  for (char c = ' '; c <= '~'; c++) {
    const char *s = glyph_strokes(c);
    assert_true(strspn(s, "0123456789abcdefg ") == strlen(s));
    for (size_t n; *s != 0; s += n + (s[n] == ' ')) {
      n = strcspn(s, " ");
      assert_true(n >= 4 && n % 2 == 0);
      for (size_t i = 0; i < n; i += 2) {
        assert_true(glyph_digit(s[i]) + GLYPH_GAP <= glyph_advance(c));
        assert_true(glyph_digit(s[i + 1]) <= GLYPH_CAPITAL);
      }
    }
  }
  assert_string_equal(glyph_strokes('\n'), glyph_strokes('?'));
}

// The place of the n-th dot of a colour that nothing else has.
static vec2 dot_of(const sketch *s, vec3 color, int n) {
  for (const sketch_stroke *k = s->first; k != NULL; k = k->next)
    if (k->count == 1 && k->color.y == color.y && n-- == 0) return k->points[0];
  fail();
  return (vec2){0};
}

// Three dots with x = 1, 10, 100: on a logarithmic axis the middle one stands
// half way, on a linear one at 9/99.  Upwards is more.
static void points_stand_where_they_are(void **state) {
  (void)state;
  arena mem = {0};
  double x[] = {1, 10, 100}, y[] = {0, 1, 2};
  plot_series s = {.color = {1, 0.123f, 0},
                   .mark = PLOT_DISC,
                   .line = PLOT_NO_LINE,
                   .n = 3,
                   .x = x,
                   .y = y};
  plot p = {.width = 300, .height = 200, .series = &s, .count = 1};
  for (int log = 0; log < 2; log++) {
    p.x.log = log == 1;
    sketch k = plot_sketch(&p, &mem);
    vec2 a = dot_of(&k, s.color, 0), b = dot_of(&k, s.color, 1),
         c = dot_of(&k, s.color, 2);
    float share = (b.x - a.x) / (c.x - a.x);
    assert_true(fabsf(share - (log ? 0.5f : 9.0f / 99)) < 1e-4f);
    assert_true(fabsf(a.y + c.y - 2 * b.y) < 1e-3f && a.y > c.y);
  }
  arena_free(&mem);
}

// What an axis cannot show is left out, and nothing at all is a plot too.
static void what_cannot_be_shown(void **state) {
  (void)state;
  arena mem = {0};
  double x[] = {1, 2, 3, 4}, y[] = {0, -1, (double)NAN, 5};
  plot_series s = {
      .color = {1, 0.123f, 0}, .mark = PLOT_DISC, .n = 4, .x = x, .y = y};
  plot p = {.width = 200, .height = 100, .series = &s, .count = 1};
  p.y.log = true;
  sketch k = plot_sketch(&p, &mem);
  int dots = 0;
  for (const sketch_stroke *t = k.first; t != NULL; t = t->next)
    dots += t->count == 1;
  assert_int_equal(dots, 1);
  p.count = 0;
  k = plot_sketch(&p, &mem);
  assert_non_null(k.first);
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(ink_is_area),
      cmocka_unit_test(a_stroke_covers_once),
      cmocka_unit_test(dashes_are_half),
      cmocka_unit_test(letters_are_on_the_grid),
      cmocka_unit_test(points_stand_where_they_are),
      cmocka_unit_test(what_cannot_be_shown),
  };
  return cmocka_run_group_tests_name("plot", tests, NULL, NULL);
}
