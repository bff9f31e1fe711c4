// wide_stream.h — many rays at once, each a step at a time.
//
// While one ray waits for its next node to come from memory, the others do
// their steps.  Steps of one kind are done together, ray after ray: what comes
// next is read from lists, and the processor need not guess.

#ifndef WIDE_STREAM_H
#define WIDE_STREAM_H

#include "wide_descent.h"
#include "wide_gather.h"
#include "wide_start.h"

SIMD void stream_trace(stream *s, bool any) {
  flight_lists lists[2], *now = &lists[0], *next = &lists[1];
  now->nodes.count = now->leaves.count = now->ended.count = 0;
  for (uint32_t k = 0; k < FLIGHTS; k++) {
    now->nodes.at[now->nodes.count] = &s->flights[k];
    now->nodes.count += flight_start(s, &s->flights[k], any);
  }
  while (now->nodes.count + now->leaves.count > 0) {
    next->nodes.count = next->leaves.count = next->ended.count = 0;
    flights_expect(&now->leaves, s->t);
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

// Trace rays first..first+n-1 if they are a packet.
SIMD bool stream_packet(stream *s, packet *p, uint32_t first, bool any) {
  if (!packet_start(p, s->t, s->rays + first)) return false;
  packet_trace(p, s->t, any);
  for (uint32_t i = 0; i < PACKET; i++) {
    if (any)
      s->blocked[first + i] = (p->alive >> i & 1) == 0;
    else
      s->hits[first + i] = p->best[i];
  }
  return true;
}

// All n rays, STREAM at a time: packets first, then the others.
SIMD void stream_run(stream *s, size_t n, bool any) {
  packet p;
  pending_clear(&s->pending);
  s->alone = NULL;
  while (n > 0) {
    uint32_t size = n < STREAM ? (uint32_t)n : STREAM, groups = 0;
    s->count = 0;
    if (any) memset(s->blocked, 0, size * sizeof(bool));
    for (uint32_t i = 0; i < size; i += PACKET) {
      bool whole = size - i >= PACKET;
      if (whole && stream_packet(s, &p, i, any)) continue;
      s->groups[groups++] = i / PACKET;
      s->count += whole ? PACKET : size - i;
    }
    s->taken = s->ready.next = s->ready.count = 0;
    stream_trace(s, any);
    n -= size;
    s->rays += size;
    if (s->left != NULL) s->left += size;
    if (any)
      s->blocked += size;
    else
      s->hits += size;
  }
}

#endif
