// pick.h — one of many, with given probabilities, by one uniform number.

#ifndef PICK_H
#define PICK_H

#include "arena.h"

#include <stdint.h>

// Probabilities in units of 2^-24, the distance of the uniform numbers of
// rng.h: so each is exactly the share of numbers that pick it.
enum { PICK_UNITS = 1 << 24 };

// Number i is picked by the units from upto[i] to upto[i + 1].  guide cuts the
// search short: the first number to look at, by quarters of n.
typedef struct pick {
  uint32_t *upto, *guide;
  uint32_t n;
} pick;

// Room for n <= PICK_UNITS numbers; and that of `count` tables, next to each
// other in memory.
pick pick_new(arena *mem, uint32_t n);
void pick_new_all(pick *out, size_t count, arena *mem, uint32_t n);

// Probabilities in proportion to n weights >= 0, rounded.  Of the weights
// become sums: each with all before it.  *sum is that of all; where it is 0
// nothing must be picked.
void pick_weigh(pick *p, double *weights, double *sum);

// The number that u in [0, 1) picks, of probability *share > 0; *u becomes
// where in its share u was, again in [0, 1).
uint32_t pick_at(const pick *p, float *u, float *share);

// What u = unit / PICK_UNITS picks, where units may be parted further than u
// is; *rest is where in its share it was.
uint32_t pick_unit(const pick *p, double unit, float *rest, float *share);

// pick_at in three steps, each of which lets memory come nearer for the next:
// pick_expect(p, u), pick_search(p, u), pick_at(p, &u, &share).
void pick_expect(const pick *p, float u);
void pick_search(const pick *p, float u);

// The probability of number i.
float pick_share(const pick *p, uint32_t i);

#endif
