// test_hostile.c — every reader and the bytes of strangers: files cut short at
// each byte, files with one byte changed, and what the fuzzers found.  The
// targets themselves (tests/fuzz/targets.h) check what comes of them.

#include "fuzz/targets.h"

#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmocka.h>

// Seconds that one input may take; then the system ends the test.
enum { PATIENCE = 10 };

// Changes of one byte for each format.
enum { FLIPS = 10000 };

// Bytes of the longest seed.
enum { SEED_MAX = 8192 };

// What the inputs, none longer than SEED_MAX, may make us hold at a time.
enum { PEAK_MB = 700 };

// One small file.
typedef struct seed {
  char name[300];
  uint8_t bytes[SEED_MAX];
  size_t size;
} seed;

// Read a file that a test has made or found.
static seed seed_read(const char *folder, const char *name) {
  seed s = {.size = 0};
  char path[600];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  snprintf(s.name, sizeof s.name, "%s", name);
  FILE *f = fopen(path, "rb");
  if (f == NULL) fail_msg("%s cannot be read", path);
  s.size = fread(s.bytes, 1, sizeof s.bytes, f);
  fclose(f);
  assert_true(s.size < SEED_MAX);
  return s;
}

// The seeds in tests/fuzz/KIND/NAME, at most `most`; how many.
static size_t seeds_of(const char *kind, const char *name, seed *out,
                       size_t most) {
  char folder[200];
  snprintf(folder, sizeof folder, "tests/fuzz/%s/%s", kind, name);
  DIR *d = opendir(folder);
  size_t n = 0;
  for (struct dirent *e; d != NULL && (e = readdir(d)) != NULL;)
    if (e->d_name[0] != '.') {
      assert_true(n < most);
      out[n++] = seed_read(folder, e->d_name);
    }
  if (d != NULL) closedir(d);
  return n;
}

// Run a target on a copy of exactly that length, so that a sanitizer sees
// every read beyond it.
static void try_input(const target *t, const uint8_t *bytes, size_t size) {
  uint8_t *copy = malloc(size > 0 ? size : 1);
  assert_non_null(copy);
  if (size > 0) memcpy(copy, bytes, size);
  alarm(PATIENCE);
  assert_int_equal(t->run(copy, size), 0);
  alarm(0);
  free(copy);
}

enum { SEEDS_MOST = 32 };

// A target and its seeds, by its place in TARGETS.
typedef struct seeded {
  const target *target;
  seed *seeds;
  size_t count;
} seeded;

static seeded seeded_new(int i) {
  seeded s = {&TARGETS[i], calloc(SEEDS_MOST, sizeof(seed)), 0};
  assert_non_null(s.seeds);
  s.count = seeds_of("seeds", s.target->name, s.seeds, SEEDS_MOST);
  if (s.count == 0) fail_msg("no seeds for %s", s.target->name);
  return s;
}

// A file of every format and flavour, cut short at every byte.
static void every_length_is_survived(void **state) {
  (void)state;
  for (int i = 0; i < TARGET_COUNT; i++) {
    seeded s = seeded_new(i);
    size_t tried = 0;
    for (size_t k = 0; k < s.count; k++)
      for (size_t n = 0; n <= s.seeds[k].size; n++, tried++)
        try_input(s.target, s.seeds[k].bytes, n);
    print_message("# %s: %zu lengths of %zu files\n", s.target->name, tried,
                  s.count);
    free(s.seeds);
  }
}

// Source: Marsaglia 2003, "Xorshift RNGs".
static uint64_t next_random(uint64_t *s) {
  *s ^= *s << 13;
  *s ^= *s >> 7;
  return *s ^= *s << 17;
}

// One byte of a file becomes another; of PNG files and parts, half with right
// checksums.
static void every_byte_may_change(void **state) {
  (void)state;
  uint64_t random = 88172645463325252u;
  for (int i = 0; i < TARGET_COUNT; i++) {
    seeded s = seeded_new(i);
    for (size_t k = 0; k < FLIPS; k++) {
      seed *one = &s.seeds[k % s.count];
      size_t at = (size_t)(next_random(&random) % one->size);
      uint8_t other = (uint8_t)(1 + next_random(&random) % 255);
      one->bytes[at] ^= other;
      seed bad = *one;
      if (k % 2 == 0) mend_png(bad.bytes, bad.size);
      if (k % 2 == 0) mend_part(bad.bytes, bad.size);
      try_input(s.target, bad.bytes, bad.size);
      one->bytes[at] ^= other;
    }
    free(s.seeds);
  }
}

// What once went wrong: tests/fuzz/corpus.
static void old_findings_stay_fixed(void **state) {
  (void)state;
  size_t tried = 0;
  for (int i = 0; i < TARGET_COUNT; i++) {
    seed *found = calloc(SEEDS_MOST, sizeof *found);
    assert_non_null(found);
    size_t n = seeds_of("corpus", TARGETS[i].name, found, SEEDS_MOST);
    for (size_t k = 0; k < n; k++, tried++)
      try_input(&TARGETS[i], found[k].bytes, found[k].size);
    free(found);
  }
  assert_true(tried > 0);
  print_message("# %zu files\n", tried);
}

// None of all that needed much memory.  A sanitizer's own is not ours.
static void memory_stays_bounded(void **state) {
  (void)state;
  struct rusage usage;
  assert_int_equal(getrusage(RUSAGE_SELF, &usage), 0);
  long mb = usage.ru_maxrss / 1024;
  print_message("# %ld MB\n", mb);
#ifndef __SANITIZE_ADDRESS__
  assert_true(mb < PEAK_MB);
#endif
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_length_is_survived),
      cmocka_unit_test(every_byte_may_change),
      cmocka_unit_test(old_findings_stay_fixed),
      cmocka_unit_test(memory_stays_bounded),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
