// wide_together.h — all rays of a stream that stop at any hit.

#ifndef WIDE_TOGETHER_H
#define WIDE_TOGETHER_H

#include "wide_crowd_leaf.h"
#include "wide_crowd_ready.h"
#include "wide_part.h"

// Take lists from the end of those that wait, as long as what comes of them
// finds room; one that is too long for what room there is goes alone.
SIMD void crowd_take(crowd *q, uint32_t first) {
  crowd_lists *from = &q->nodes, *to = &q->now;
  to->count = to->used = 0;
  while (from->count > first) {
    const crowd_part *p = &from->part[from->count - 1];
    uint32_t room = (WAITING - p->first) / WIDE;
    if (room > CROWD) room = CROWD;
    if (to->used + p->count > room) break;
    to->part[to->count++] = (crowd_part){p->child, to->used, p->count};
    memcpy(to->ray + to->used, from->ray + p->first,
           p->count * sizeof(uint32_t));
    to->used += p->count;
    from->used = p->first;
    from->count--;
  }
  if (to->count > 0) return;
  crowd_part p = from->part[--from->count];
  from->used = p.first;
  for (uint32_t i = 0; i < p.count; i++)
    crowd_leave(q, from->ray[p.first + i], p.child);
}

// A crowd down the tree.  The lists of children of lists that were taken
// together are a layer, which is taken before the rest of the one above.  Never
// inlined: alone it has more registers.
APART void crowd_trace(crowd *q) {
  uint32_t layer[FLIGHT_DEPTH + 2], depth = 0;
  crowd_start(q);
  layer[0] = 0;
  while (q->nodes.count > 0) {
    while (q->nodes.count == layer[depth])
      depth--;
    crowd_take(q, layer[depth]);
    layer[++depth] = q->nodes.count;
    q->leaves.count = q->leaves.used = 0;
    for (uint32_t i = 0; i < q->now.count; i++)
      crowd_node(q, &q->now.part[i]);
    for (uint32_t i = 0; i < q->leaves.count; i++)
      crowd_leaf(q, &q->leaves.part[i]);
    crowd_settle(q);
  }
}

// Whether most rays begin where the next one does: a look at some, in steps
// that are no multiple of how many rays a point may have.
SIMD bool crowd_likely(const ray *rays, size_t n) {
  enum { LOOKS = 32 };
  uint32_t same = 0;
  for (size_t i = 0; i < LOOKS && n > LOOKS; i++) {
    const ray *r = &rays[i * UINT64_C(0x9e3779b1) % (n - 1)];
    same += memcmp(&r[0].o, &r[1].o, sizeof r->o) == 0;
  }
  return same > LOOKS / 2;
}

// All n rays, CROWD at a time.  Never inlined: a crowd is large, and who asks
// for none need not have it on the stack.
APART void crowds_run(stream *s, uint32_t n) {
  crowd q;
  q.s = s;
  q.alone.count = 0;
  s->alone = &q.alone;
  pending_clear(&s->pending);
  pending_clear(&q.pending);
  for (q.first = 0; q.first < n; q.first += CROWD) {
    q.count = n - q.first < CROWD ? n - q.first : CROWD;
    crowd_trace(&q);
  }
  crowd_alone(&q);
}

#endif
