// stress.h — one table of what was tried hard, how often, and what broke.

#ifndef STRESS_H
#define STRESS_H

#include "pool.h"
#include "vec.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

// How much to try: a slice for the tests, minutes, or as long as it takes.
typedef enum stress_size { STRESS_SHORT, STRESS_FULL, STRESS_LONG } stress_size;

// One line.  It is right when nothing is wrong and worst <= allowed.
typedef struct stress_row {
  const char *what;
  double tried;
  double wrong;
  double worst, allowed;  // both NO_LIMIT where only wrong counts
  const char *elsewhere;  // the best figure that others publish, or measured
} stress_row;

typedef struct stress {
  stress_size size;
  uint64_t slice;  // another one, other random numbers
  pool *threads;
  int failed;  // rows
} stress;

#define NO_LIMIT ((double)NAN)

// Print a row of the table.
void stress_print(stress *s, stress_row r);

// One of the three numbers, by size.
static inline size_t stress_count(const stress *s, double few, double many,
                                  double most) {
  return (size_t)(s->size == STRESS_SHORT  ? few
                  : s->size == STRESS_FULL ? many
                                           : most);
}

// What prints rows, by name.
void stress_watertight(stress *s);
void stress_geometry(stress *s);
void stress_scatter(stress *s);
void stress_light(stress *s);
void stress_pictures(stress *s);
void stress_twice(stress *s);

#endif
