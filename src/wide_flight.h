// wide_flight.h — one of many rays under way.

#ifndef WIDE_FLIGHT_H
#define WIDE_FLIGHT_H

#include "wide_leaf.h"
#include "wide_push.h"

// Rays in flight, and the deepest tree that they fly through.  Places of a
// stack: one below all, at most WIDE - 1 a level of the tree, and what
// push_children writes beyond.
enum {
  FLIGHTS = 32,
  FLIGHT_DEPTH = 23,
  FLIGHT_STACK = 1 + (WIDE - 1) * FLIGHT_DEPTH + WIDE
};

// The lowest place of a stack holds this instead of a child.
#define FLIGHT_END UINT32_MAX

// One ray in flight: number `index` of the stream, `next` the child to visit.
// An odd number of lines of the cache, so that flights do not compete for the
// same ones.
typedef struct flight {
  wide_walk w;
  uint32_t index, next, top;
  uint32_t key[FLIGHT_STACK], child[FLIGHT_STACK];
  uint32_t patch;  // the child to pass over; 0: none
  uint32_t spare[22];
} flight;

_Static_assert(sizeof(flight) % 128 == 64, "an odd number of lines");

// How many rays of crowds may wait to go alone (wide_crowd.h).
enum { LONELY = 4096 };

// Rays of a stream that go alone, each from a child of its own.
typedef struct lone_rays {
  uint32_t count, ray[LONELY], child[LONELY];
} lone_rays;

// Flights that await the same kind of step.
typedef struct flight_list {
  uint32_t count;
  flight *at[FLIGHTS];
} flight_list;

// What flights wait for.
typedef struct flight_lists {
  flight_list nodes, leaves, ended;
} flight_lists;

// Where a child is.  By arithmetic: there is nothing for the processor to
// guess, as it would half of the time in vain.
SIMD const char *child_place(const wide_tree *t, uint32_t child) {
  uintptr_t leaf = 0 - (uintptr_t)(child >> 31);
  uintptr_t a = (uintptr_t)(t->nodes + child);
  uintptr_t b = (uintptr_t)(t->triangles + 10 * (size_t)wide_leaf_first(child));
  return (const char *)((a & ~leaf) | (b & leaf));
}

// Take the next child from the stack of each flight, ask for its memory and
// append the flight to the list of those that await the same.
SIMD void flights_next(const flight_list *of, const wide_tree *t,
                       flight_lists *l) {
  uint32_t nodes = l->nodes.count, leaves = l->leaves.count;
  uint32_t ended = l->ended.count;
  for (uint32_t i = 0; i < of->count; i++) {
    flight *f = of->at[i];
    uint32_t next = f->child[--f->top];
    uint32_t leaf = next >> 31, end = next == FLIGHT_END;
    const char *at = child_place(t, next);
    __builtin_prefetch(at);
    __builtin_prefetch(at + 64);
    f->next = next;
    l->nodes.at[nodes] = f;
    nodes += leaf ^ 1;
    l->leaves.at[leaves] = f;
    leaves += leaf - end;
    l->ended.at[ended] = f;
    ended += end;
  }
  l->nodes.count = nodes;
  l->leaves.count = leaves;
  l->ended.count = ended;
}

// Ask for what flights_next did not: the rest of leaves.
SIMD void flights_expect(const flight_list *of, const wide_tree *t) {
  for (uint32_t i = 0; i < of->count; i++) {
    const char *at = child_place(t, of->at[i]->next);
    __builtin_prefetch(at + 128);
    __builtin_prefetch(at + 192);
  }
}

// Forget what the ray enters behind its new best hit.
SIMD void flight_prune(flight *f) {
  uint32_t kept = 1;
  for (uint32_t i = 1; i < f->top; i++) {
    f->key[kept] = f->key[i];
    f->child[kept] = f->child[i];
    kept += key_near(f->key[i]) <= f->w.best.t;
  }
  f->top = kept;
}

#endif
