// test_text.c — lines, words and files named inside files.

#include "name_table.h"
#include "path_find.h"
#include "text.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

// A string with NUL bytes inside, as a span.
#define SPAN(literal) ((span){literal, sizeof literal - 1})

// Check that text splits into the given lines with the given numbers.
static void check_lines(span text, int n, const char *const *lines,
                        const int *numbers) {
  text_lines t = text_lines_of(text, 1);
  span line;
  for (int i = 0; i < n; i++) {
    assert_true(text_next_line(&t, &line));
    assert_true(span_is(line, lines[i]));
    assert_int_equal(t.line, numbers[i]);
  }
  assert_false(text_next_line(&t, &line));
  text_lines_free(&t);
}

// LF, CR LF and lone CR end a line; the last one may have no end; a byte-order
// mark is no part of the first.
static void lines_end_in_three_ways(void **state) {
  (void)state;
  static const char *const LINES[] = {"a", "b", "c", "", "d", "e"};
  static const int NUMBERS[] = {1, 2, 3, 4, 5, 6};
  check_lines(SPAN("a\nb\r\nc\r\rd\ne"), 6, LINES, NUMBERS);
  check_lines(SPAN("\xef\xbb\xbf"
                   "a\nb\r\nc\r\rd\re\n"),
              6, LINES, NUMBERS);
  check_lines(SPAN(""), 0, LINES, NUMBERS);
}

// A backslash at the very end of a line joins the next one, with a blank
// between; numbers count the lines of the file; a comment is not continued,
// but a later part of a continued line may look like one.
static void backslashes_continue_lines(void **state) {
  (void)state;
  static const char *const LINES[] = {"a b c", "d\\ ", "# e\\", "f  g", "h "};
  static const int NUMBERS[] = {1, 4, 5, 6, 9};
  check_lines(SPAN("a\\\nb\\\r\nc\nd\\ \n# e\\\nf\\\n\\\ng\nh\\"), 5, LINES,
              NUMBERS);
}

// Words are separated by blanks of every kind, NUL among them; quotes hold a
// word together.
static void words_are_between_blanks(void **state) {
  (void)state;
  span line = SPAN(" a\tb\0c\v\fd \"e f\" g\"h \"\" \"open ");
  static const char *const WORDS[] = {"a", "b", "c", "d", "e f", "g\"h"};
  for (size_t i = 0; i < 6; i++)
    assert_true(span_is(text_word(&line), WORDS[i]));
  span empty = text_word(&line);
  assert_int_equal(empty.length, 0);
  assert_true(span_is(text_word(&line), "\"open"));
  assert_int_equal(text_word(&line).length, 0);
  assert_int_equal(text_word(&line).length, 0);
}

// # starts a comment only where a word starts, and not inside quotes.
static void comments_start_at_words(void **state) {
  (void)state;
  assert_true(span_is(text_uncomment(SPAN("a #b")), "a "));
  assert_true(span_is(text_uncomment(SPAN("a#b # c")), "a#b "));
  assert_true(span_is(text_uncomment(SPAN("#")), ""));
  assert_true(span_is(text_uncomment(SPAN("\"a #b\" #c")), "\"a #b\" "));
  assert_true(span_is(text_uncomment(SPAN("\"a #b")), "\"a "));
  assert_true(span_is(text_trim(SPAN("\t a b \0")), "a b"));
}

// A number must be all of its span.
static void spans_are_whole_numbers_or_none(void **state) {
  (void)state;
  float f = 7;
  long long i = 7;
  assert_true(span_float(SPAN("-1.5e1"), &f) && f == -15);
  assert_false(span_float(SPAN("1.5x"), &f));
  assert_false(span_float(SPAN(" 1"), &f));
  assert_false(span_float(SPAN(""), &f));
  assert_true(f == -15);
  assert_true(span_int(SPAN("-12"), &i) && i == -12);
  assert_false(span_int(SPAN("12.0"), &i));
  assert_false(span_int(SPAN(""), &i));
  assert_true(i == -12);
}

