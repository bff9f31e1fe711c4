// wide_stream.h — many rays at once, each a step at a time.
//
// While one ray waits for its next node to come from memory, the others do
// their steps.  Steps of one kind are done together, ray after ray: what comes
// next is read from lists, and the processor need not guess.

#ifndef WIDE_STREAM_H
#define WIDE_STREAM_H

#include "wide_steps.h"

// Give a flight the next ray of the stream that can hit something; false when
// there is none.
SIMD bool flight_start(stream *s, flight *f, bool any) {
  while (s->taken < s->count) {
    size_t i = s->taken++;
    bool can = walk_start(&f->w, s->t, &s->rays[i]);
    if (any)
      s->blocked[i] = false;
    else
      s->hits[i] = (hit){.t = s->rays[i].tmax, .triangle = HIT_NONE};
    if (!can) continue;
    f->index = (uint32_t)i;
    f->child[0] = FLIGHT_END;
    f->next = 0;
    f->top = 1;
    return true;
  }
  return false;
}

// Rays that have ended make room for others, which begin at the root.
SIMD void stream_refill(stream *s, const flight_list *ended, flight_list *nodes,
                        bool any) {
  for (uint32_t i = 0; i < ended->count; i++) {
    flight *f = ended->at[i];
    if (!any) s->hits[f->index] = f->w.best;
    nodes->at[nodes->count] = f;
    nodes->count += flight_start(s, f, any);
  }
}

SIMD void stream_trace(stream *s, bool any) {
  flight_lists lists[2], *now = &lists[0], *next = &lists[1];
  now->nodes.count = now->leaves.count = now->ended.count = 0;
  for (uint32_t k = 0; k < FLIGHTS; k++) {
    now->nodes.at[now->nodes.count] = &s->flights[k];
    now->nodes.count += flight_start(s, &s->flights[k], any);
  }
  while (now->nodes.count + now->leaves.count > 0) {
    next->nodes.count = next->leaves.count = next->ended.count = 0;
    stream_expect(s->t, &now->leaves);
    stream_nodes(s->t, &now->nodes, any);
    stream_leaves(s, &now->leaves, any);
    flights_next(&now->nodes, s->t, next);
    flights_next(&now->leaves, s->t, next);
    stream_refill(s, &next->ended, &next->nodes, any);
    flight_lists *other = now;
    now = next;
    next = other;
  }
}

#endif
