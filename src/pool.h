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

#endif
