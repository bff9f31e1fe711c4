// wide_steps.h — a step of each of many rays, those of one kind together.

#ifndef WIDE_STEPS_H
#define WIDE_STEPS_H

#include "wide_flight.h"
#include "wide_packet.h"

// Rays that a stream looks at together, at most.
enum { STREAM = 8192 };

// A stream: its rays and those in flight.  One of hits and blocked is NULL.
// Of the rays those fly that are in `groups` of PACKET rays, of which the last
// may be shorter.
typedef struct stream {
  const wide_tree *t;
  const ray *rays;
  hit *hits;
  bool *blocked;
  uint32_t count, taken;
  uint32_t groups[STREAM / PACKET];
  _Alignas(64) flight flights[FLIGHTS];
} stream;

// Steps at nodes, in two loops: what the rays enter, and their stacks.  Each
// is short enough for the processor to have several of its turns under way.
SIMD void stream_nodes(const wide_tree *t, const flight_list *of, bool any) {
  f8 near[FLIGHTS];
  uint32_t mask[FLIGHTS];
  for (uint32_t i = 0; i < of->count; i++) {
    const flight *f = of->at[i];
    mask[i] = cut_node(&f->w, &t->nodes[f->next], &near[i]);
  }
  for (uint32_t i = 0; i < of->count; i++) {
    flight *f = of->at[i];
    const wide_node *n = &t->nodes[f->next];
    uint32_t *child = f->child + f->top;
    f->top +=
        any ? push_unsorted(child, n, mask[i])
            : push_children(f->key + f->top, child, n->child, mask[i], near[i]);
  }
}

// What a leaf's candidates m do to a ray; c is theirs from leaf_edges.
SIMD void flight_settle(stream *s, flight *f, leaf_shear *c, uint32_t m,
                        bool any) {
  uint32_t n = wide_leaf_count(f->next);
  const uint32_t *leaf =
      s->t->triangles + 10 * (size_t)wide_leaf_first(f->next);
  if (!leaf_settle(&f->w, c, leaf, n, m, any)) return;
  if (any) {
    s->blocked[f->index] = true;
    f->top = 1;
  } else {
    flight_prune(f);
  }
}

// Steps at leaves: the edge functions of all, then the rest for those where a
// triangle is left.
SIMD void stream_leaves(stream *s, const flight_list *of, bool any) {
  const wide_tree *t = s->t;
  flight *at[FLIGHTS];
  uint32_t mask[FLIGHTS], count = 0;
  leaf_shear c[FLIGHTS];
  for (uint32_t i = 0; i < of->count; i++) {
    flight *f = of->at[i];
    at[count] = f;
    leaf_rays r = walk_rays(&f->w);
    mask[count] =
        leaf_edges(&c[count], &r, f->w.axis,
                   t->triangles + 10 * (size_t)wide_leaf_first(f->next),
                   wide_leaf_count(f->next));
    count += mask[count] != 0;
  }
  for (uint32_t i = 0; i < count; i++)
    flight_settle(s, at[i], &c[i], mask[i], any);
}

// Ask for what flights_next did not: the rest of leaves.
SIMD void stream_expect(const wide_tree *t, const flight_list *of) {
  for (uint32_t i = 0; i < of->count; i++) {
    const char *at = child_place(t, of->at[i]->next);
    __builtin_prefetch(at + 128);
    __builtin_prefetch(at + 192);
  }
}

#endif
