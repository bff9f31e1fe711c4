// The table of options and what reads a command line by it; JSON; the curves
// from radiance to the screen.

#include "json.h"
#include "option.h"
#include "tonemap.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// Parse one line of words; the pointers of o live as long as the words.
static bool parse(options *o, const char *line, error *err) {
  static char copy[512];
  static char *argv[32];
  static const char *operands[32];
  int argc = 0;
  snprintf(copy, sizeof copy, "facet %s", line);
  for (char *w = strtok(copy, " "); w != NULL; w = strtok(NULL, " "))
    argv[argc++] = w;
  argv[argc] = NULL;
  return options_parse(o, argc, argv, operands, err);
}

// Every entry of the table can be shown and parsed: it has a name and a text,
// an argument exactly when it is no switch, and within a command no two share
// a name or a letter.
static void test_table(void **state) {
  (void)state;
  for (int i = 0; i < OPTION_COUNT; i++) {
    const option *a = &option_table[i];
    assert_non_null(a->name);
    assert_non_null(a->help);
    assert_true(a->commands != 0);
    assert_true((a->argument == NULL) == (a->kind == OPTION_SWITCH));
    bool numeric = a->kind == OPTION_WHOLE || a->kind == OPTION_NUMBER ||
                   a->kind == OPTION_SIZE || a->kind == OPTION_BOX;
    if (numeric) assert_true(a->low < a->high);
    for (int j = 0; j < i; j++) {
      const option *b = &option_table[j];
      if ((a->commands & b->commands) == 0) continue;
      assert_string_not_equal(a->name, b->name);
      assert_true(a->letter == 0 || a->letter != b->letter);
    }
  }
}

// The defaults that help shows are the values in force when nothing is given.
static void test_fallbacks(void **state) {
  (void)state;
  options o;
  error err;
  assert_true(parse(&o, "render x.obj", &err));
  for (int i = 0; i < OPTION_COUNT; i++)
    assert_ptr_equal(o.value[i].text, option_table[i].fallback);
  assert_int_equal(o.value[OPT_SPP].whole[0], 64);
  assert_int_equal(o.value[OPT_RESOLUTION].whole[0], 1280);
  assert_int_equal(o.value[OPT_RESOLUTION].whole[1], 720);
  assert_true(o.value[OPT_CREASE].number[0] == 180);
  assert_false(o.value[OPT_SPP].given);
}

// A word's value is its place among the words that help shows.
static void test_words(void **state) {
  (void)state;
  for (int i = 0; i < OPTION_COUNT; i++) {
    const option *a = &option_table[i];
    if (a->kind != OPTION_WORD || (a->commands & CMD_RENDER) == 0) continue;
    char word[64], line[128];
    for (unsigned k = 0; option_word(a, k, word, sizeof word); k++) {
      options o;
      error err;
      snprintf(line, sizeof line, "render --%s=%s x.obj", a->name, word);
      assert_true(parse(&o, line, &err));
      assert_int_equal(o.value[i].words, k);
      snprintf(line, sizeof line, "render --%s=%sx x.obj", a->name, word);
      assert_false(parse(&o, line, &err));
      assert_non_null(strstr(err.text, a->argument));
    }
  }
}

// Values by either form, by letter and in bundles; the last one wins; what
// follows -- is no option.
static void test_forms(void **state) {
  (void)state;
  options o;
  error err;
  assert_true(parse(&o, "render -r 3x4 --spp=7 a --spp 9 -qvj3 -- -b", &err) ==
              false);  // two operands are one too many
  assert_true(parse(&o, "render -r3x4 --spp=7 --spp 9 -qvj3 -- -b", &err));
  assert_int_equal(o.value[OPT_RESOLUTION].whole[1], 4);
  assert_int_equal(o.value[OPT_SPP].whole[0], 9);
  assert_int_equal(o.value[OPT_THREADS].whole[0], 3);
  assert_true(o.value[OPT_QUIET].given && o.value[OPT_VERBOSE].given);
  assert_int_equal(o.operand_count, 1);
  assert_string_equal(o.operands[0], "-b");
  assert_true(parse(&o, "render --eye -1,2e1,-.5 --aov depth,samples -", &err));
  assert_true(o.value[OPT_EYE].number[0] == -1 &&
              o.value[OPT_EYE].number[1] == 20 &&
              o.value[OPT_EYE].number[2] == -0.5f);
  assert_int_equal(o.value[OPT_AOV].words, 2 + 16);
  assert_string_equal(o.operands[0], "-");
}

