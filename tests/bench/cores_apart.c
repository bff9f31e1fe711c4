// cores_apart.c — how long a line of the cache travels between two cores.
//
//   cc -std=gnu11 -O2 tests/bench/cores_apart.c -lpthread -lm -o build/cores_apart
//   build/cores_apart [CORE CORE]
//
// Two threads, pinned to the cores (default 0 and 1), write to one word in
// turn.  Nanoseconds one way, the least of many stretches: 20 to 30 where both
// share a last level of the cache, 100 and more where they do not.  A virtual
// machine's cores may be moved from the one to the other while it runs.

#define _GNU_SOURCE
#include <math.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { TURNS = 400000, STRETCH = 200 };

static struct {
  _Alignas(128) atomic_int turn;
  char apart[124];
} word;

static int cores[2] = {0, 1};

static void pin(int core) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(core, &set);
  sched_setaffinity(0, sizeof set, &set);
}

static double seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// Wait for the word to be `from`, and make it one more.
static void answer(int from) {
  while (atomic_load_explicit(&word.turn, memory_order_acquire) != from)
    ;
  atomic_store_explicit(&word.turn, from + 1, memory_order_release);
}

static void *answer_all(void *unused) {
  pin(cores[1]);
  for (int i = 0; i < TURNS; i++)
    answer(2 * i + 1);
  return unused;
}

int main(int argc, char **argv) {
  for (int k = 0; k < 2 && argc > 2; k++)
    cores[k] = (int)strtol(argv[1 + k], NULL, 10);
  pthread_t other;
  if (pthread_create(&other, NULL, answer_all, NULL) != 0) return 1;
  pin(cores[0]);
  double least = INFINITY, start = seconds();
  for (int i = 0; i < TURNS; i++) {
    answer(2 * i);
    if (i % STRETCH != STRETCH - 1) continue;
    double now = seconds();
    least = fmin(least, (now - start) / (2 * STRETCH));
    start = now;
  }
  pthread_join(other, NULL);
  printf("%.1f ns\n", 1e9 * least);
  return 0;
}
