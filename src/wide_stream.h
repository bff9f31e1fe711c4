// wide_stream.h — many rays at once, each a step at a time.
//
// While one ray waits for its next node to come from memory, the others do
// their steps.  Steps of one kind are done together, ray after ray: what comes
// next is read from lists, and the processor need not guess.

#ifndef WIDE_STREAM_H
#define WIDE_STREAM_H

#include "wide_flight.h"

// A stream: its rays and those in flight.  One of hits and blocked is NULL.
typedef struct stream {
  const wide_tree *t;
  const ray *rays;
  hit *hits;
  bool *blocked;
  size_t count, taken;
  flight flights[FLIGHTS];
} stream;

// Steps at nodes, in two loops: what the rays enter, and what comes next.  Each
// is short enough for the processor to have several of its turns under way.
SIMD void stream_nodes(stream *s, const flight_list *at, flight_lists *l) {
  const wide_tree *t = s->t;
  f8 near[FLIGHTS];
  uint32_t mask[FLIGHTS];
  for (uint32_t i = 0; i < at->count; i++) {
    const flight *f = &s->flights[at->at[i]];
    mask[i] = cut_node(&f->w, &t->nodes[f->next], &near[i]);
  }
  for (uint32_t i = 0; i < at->count; i++) {
    uint32_t id = at->at[i], next;
    flight *f = &s->flights[id];
    f->top += push_children(f->key + f->top, f->child + f->top,
                            &t->nodes[f->next], mask[i], near[i], &next);
    flight_next(f, id, t, l, next);
  }
}

// What a leaf's candidates did to a ray.
SIMD void flight_settle(stream *s, flight *f, uint32_t m, bool any) {
  uint32_t n = wide_leaf_count(f->next);
  const uint32_t *leaf =
      s->t->triangles + 10 * (size_t)wide_leaf_first(f->next);
  leaf_shear c;
  leaf_edges(&c, &f->w, leaf, n);
  if (!leaf_settle(&f->w, &c, leaf, n, m, any)) return;
  if (any) {
    s->blocked[f->index] = true;
    f->top = 1;
  } else {
    flight_prune(f);
  }
}

// Steps at leaves: the edge functions of all, then the rest for those where a
// triangle is left, then what comes next.
SIMD void stream_leaves(stream *s, const flight_list *at, flight_lists *l,
                        bool any) {
  const wide_tree *t = s->t;
  uint32_t id[FLIGHTS], mask[FLIGHTS], count = 0;
  for (uint32_t i = 0; i < at->count; i++) {
    const flight *f = &s->flights[at->at[i]];
    leaf_shear c;
    id[count] = at->at[i];
    mask[count] = leaf_edges(
        &c, &f->w, t->triangles + 10 * (size_t)wide_leaf_first(f->next),
        wide_leaf_count(f->next));
    count += mask[count] != 0;
  }
  for (uint32_t i = 0; i < count; i++)
    flight_settle(s, &s->flights[id[i]], mask[i], any);
  for (uint32_t i = 0; i < at->count; i++) {
    flight *f = &s->flights[at->at[i]];
    flight_next(f, at->at[i], t, l, f->child[f->top - 1]);
  }
}

// Give a flight the next ray of the stream that can hit something; false when
// there is none.
SIMD bool flight_start(stream *s, uint32_t id, flight_lists *l, bool any) {
  flight *f = &s->flights[id];
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
    f->child[1] = 0;
    f->top = 2;
    flight_next(f, id, s->t, l, 0);
    return true;
  }
  return false;
}

SIMD void stream_trace(stream *s, bool any) {
  flight_lists now, next;
  now.nodes.count = now.leaves.count = now.ended.count = 0;
  for (uint32_t id = 0; id < FLIGHTS; id++)
    if (!flight_start(s, id, &now, any)) break;
  while (now.nodes.count + now.leaves.count + now.ended.count > 0) {
    next.nodes.count = next.leaves.count = next.ended.count = 0;
    stream_nodes(s, &now.nodes, &next);
    stream_leaves(s, &now.leaves, &next, any);
    for (uint32_t i = 0; i < now.ended.count; i++) {
      const flight *f = &s->flights[now.ended.at[i]];
      if (!any) s->hits[f->index] = f->w.best;
      flight_start(s, now.ended.at[i], &next, any);
    }
    now = next;
  }
}

#endif