// A misspelt word finds the word that was meant, nonsense finds none.
static void the_nearest_word_is_found(void **state) {
  (void)state;
  static const char *const WORDS[] = {"camera", "env", "light",
                                      "target", "d",   NULL};
  assert_string_equal(text_nearest(SPAN("camrea"), WORDS), "camera");
  assert_string_equal(text_nearest(SPAN("Light"), WORDS), "light");
  assert_string_equal(text_nearest(SPAN("evn"), WORDS), "env");
  assert_string_equal(text_nearest(SPAN("targets"), WORDS), "target");
  assert_null(text_nearest(SPAN("resolution"), WORDS));
  assert_null(text_nearest(SPAN("xyz"), WORDS));
  assert_null(text_nearest(SPAN(""), WORDS));
}

// A folder of files to look for, with the path of each.
static char folder[64];

static char *file_in_folder(arena *mem, const char *name) {
  char *path = arena_format(mem, "%s/%s", folder, name);
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  fclose(f);
  return path;
}

static int make_folder(void **state) {
  (void)state;
  strcpy(folder, "/tmp/facet-text-XXXXXX");
  if (mkdtemp(folder) == NULL) return -1;
  char sub[96];
  snprintf(sub, sizeof sub, "%s/Maps", folder);
  return mkdir(sub, 0700);
}

static int remove_folder(void **state) {
  static const char *const NAMES[] = {"Maps/Wood.PNG", "a b.mtl", "Case.mtl",
                                      "stone.png",     "Maps",    ""};
  (void)state;
  char path[128];
  for (int i = 0; i < 6; i++) {
    snprintf(path, sizeof path, "%s/%s", folder, NAMES[i]);
    remove(path);
  }
  return 0;
}

// A name and the file it must lead to ("": none), and whether that is noted.
typedef struct search {
  const char *name, *found;
  int notes;
} search;

// Files are found as written, with back-slashes, by their last component, and
// without regard to case; all but the first are noted.
static void files_are_found_as_they_are_meant(void **state) {
  (void)state;
  static const search SEARCHES[] = {
      {"a b.mtl", "a b.mtl", 0},
      {"./a b.mtl", "./a b.mtl", 0},
      {"Maps\\Wood.PNG", "Maps/Wood.PNG", 1},
      {"maps/wood.png", "Maps/Wood.PNG", 1},
      {"C:\\Users\\me\\stone.png", "stone.png", 1},
      {"/nowhere/stone.png", "stone.png", 1},
      {"/nowhere/STONE.png", "stone.png", 1},
      {"case.MTL", "Case.mtl", 1},
      {"none.mtl", "", 0},
      {"Maps", "", 0},
      {"Maps/", "", 0},
      {"", "", 0}};
  arena mem = {0};
  file_in_folder(&mem, "a b.mtl");
  file_in_folder(&mem, "Case.mtl");
  file_in_folder(&mem, "stone.png");
  file_in_folder(&mem, "Maps/Wood.PNG");
  for (size_t i = 0; i < sizeof SEARCHES / sizeof SEARCHES[0]; i++) {
    const search *s = &SEARCHES[i];
    report r = {.mem = &mem};
    path_search where = {NULL, folder, "x.obj:1", &mem, &r, NULL};
    path_found found = path_find(&where, s->name);
    char *wanted = arena_format(&mem, "%s/%s", folder, s->found);
    if (*s->found == '\0') assert_null(found.path);
    if (*s->found != '\0') assert_string_equal(found.path, wanted);
    assert_int_equal(r.notes, s->notes);
    assert_int_equal(r.warnings, 0);
    assert_non_null(found.tried);
    assert_false(found.outside);
    // None of these leaves the folder.
    where.root = path_root(&mem, arena_format(&mem, "%s/x.obj", folder));
    path_found again = path_find(&where, s->name);
    assert_int_equal(again.path != NULL, found.path != NULL);
    assert_false(again.outside);
  }
  arena_free(&mem);
}