// What json_text writes for some bytes.
static char *written(const char *text) {
  static char out[256];
  FILE *f = tmpfile();
  assert_non_null(f);
  json j = {.out = f};
  json_text(&j, NULL, text);
  rewind(f);
  out[fread(out, 1, sizeof out - 1, f)] = 0;
  fclose(f);
  return out;
}

// Whatever the bytes, the text is valid JSON and valid UTF-8: well-formed
// sequences pass, every other byte is one Latin-1 character.
static void test_json(void **state) {
  (void)state;
  assert_string_equal(written("a\"b\\c\n\t\x7f"),
                      "\"a\\\"b\\\\c\\u000a\\u0009\\u007f\"");
  assert_string_equal(written("\xc3\xa4\xe2\x82\xac\xf0\x9f\x98\x80"),
                      "\"\xc3\xa4\xe2\x82\xac\xf0\x9f\x98\x80\"");
  assert_string_equal(written("caf\xe9"), "\"caf\\u00e9\"");
  // Overlong, surrogate, beyond the last character, cut short.
  assert_string_equal(written("\xc0\xaf"), "\"\\u00c0\\u00af\"");
  assert_string_equal(written("\xe0\x80\xaf"), "\"\\u00e0\\u0080\\u00af\"");
  assert_string_equal(written("\xed\xa0\x80"), "\"\\u00ed\\u00a0\\u0080\"");
  assert_string_equal(written("\xf4\x90\x80\x80"),
                      "\"\\u00f4\\u0090\\u0080\\u0080\"");
  assert_string_equal(written("\xe2\x82"), "\"\\u00e2\\u0082\"");
}

// A curve keeps the order of brightness and never passes white; without one a
// stop is exactly a factor of two.
static void test_tonemap(void **state) {
  (void)state;
  arena mem = {0};
  image im = image_new(&mem, 1, 1);
  for (int curve = TONEMAP_NONE; curve <= TONEMAP_ACES; curve++) {
    float last = -1;
    for (float x = 0; x < 1000; x = x * 1.1f + 0.001f) {
      im.pixels[0] = vec3_all(x);
      tonemap_apply(&im, 1, (tonemap_curve)curve);
      float y = im.pixels[0].x;
      assert_true(y >= last);
      if (curve == TONEMAP_NONE) assert_true(y == 2 * x);
      if (curve != TONEMAP_NONE) assert_true(y <= 1);
      last = y;
    }
    if (curve != TONEMAP_NONE) assert_true(last > 0.99f);
  }
  arena_free(&mem);
}

// A list of sizes gives each of them back, and one wrong size among them is
// refused wherever it stands.
static void test_sizes(void **state) {
  (void)state;
  options o;
  error err;
  int w, h;
  assert_true(parse(&o, "bench raster -r 1x2,30x40,65535x1 x.obj", &err));
  const option_value *v = &o.value[OPT_RESOLUTIONS];
  const int wanted[3][2] = {{1, 2}, {30, 40}, {65535, 1}};
  for (unsigned i = 0; i < 3; i++) {
    assert_true(option_size(v, i, &w, &h));
    assert_int_equal(w, wanted[i][0]);
    assert_int_equal(h, wanted[i][1]);
  }
  assert_false(option_size(v, 3, &w, &h));
  const char *wrong[] = {"1x2,",  ",1x2",      "1x2,,3x4", "0x2,1x2",
                         "1x2,3", "1x2,3x4x5", "1x2;3x4",  "1x65536"};
  char line[128];
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    snprintf(line, sizeof line, "bench raster -r %s x.obj", wrong[i]);
    assert_false(parse(&o, line, &err));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_table),   cmocka_unit_test(test_fallbacks),
      cmocka_unit_test(test_words),   cmocka_unit_test(test_sizes),
      cmocka_unit_test(test_forms),   cmocka_unit_test(test_json),
      cmocka_unit_test(test_tonemap),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
