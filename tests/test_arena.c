// test_arena.c — the ground: memory of one lifetime, errors, remarks.

#include "arena.h"

#include "error.h"
#include "pictures.h"
#include "report.h"

#include <stdalign.h>
#include <stdint.h>
#include <sys/wait.h>
#include <unistd.h>

// Objects of any size come zeroed, aligned, apart, and stay where they are.
static void objects_are_zeroed_and_apart(void **state) {
  (void)state;
  arena a = {0};
  uint8_t *at[500];
  size_t size[500];
  uint32_t s = 1;
  for (int i = 0; i < 500; i++) {
    uint32_t most = i % 250 == 249 ? 5000000 : i % 50 == 0 ? 200000 : 300;
    size[i] = next_random(&s) % most;
    at[i] = arena_alloc(&a, size[i], 1);
    assert_int_equal((uintptr_t)at[i] % alignof(max_align_t), 0);
    for (size_t k = 0; k < size[i]; k++)
      assert_int_equal(at[i][k], 0);
    memset(at[i], i & 255, size[i]);
  }
  for (int i = 0; i < 500; i++)
    for (size_t k = 0; k < size[i]; k++)
      assert_int_equal(at[i][k], i & 255);
  arena_free(&a);
  assert_null(a.top);
}

// What one arena owned lives on in the arena that adopts it.
static void adoption(void **state) {
  (void)state;
  arena a = {0}, b = {0}, none = {0};
  char *x = arena_format(&a, "%d %s", 7, "dwarfs");
  char *y = arena_text(&b, "giants and more", 6);
  arena_adopt(&a, &b);
  arena_adopt(&a, &none);
  arena_adopt(&none, &a);
  assert_null(a.top);
  assert_null(b.top);
  assert_string_equal(x, "7 dwarfs");
  assert_string_equal(y, "giants");
  arena_free(&none);
}

// Without memory the program ends with status 5, before any overflow.
static void out_of_memory_is_status_5(void **state) {
  (void)state;
  pid_t child = fork();
  if (child == 0) {
    arena a = {0};
    if (freopen("/dev/null", "w", stderr) == NULL) _exit(1);
    arena_alloc(&a, SIZE_MAX / 4 + 2, 4);  // wraps around to 4 bytes
    _exit(0);
  }
  int status;
  assert_int_equal(waitpid(child, &status, 0), child);
  assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 5);
}

// A growing array keeps its content and doubles its room.
static void arrays_grow(void **state) {
  (void)state;
  int *array = NULL;
  size_t room = 0, moves = 0;
  for (size_t n = 1; n <= 100000; n++) {
    size_t before = room;
    array = array_grow(array, &room, n, sizeof *array);
    moves += room != before;
    assert_true(room >= n);
    array[n - 1] = (int)n;
  }
  for (int i = 0; i < 100000; i++)
    assert_int_equal(array[i], i + 1);
  assert_in_range(moves, 1, 14);
  array_free(array);
}

// Remarks come in order; beyond the limit they are only counted; a missing
// report is allowed.
static void remarks(void **state) {
  (void)state;
  arena a = {0};
  report r = {.mem = &a};
  for (int i = 0; i < REPORT_MAX + 50; i++) {
    report_warn(&r, "w %d", i);
    report_note(&r, "n %d", i);
  }
  report_warn(NULL, "nobody");
  assert_int_equal(r.warnings, REPORT_MAX + 50);
  assert_int_equal(r.notes, REPORT_MAX + 50);
  int n = 0;
  for (report_line *l = r.first; l != NULL; l = l->next, n++) {
    assert_int_equal(l->kind, n % 2 ? REPORT_NOTE : REPORT_WARNING);
    assert_int_equal(l->text[0], n % 2 ? 'n' : 'w');
  }
  assert_int_equal(n, REPORT_MAX);
  arena_free(&a);
}

// fail says no, and cuts what does not fit.  (The brackets keep cmocka's macro
// of the same name away.)
static void failing(void **state) {
  (void)state;
  error err;
  assert_false((fail)(&err, "%s:%d: bad", "a.obj", 3));
  assert_string_equal(err.text, "a.obj:3: bad");
  assert_false((fail)(&err, "%700d", 1));
  assert_int_equal(strlen(err.text), sizeof err.text - 1);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(objects_are_zeroed_and_apart),
      cmocka_unit_test(adoption),
      cmocka_unit_test(out_of_memory_is_status_5),
      cmocka_unit_test(arrays_grow),
      cmocka_unit_test(remarks),
      cmocka_unit_test(failing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
