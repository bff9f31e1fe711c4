// wide_steps.h — a step of each of many rays, those of one kind together.

#ifndef WIDE_STEPS_H
#define WIDE_STEPS_H

#include "wide_pending.h"

// Rays that a stream looks at together, at most.
enum { STREAM = 8192 };

// The next rays of a stream, made ready: number index[i] of it begins at child
// from[i] and passes over patch[i]; bit i of `can`: it can hit something.  Of
// `count` rays, those before `next` have taken off.
typedef struct ready_rows {
  float row[ROWS][8][8];
  uint32_t index[8], from[8], patch[8];
  uint32_t can, next, count;
} ready_rows;

// A stream: its rays and those in flight.  One of hits and blocked is NULL.
// Those fly that are in `groups`, each of PACKET rays in a row (the last may
// have fewer), or the lone ones of a crowd.
typedef struct stream {
  const wide_tree *t;
  const ray *rays;
  const uint32_t *left;  // NULL: not known, or no patches
  hit *hits;
  bool *blocked;
  uint32_t count, taken;
  uint32_t groups[STREAM / PACKET];
  const lone_rays *alone;  // NULL: groups
  ready_rows ready;
  pending pending;
  _Alignas(64) flight flights[FLIGHTS];
} stream;

// Steps at nodes, in two loops: what the rays enter, and their stacks.  Each
// is short enough for the processor to have several of its turns under way.
SIMD void stream_nodes(const wide_tree *t, const flight_list *of, bool any) {
  f8 near[FLIGHTS];
  uint32_t mask[FLIGHTS];
  for (uint32_t i = 0; i < of->count; i++) {
    const flight *f = of->at[i];
    const wide_node *n = &t->nodes[f->next];
    mask[i] = cut_node(&f->w, n, &near[i]);
    if (!any) mask[i] &= ~lanes_equal(n->child, f->patch);
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

// Candidate number i, a hit unless `unsure`; h is what single precision knows
// of it.
SIMD void stream_hit(stream *s, uint32_t i, hit *h, bool unsure, bool close,
                     bool any) {
  const pending *q = &s->pending;
  flight *f = &s->flights[q->flight[i]];
  if (unsure) {
    leaf_triangle of = {&q->corner[0][i], PENDING};
    if (!leaf_one(&f->w, &of, close, h)) return;
  }
  h->triangle = q->triangle[i];
  if (any) {
    s->blocked[f->index] = true;
    f->top = 1;
  } else if (hit_keep(&f->w.best, h)) {
    flight_prune(f);
  }
}

// The eight candidates from number i on.
SIMD void stream_settle(stream *s, uint32_t i, bool any) {
  leaf_tests of;
  leaf_shear c;
  leaf_found f;
  uint32_t left = s->pending.count - i, m = left < 8 ? (1u << left) - 1 : 0xff;
  pending_tests(&of, &s->pending, i, s->flights, s->t->large);
  leaf_edges(&c, &of.rays, &of.at);
  leaf_distances(&f, &c, &of, m);
  for (m = f.hits | f.unsure; m != 0; m &= m - 1) {
    uint32_t k = (uint32_t)__builtin_ctz(m);
    hit h = {f.t[k], f.b1[k], f.b2[k], HIT_NONE};
    stream_hit(s, i + k, &h, f.unsure >> k & 1, f.close >> k & 1, any);
  }
}

// Steps at leaves: the edge functions of all, then the rest for what is left.
SIMD void stream_leaves(stream *s, const flight_list *of, bool any) {
  const wide_tree *t = s->t;
  uint32_t count = 0;
  for (uint32_t i = 0; i < of->count; i++) {
    const flight *f = of->at[i];
    uint32_t n = wide_leaf_count(f->next);
    const uint32_t *leaf = t->triangles + 10 * (size_t)wide_leaf_first(f->next);
    leaf_corners at;
    leaf_shear c;
    leaf_rays r = walk_rays(&f->w);
    corners_load(&at, leaf, n, f->w.axis);
    uint32_t m = leaf_edges(&c, &r, &at) & ((1u << n) - 1);
    f8 who = f8_bits((uint32_t)(f - s->flights));
    memcpy(s->pending.flight + count, &who, sizeof who);
    count = pending_add(&s->pending, count, &at, leaf + 9 * n, m);
  }
  s->pending.count = count;
  for (uint32_t i = 0; i < count; i += 8)
    stream_settle(s, i, any);
}

#endif
