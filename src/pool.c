// pool.c

// For sched_getaffinity, which POSIX does not have.
#define _GNU_SOURCE

#include "pool.h"

#include "clock.h"
#include "cpu_quota.h"

#include <assert.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

// Seconds to wait awake.
#define LINGER 50e-6

// More workers than this help nobody.
enum { POOL_MAX_THREADS = 1024 };

// What a helper thread is told at its start: its number, 1 and up.
typedef struct pool_helper {
  pool *owner;
  pthread_t thread;
  int worker;
} pool_helper;

// Items that one worker begins with, and nobody has taken: from the lower half
// of `left` up to the upper half.  On lines of its own, as all ask for it.
typedef struct pool_stretch {
  atomic_uint_least64_t left;
  char apart[120];
} pool_stretch;

// The lock guards what is written to round, busy and quit; work, context and
// items change only while no helper is busy.
struct pool {
  pthread_mutex_t lock;
  pthread_cond_t start, done;
  pool_helper *helpers;
  int helper_count;
  atomic_uint_least64_t round;  // counts the calls of pool_run
  atomic_int busy;              // helpers that have not finished this round
  bool quit;
  pool_work work;
  void *context;
  size_t items;
  atomic_size_t next;  // the next item that nobody has taken
  pool_stretch *stretches;
};

int pool_default_threads(void) {
  int n = 0;
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) n = CPU_COUNT(&set);
  if (n < 1) n = (int)sysconf(_SC_NPROCESSORS_ONLN);
  double quota = cpu_quota("/proc/self/cgroup", "/sys/fs/cgroup");
  if (quota < n) n = (int)quota;
  int slurm = cpu_count_of(getenv("SLURM_CPUS_PER_TASK"));
  if (slurm > 0 && slurm < n) n = slurm;
  if (n > POOL_MAX_THREADS) n = POOL_MAX_THREADS;
  return n < 1 ? 1 : n;
}

// Take items until none is left.
static void drain(pool *p, int worker) {
  size_t item;
  while ((item = atomic_fetch_add(&p->next, 1)) < p->items)
    p->work(p->context, item, worker);
}

// Wait awake for a while: to fall asleep and to be woken takes longer than most
// of what lies between two rounds.
static void linger_for_round(pool *p, uint64_t seen) {
  double end = clock_seconds() + LINGER;
  while (atomic_load(&p->round) == seen && clock_seconds() < end)
    ;
}

static void linger_for_helpers(pool *p) {
  double end = clock_seconds() + LINGER;
  while (atomic_load(&p->busy) > 0 && clock_seconds() < end)
    ;
}

// A helper's life: sleep until a round begins, drain it, say so.
static void *helper_main(void *argument) {
  pool_helper *self = argument;
  pool *p = self->owner;
  uint64_t seen = 0;
  pthread_mutex_lock(&p->lock);
  for (;;) {
    while (p->round == seen && !p->quit)
      pthread_cond_wait(&p->start, &p->lock);
    if (p->quit) break;
    seen = p->round;
    pthread_mutex_unlock(&p->lock);
    drain(p, self->worker);
    pthread_mutex_lock(&p->lock);
    if (--p->busy == 0) pthread_cond_signal(&p->done);
    pthread_mutex_unlock(&p->lock);
    linger_for_round(p, seen);
    pthread_mutex_lock(&p->lock);
  }
  pthread_mutex_unlock(&p->lock);
  return NULL;
}

// Helpers are born with every signal blocked, so that a signal interrupts the
// thread that called pool_new and no other.
pool *pool_new(arena *mem, int threads) {
  if (threads < 1) threads = 1;
  if (threads > POOL_MAX_THREADS) threads = POOL_MAX_THREADS;
  pool *p = ARENA_NEW(mem, pool, 1);
  pthread_mutex_init(&p->lock, NULL);
  pthread_cond_init(&p->start, NULL);
  pthread_cond_init(&p->done, NULL);
  p->helpers = ARENA_NEW(mem, pool_helper, (size_t)threads);
  p->stretches = ARENA_NEW(mem, pool_stretch, (size_t)threads);
  sigset_t all, old;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &old);
  for (int i = 0; i < threads - 1; i++) {
    pool_helper *h = &p->helpers[i];
    h->owner = p;
    h->worker = i + 1;
    if (pthread_create(&h->thread, NULL, helper_main, h) != 0) break;
    p->helper_count++;
  }
  pthread_sigmask(SIG_SETMASK, &old, NULL);
  return p;
}

