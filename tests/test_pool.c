// test_pool.c — work shared by threads, and how many there may be.

#include "cpu_quota.h"
#include "pool.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <cmocka.h>

enum { ITEMS = 1000 };

// How often each item was done, and whether some worker was none of the pool.
typedef struct tally {
  atomic_int done[ITEMS];
  atomic_int strange;
  int threads;
} tally;

static void count_item(void *context, size_t item, int worker) {
  tally *t = context;
  atomic_fetch_add(&t->done[item], 1);
  if (worker < 0 || worker >= t->threads) atomic_fetch_add(&t->strange, 1);
}

typedef void (*run_function)(pool *, size_t, pool_work, void *);

// Every item is done exactly once, by a worker of the pool, in every one of
// many rounds, for 1, 2 and 7 threads and without a pool.
static void done_once_by(run_function run) {
  static const int THREADS[] = {0, 1, 2, 7};
  int rounds = getenv("FACET_QUICK") == NULL ? 200 : 20;
  for (int k = 0; k < 4; k++) {
    arena mem = {0};
    pool *p = THREADS[k] == 0 ? NULL : pool_new(&mem, THREADS[k]);
    static tally t;
    memset(&t, 0, sizeof t);
    t.threads = pool_threads(p);
    for (int round = 0; round < rounds; round++)
      run(p, (size_t)(round % 5 == 0 ? 1 : ITEMS), count_item, &t);
    for (int i = 1; i < ITEMS; i++)
      assert_int_equal(t.done[i], rounds - (rounds + 4) / 5);
    assert_int_equal(t.done[0], rounds);
    assert_int_equal(t.strange, 0);
    run(p, 0, count_item, &t);
    pool_free(p);
    arena_free(&mem);
  }
}

static void every_item_is_done_once(void **state) {
  (void)state;
  done_once_by(pool_run);
}

static void every_near_item_is_done_once(void **state) {
  (void)state;
  done_once_by(pool_run_near);
}

static void square_item(void *context, size_t item, int worker) {
  uint64_t *out = context;
  (void)worker;
  out[item] = (uint64_t)item * item;
}

// What the items wrote is seen by the caller as soon as pool_run returns.
static void results_are_there_on_return(void **state) {
  (void)state;
  arena mem = {0};
  pool *p = pool_new(&mem, 3);
  static uint64_t out[ITEMS];
  for (int round = 0; round < 50; round++) {
    memset(out, 0, sizeof out);
    pool_run(p, ITEMS, square_item, out);
    for (uint64_t i = 0; i < ITEMS; i++)
      assert_true(out[i] == i * i);
  }
  pool_free(p);
  arena_free(&mem);
}

// A pool has at least one worker and at most 1024.
static void thread_counts_are_kept_sane(void **state) {
  (void)state;
  arena mem = {0};
  pool *p = pool_new(&mem, -3);
  assert_int_equal(pool_threads(p), 1);
  pool_free(p);
  p = pool_new(&mem, 5);
  assert_int_equal(pool_threads(p), 5);
  pool_free(p);
  assert_true(pool_default_threads() >= 1);
  assert_true(pool_default_threads() <= 1024);
  arena_free(&mem);
}

// SLURM_CPUS_PER_TASK can only lower the number of threads, and only when it
// is a number.
static void slurm_limits_threads(void **state) {
  (void)state;
  unsetenv("SLURM_CPUS_PER_TASK");
  int all = pool_default_threads();
  setenv("SLURM_CPUS_PER_TASK", "1", 1);
  assert_int_equal(pool_default_threads(), 1);
  setenv("SLURM_CPUS_PER_TASK", "1000", 1);
  assert_int_equal(pool_default_threads(), all);
  static const char *const NONSENSE[] = {"", "0", "-1", "2x", "1 1"};
  for (int i = 0; i < 5; i++) {
    setenv("SLURM_CPUS_PER_TASK", NONSENSE[i], 1);
    assert_int_equal(pool_default_threads(), all);
    assert_int_equal(cpu_count_of(NONSENSE[i]), 0);
  }
  unsetenv("SLURM_CPUS_PER_TASK");
  assert_int_equal(cpu_count_of("12"), 12);
  assert_int_equal(cpu_count_of(NULL), 0);
}

