// pool.h — work shared by threads.  The only module that knows pthreads.

#ifndef POOL_H
#define POOL_H

#include "arena.h"

typedef struct pool pool;

// One item of work.  Items run in any order, on any worker 0..n-1; each owns
// its output, so that results never depend on the number of threads.
typedef void (*pool_work)(void *context, size_t item, int worker);

// The threads this process may use: the least of CPU affinity, the cgroup's
// quota rounded down, and SLURM_CPUS_PER_TASK; at least 1.
int pool_default_threads(void);

// A pool of 1..1024 workers, of which the caller of pool_run is worker 0.
// Fewer when the system refuses threads.
pool *pool_new(arena *mem, int threads);
int pool_threads(const pool *p);
void pool_free(pool *p);

// Run work(context, i, worker) for every i in 0..items-1 and return when all
// are done.  Not to be called from inside work.  p may be NULL: this thread
// alone.
void pool_run(pool *p, size_t items, pool_work work, void *context);

// The same, but each worker begins with a stretch of items of its own, the same
// in every call for as many, and helps out elsewhere only when it has done
// them: for items whose neighbours share lines of the cache or large pages, and
// calls that come back to what an earlier one wrote.
void pool_run_near(pool *p, size_t items, pool_work work, void *context);

// pool_run without waiting: workers 1 and up do it while the caller goes on.
// A pool of one does it all before it returns.  Nothing else may be started
// until pool_done has said true or pool_wait has returned.
void pool_start(pool *p, size_t items, pool_work work, void *context);

// Whether what was started has ended; its results are then seen by the caller.
bool pool_done(pool *p);

// Let no worker take another item of what was started.
void pool_cancel(pool *p);

// Wait until what was started has ended.
void pool_wait(pool *p);

#endif