int pool_threads(const pool *p) {
  return p == NULL ? 1 : p->helper_count + 1;
}

void pool_free(pool *p) {
  if (p == NULL) return;
  pthread_mutex_lock(&p->lock);
  p->quit = true;
  pthread_cond_broadcast(&p->start);
  pthread_mutex_unlock(&p->lock);
  for (int i = 0; i < p->helper_count; i++)
    pthread_join(p->helpers[i].thread, NULL);
  pthread_cond_destroy(&p->done);
  pthread_cond_destroy(&p->start);
  pthread_mutex_destroy(&p->lock);
}

// Set all helpers to work.
static void begin_round(pool *p, size_t items, pool_work work, void *context) {
  pthread_mutex_lock(&p->lock);
  assert(p->busy == 0);
  p->work = work;
  p->context = context;
  p->items = items;
  atomic_store(&p->next, 0);
  p->busy = p->helper_count;
  p->round++;
  pthread_cond_broadcast(&p->start);
  pthread_mutex_unlock(&p->lock);
}

void pool_run(pool *p, size_t items, pool_work work, void *context) {
  if (p == NULL || p->helper_count == 0 || items <= 1) {
    for (size_t i = 0; i < items; i++)
      work(context, i, 0);
    return;
  }
  begin_round(p, items, work, context);
  drain(p, 0);
  pool_wait(p);
}

// What pool_run_near was called with.
typedef struct near_items {
  pool *owner;
  pool_work work;
  void *context;
} near_items;

// Take an item of a stretch, the last or the first; false when none is left.
static bool take_item(pool_stretch *s, bool last, uint32_t *item) {
  uint64_t left = atomic_load(&s->left), then;
  do {
    uint32_t begin = (uint32_t)left, end = (uint32_t)(left >> 32);
    if (begin >= end) return false;
    *item = last ? end - 1 : begin;
    then = last ? left - (UINT64_C(1) << 32) : left + 1;
  } while (!atomic_compare_exchange_weak(&s->left, &left, then));
  return true;
}

// Whoever comes, whatever the item: its own stretch from the end, then those
// after it from the beginning, so that it helps with the same items every time.
static void run_stretches(void *context, size_t item, int worker) {
  (void)item;
  const near_items *to = context;
  int n = pool_threads(to->owner);
  for (int k = 0; k < n; k++) {
    pool_stretch *s = &to->owner->stretches[(worker + k) % n];
    uint32_t i;
    while (take_item(s, k == 0, &i))
      to->work(to->context, i, worker);
  }
}

void pool_run_near(pool *p, size_t items, pool_work work, void *context) {
  uint64_t n = (uint64_t)pool_threads(p);
  if (n == 1 || items <= 1 || items > UINT32_MAX) {
    pool_run(p, items, work, context);
    return;
  }
  for (uint64_t k = 0; k < n; k++) {
    uint64_t begin = items * k / n, end = items * (k + 1) / n;
    atomic_store(&p->stretches[k].left, end << 32 | begin);
  }
  near_items to = {p, work, context};
  pool_run(p, n, run_stretches, &to);
}

void pool_start(pool *p, size_t items, pool_work work, void *context) {
  if (p->helper_count > 0)
    begin_round(p, items, work, context);
  else
    pool_run(p, items, work, context);
}

bool pool_done(pool *p) {
  pthread_mutex_lock(&p->lock);
  bool done = p->busy == 0;
  pthread_mutex_unlock(&p->lock);
  return done;
}

void pool_cancel(pool *p) {
  atomic_store(&p->next, p->items);
}

void pool_wait(pool *p) {
  linger_for_helpers(p);
  pthread_mutex_lock(&p->lock);
  while (p->busy > 0)
    pthread_cond_wait(&p->done, &p->lock);
  pthread_mutex_unlock(&p->lock);
}