static char root[64];

// Write text to a file below the root, making its folders.
static void put(const char *path, const char *text) {
  char full[256];
  snprintf(full, sizeof full, "%s/%s", root, path);
  for (char *p = full + strlen(root) + 1; (p = strchr(p, '/')) != NULL; p++) {
    *p = '\0';
    mkdir(full, 0700);
    *p = '/';
  }
  FILE *f = fopen(full, "w");
  assert_non_null(f);
  fputs(text, f);
  fclose(f);
}

// The quota that the files below the root give a process in these groups.
static double quota(const char *groups) {
  char path[128];
  put("cgroup", groups);
  snprintf(path, sizeof path, "%s/cgroup", root);
  return cpu_quota(path, root);
}

// Version 2: quota over period, the least of the group and those above it.
static void quotas_of_version_2(void **state) {
  (void)state;
  assert_true(quota("0::/\n") == HUGE_VAL);
  put("a/b/cpu.max", "max 100000\n");
  assert_true(quota("0::/a/b\n") == HUGE_VAL);
  put("a/cpu.max", "765000 100000\n");
  assert_true(fabs(quota("0::/a/b\n") - 7.65) < 1e-9);
  put("a/b/cpu.max", "50000 100000\n");
  assert_true(quota("0::/a/b\n") == 0.5);
  assert_true(fabs(quota("0::/a\n") - 7.65) < 1e-9);
  put("cpu.max", "20000 100000\n");
  assert_true(fabs(quota("0::/\n") - 0.2) < 1e-9);
  put("cpu.max", "nonsense\n");
  assert_true(quota("0::/\n") == HUGE_VAL);
}

// Version 1: two files below the mount of the cpu controller.
static void quotas_of_version_1(void **state) {
  (void)state;
  static const char GROUPS[] = "7:memory:/x\n5:cpu,cpuacct:/job/7\n";
  put("cpu/job/7/cpu.cfs_quota_us", "-1\n");
  put("cpu/job/7/cpu.cfs_period_us", "100000\n");
  assert_true(quota(GROUPS) == HUGE_VAL);
  put("cpu/job/7/cpu.cfs_quota_us", "250000\n");
  assert_true(quota(GROUPS) == 2.5);
  put("cpu/cpu.cfs_quota_us", "150000\n");
  put("cpu/cpu.cfs_period_us", "100000\n");
  assert_true(quota(GROUPS) == 1.5);
  assert_true(cpu_quota("/nowhere", root) == HUGE_VAL);
}

static int make_root(void **state) {
  (void)state;
  strcpy(root, "/tmp/facet-pool-XXXXXX");
  return mkdtemp(root) == NULL;
}

static int remove_root(void **state) {
  static const char *const NAMES[] = {"a/b/cpu.max",
                                      "a/b",
                                      "a/cpu.max",
                                      "a",
                                      "cpu.max",
                                      "cgroup",
                                      "cpu/job/7/cpu.cfs_quota_us",
                                      "cpu/job/7/cpu.cfs_period_us",
                                      "cpu/job/7",
                                      "cpu/job",
                                      "cpu/cpu.cfs_quota_us",
                                      "cpu/cpu.cfs_period_us",
                                      "cpu",
                                      ""};
  (void)state;
  char path[128];
  for (int i = 0; i < 14; i++) {
    snprintf(path, sizeof path, "%s/%s", root, NAMES[i]);
    remove(path);
  }
  return 0;
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_item_is_done_once),
      cmocka_unit_test(every_near_item_is_done_once),
      cmocka_unit_test(results_are_there_on_return),
      cmocka_unit_test(thread_counts_are_kept_sane),
      cmocka_unit_test(slurm_limits_threads),
      cmocka_unit_test(quotas_of_version_2),
      cmocka_unit_test(quotas_of_version_1),
  };
  return cmocka_run_group_tests(tests, make_root, remove_root);
}
