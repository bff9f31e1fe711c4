// pick.c

#include "pick.h"

#include "scalar.h"

#include <string.h>

// Numbers that share an entry of the guide, on average; and numbers that are
// looked at together.
enum { PICK_STRIDE = 4, PICK_WIDE = 8 };

// Behind the last number come some that are never picked.
void pick_new_all(pick *out, size_t count, arena *mem, uint32_t n) {
  size_t wide = (size_t)n + 1 + PICK_WIDE, guides = n / PICK_STRIDE + 2;
  uint32_t *upto = ARENA_NEW(mem, uint32_t, count * (wide + guides));
  uint32_t *guide = upto + count * wide;
  for (size_t k = 0; k < count; k++) {
    out[k] = (pick){upto + k * wide, guide + k * guides, n};
    for (uint32_t i = 1; i <= PICK_WIDE; i++)
      out[k].upto[n + i] = PICK_UNITS;
  }
}

pick pick_new(arena *mem, uint32_t n) {
  pick p;
  pick_new_all(&p, 1, mem, n);
  return p;
}

static uint32_t entries(const pick *p) {
  return p->n / PICK_STRIDE + 1;
}

// The entry of the guide that a unit belongs to, rising with it.
static uint32_t entry_of(const pick *p, uint32_t unit) {
  return (uint32_t)((uint64_t)unit * entries(p) / PICK_UNITS);
}

// The first entry whose units all pick numbers behind one that ends there.
static uint32_t entry_behind(uint32_t upto, uint32_t n) {
  return upto == 0 ? 0 : (uint32_t)((uint64_t)(upto - 1) * n / PICK_UNITS) + 1;
}

// For each entry the number that the first unit of it picks.  Numbers tell
// entries, not the other way round: no branch depends on where they end.
static void make_guide(pick *p) {
  uint32_t n = entries(p), most = 0;
  memset(p->guide, 0, n * sizeof *p->guide);
  for (uint32_t i = 1; i < p->n; i++)
    p->guide[entry_behind(p->upto[i], n)] = i;
  for (uint32_t e = 0; e < n; e++) {
    most = p->guide[e] > most ? p->guide[e] : most;
    p->guide[e] = most;
  }
  p->guide[n] = p->n - 1;
}

void pick_weigh(pick *p, double *weights, double *sum) {
  double below = 0;
  for (uint32_t i = 0; i < p->n; i++)
    weights[i] = below += weights[i];
  *sum = below;
  double scale = below > 0 ? PICK_UNITS / below : 0;
  for (uint32_t i = 0; i < p->n; i++)
    p->upto[i + 1] = (uint32_t)(int32_t)(weights[i] * scale + 0.5);
  make_guide(p);
}

static uint32_t unit_of(float u) {
  return (uint32_t)(u * (float)PICK_UNITS);
}

void pick_expect(const pick *p, float u) {
  __builtin_prefetch(&p->guide[entry_of(p, unit_of(u))]);
}

void pick_search(const pick *p, float u) {
  const uint32_t *first = &p->upto[p->guide[entry_of(p, unit_of(u))] + 1];
  __builtin_prefetch(first);
  __builtin_prefetch(first + PICK_WIDE - 1);
}

// Four numbers in a register.
typedef int32_t four __attribute__((vector_size(16)));

// How many of the next PICK_WIDE numbers end at a unit or before: no branch
// depends on it.
static uint32_t count_ended(const uint32_t *upto, uint32_t unit) {
  four a, b, at = {0};
  at += (int32_t)unit;
  memcpy(&a, upto, sizeof a);
  memcpy(&b, upto + 4, sizeof b);
  four ended = (a <= at) + (b <= at);
  return 0 - (uint32_t)(ended[0] + ended[1] + ended[2] + ended[3]);
}

static uint32_t number_of(const pick *p, uint32_t unit) {
  uint32_t e = entry_of(p, unit), lo = p->guide[e], hi = p->guide[e + 1];
  while (hi - lo > PICK_WIDE) {
    uint32_t middle = (lo + hi) / 2;
    if (p->upto[middle + 1] > unit)
      hi = middle;
    else
      lo = middle + 1;
  }
  uint32_t i = lo + count_ended(p->upto + lo + 1, unit);
  return i < hi ? i : hi;
}

uint32_t pick_unit(const pick *p, double at, float *rest, float *share) {
  uint32_t lo = number_of(p, (uint32_t)at);
  double units = p->upto[lo + 1] - p->upto[lo];
  *rest = float_min((float)((at - p->upto[lo]) / units), FLOAT_BELOW_1);
  *share = (float)(units / PICK_UNITS);
  return lo;
}

uint32_t pick_at(const pick *p, float *u, float *share) {
  return pick_unit(p, (double)*u * PICK_UNITS, u, share);
}

float pick_share(const pick *p, uint32_t i) {
  return (float)(p->upto[i + 1] - p->upto[i]) / (float)PICK_UNITS;
}
