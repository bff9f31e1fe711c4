// wide_descent.h — a packet down the wide tree.
//
// It enters what the interval of its rays enters, nearest first.  Of what
// comes from the stack every ray is asked: what none enters is left.

#ifndef WIDE_DESCENT_H
#define WIDE_DESCENT_H

#include "wide_interval.h"
#include "wide_packet_leaf.h"
#include "wide_push.h"
#include "wide_single.h"

// What is left to visit: keys as push_children has them, and which child of
// which node, 8 numbers a node.
typedef struct packet_stack {
  uint32_t count;
  uint32_t key[WIDE_STACK + WIDE], child[WIDE_STACK + WIDE];
} packet_stack;

// Visit a node: what the packet may enter goes on the stack.
SIMD void packet_enter(packet_stack *s, const packet *p, const wide_tree *t,
                       uint32_t node) {
  const wide_node *n = &t->nodes[node];
  uint32_t number[WIDE];
  f8 near;
  uint32_t m = packet_cut_node(p, n, &near);
  for (uint32_t i = 0; i < WIDE; i++)
    number[i] = WIDE * node + i;
  s->count +=
      push_children(s->key + s->count, s->child + s->count, number, m, near);
}

// Down to every leaf that a ray enters before its best hit.
SIMD void packet_trace(packet *p, const wide_tree *t, bool any) {
  packet_stack s;
  s.count = 0;
  packet_enter(&s, p, t, 0);
  while (s.count > 0 && p->alive != 0) {
    s.count--;
    if (key_near(s.key[s.count]) > p->all_until) continue;
    const wide_node *n = &t->nodes[s.child[s.count] / WIDE];
    uint32_t i = s.child[s.count] % WIDE, child = n->child[i];
    uint32_t m = packet_cut_child(p, n, i);
    if (m == 0) continue;
    if (child & WIDE_LEAF_BIT)
      packet_leaf(p, t, child, m, any);
    else
      packet_enter(&s, p, t, child);
  }
}

#endif
