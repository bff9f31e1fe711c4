// clock.h — how long things take.

#ifndef CLOCK_H
#define CLOCK_H

#include <time.h>

// Seconds since some moment in the past; never runs backwards.
static inline double clock_seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// Seconds that processors have worked for this process, over all threads: what
// else the machine does hardly counts.
static inline double clock_work(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

#endif