static void folders_of_paths(void **state) {
  (void)state;
  arena mem = {0};
  assert_string_equal(path_folder(&mem, "a.obj"), ".");
  assert_string_equal(path_folder(&mem, "/a.obj"), "/");
  assert_string_equal(path_folder(&mem, "a/b/c.obj"), "a/b");
  arena_free(&mem);
}

// Only regular files are read: a FIFO would wait for ever.
static void only_regular_files_are_read(void **state) {
  (void)state;
  arena mem = {0};
  error err;
  span s = {NULL, 7};
  char *fifo = arena_format(&mem, "%s/fifo", folder);
  assert_int_equal(mkfifo(fifo, 0600), 0);
  assert_false(text_read(&s, fifo, &mem, &err));
  assert_false(text_read(&s, folder, &mem, &err));
  assert_false(text_read(&s, "/dev/zero", &mem, &err));
  assert_false(text_read(&s, "/nowhere/at/all", &mem, &err));
  assert_non_null(strstr(err.text, "/nowhere/at/all: cannot be read: No such"));
  assert_int_equal(s.length, 7);
  remove(fifo);
  arena_free(&mem);
}

// The hash of a name table without a key, as an attacker computes it.
static uint64_t known_hash(const char *s) {
  uint64_t h = 14695981039346656037u;
  for (; *s != '\0'; s++)
    h = (h ^ (unsigned char)*s) * 1099511628211u;
  return h ^ h >> 32;
}

// Names that were chosen to meet in one slot are scattered; names that were not
// keep the first key.  Either way they are numbered as they come.
static void names_that_meet_are_scattered(void **state) {
  (void)state;
  enum { SLOTS = 2048, NAMES = 600 };
  arena mem = {0};
  name_table chosen = {0}, usual = {0};
  char name[32];
  int found = 0;
  for (long i = 0; found < NAMES; i++) {
    snprintf(name, sizeof name, "n%ld", i);
    if (known_hash(name) % SLOTS != 7) continue;
    span s = {name, strlen(name)};
    assert_int_equal(name_table_add(&chosen, s, &mem), found);
    found++;
  }
  assert_true(chosen.slot_count == SLOTS && chosen.key > 0);
  for (int i = 0; i < NAMES; i++) {
    span s = {chosen.names[i], strlen(chosen.names[i])};
    assert_int_equal(name_table_find(&chosen, s), i);
  }
  for (int i = 0; i < 200000; i++) {
    snprintf(name, sizeof name, "Material.%06d", i);
    assert_int_equal(name_table_add(&usual, (span){name, strlen(name)}, &mem),
                     i);
  }
  assert_int_equal(usual.key, 0);
  arena_free(&mem);
}

// A NUL in a name counts as a blank: the same name is the same number.
static void a_nul_in_a_name_is_a_blank(void **state) {
  (void)state;
  arena mem = {0};
  name_table t = {0};
  assert_int_equal(name_table_add(&t, (span){"a\0b", 3}, &mem), 0);
  assert_int_equal(name_table_add(&t, (span){"a\0b", 3}, &mem), 0);
  assert_int_equal(name_table_find(&t, (span){"a b", 3}), 0);
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lines_end_in_three_ways),
      cmocka_unit_test(backslashes_continue_lines),
      cmocka_unit_test(words_are_between_blanks),
      cmocka_unit_test(comments_start_at_words),
      cmocka_unit_test(spans_are_whole_numbers_or_none),
      cmocka_unit_test(the_nearest_word_is_found),
      cmocka_unit_test(files_are_found_as_they_are_meant),
      cmocka_unit_test(folders_of_paths),
      cmocka_unit_test(only_regular_files_are_read),
      cmocka_unit_test(names_that_meet_are_scattered),
      cmocka_unit_test(a_nul_in_a_name_is_a_blank),
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
