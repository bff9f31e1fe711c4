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

// What lies below a stack, instead of a child.
#define FLIGHT_END UINT32_MAX

// One ray in flight: number `index` of the stream, `next` the child to visit.
typedef struct flight {
  wide_walk w;
  uint32_t index, next, top;
  uint32_t key[FLIGHT_STACK], child[FLIGHT_STACK];
  uint32_t spare[2];
} flight;

// Numbers of flights that await the same kind of step.
typedef struct flight_list {
  uint32_t count;
  uint32_t at[FLIGHTS];
} flight_list;

// What flights wait for.
typedef struct flight_lists {
  flight_list nodes, leaves, ended;
} flight_lists;

// Take the next child from the stack, ask for its memory and say what it is.
SIMD void flight_next(flight *f, uint32_t id, const wide_tree *t,
                      flight_lists *l, uint32_t next) {
  f->top--;
  uint64_t leaf = next >> 31, end = next == FLIGHT_END;
  uint64_t of_node = (uint64_t)(uintptr_t)(t->nodes + next);
  uint64_t of_leaf =
      (uint64_t)(uintptr_t)(t->triangles + 10 * (size_t)wide_leaf_first(next));
  const char *at =
      (const char *)(uintptr_t)(of_node ^ ((of_node ^ of_leaf) & (0 - leaf)));
  __builtin_prefetch(at);
  __builtin_prefetch(at + 64);
  __builtin_prefetch(at + 128);
  f->next = next;
  l->nodes.at[l->nodes.count] = id;
  l->nodes.count += 1 - (uint32_t)leaf;
  l->leaves.at[l->leaves.count] = id;
  l->leaves.count += (uint32_t)(leaf - end);
  l->ended.at[l->ended.count] = id;
  l->ended.count += (uint32_t)end;
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
