// wide_part.h — a crowd at a node parts by children.

#ifndef WIDE_PART_H
#define WIDE_PART_H

#include "wide_crowd.h"

// The lower and the upper planes of eight boxes.
typedef struct node_planes {
  f8 lower[3], upper[3];
} node_planes;

SIMD void planes_axis(node_planes *p, const wide_node *n, int k) {
  f8 base = f8_all(n->base[k]), scale = f8_all(n->scale[k]);
  p->lower[k] = f8_mad(f8_of_bytes(n->plane[k][0]), scale, base);
  p->upper[k] = f8_mad(f8_of_bytes(n->plane[k][1]), scale, base);
}

// cut_axis for a ray that may run either way along the axis.
SIMD void planes_cut_axis(f8 *near, f8 *far, const node_planes *p,
                          const crowd_ray *r, int k) {
  f8 inv = f8_all(r->inv[k]);
  f8 a = f8_mul(f8_sub(p->lower[k], f8_all(r->up[k])), inv);
  f8 b = f8_mul(f8_sub(p->upper[k], f8_all(r->down[k])), inv);
  *near = f8_max(f8_min(a, b), *near);
  *far = f8_min(f8_max(a, b), *far);
}

// Which boxes the ray enters.
SIMD uint32_t planes_cut(const node_planes *p, const crowd_ray *r) {
  f8 near = f8_all(r->begin), far = f8_all(r->until);
  planes_cut_axis(&near, &far, p, r, 0);
  planes_cut_axis(&near, &far, p, r, 1);
  planes_cut_axis(&near, &far, p, r, 2);
  return f8_le(near, far);
}

// Bit k: bit c of byte k.
SIMD uint32_t bytes_column(uint64_t bytes, uint32_t c) {
  uint64_t bits = bytes >> c & UINT64_C(0x0101010101010101);
  return (uint32_t)(bits * UINT64_C(0x0102040810204080) >> 56);
}

// The list of those of n rays that enter child c, and its length; mask[k] says
// which children ray k enters.  Reads and writes up to 7 beyond.
SIMD uint32_t part_list(uint32_t *to, const uint32_t *from, const uint8_t *mask,
                        uint32_t n, uint32_t c) {
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i += 8) {
    uint64_t bytes;
    memcpy(&bytes, mask + i, sizeof bytes);
    uint32_t m = bytes_column(bytes, c);
    f8 v = f8_load((const float *)(const void *)(from + i));
    f8_squeeze(to + count, v, f8_lanes_of(m));
    count += (uint32_t)__builtin_popcount(m);
  }
  return count;
}

// The rays of a part enter the children of its node.
SIMD void crowd_node(crowd *q, const crowd_part *at) {
  const wide_tree *t = q->s->t;
  const wide_node *n = &t->nodes[at->child];
  const uint32_t *who = q->now.ray + at->first;
  uint8_t mask[CROWD + 8];
  uint32_t all = 0;
  node_planes p;
  planes_axis(&p, n, 0);
  planes_axis(&p, n, 1);
  planes_axis(&p, n, 2);
  for (uint32_t i = 0; i < at->count; i++) {
    uint32_t m = planes_cut(&p, &q->at_node[who[i]]) & n->valid;
    mask[i] = (uint8_t)m;
    all |= m;
  }
  memset(mask + at->count, 0, 8);
  for (; all != 0; all &= all - 1) {
    uint32_t c = (uint32_t)__builtin_ctz(all), child = n->child[c];
    bool leaf = (child & WIDE_LEAF_BIT) != 0;
    crowd_lists *to = leaf ? &q->leaves : &q->nodes;
    crowd_part *part = &to->part[to->count];
    const char *memory = child_place(t, child);
    __builtin_prefetch(memory);
    __builtin_prefetch(memory + 64);
    if (leaf) __builtin_prefetch(memory + 128);
    if (leaf) __builtin_prefetch(memory + 192);
    *part = (crowd_part){child, to->used, 0};
    part->count = part_list(to->ray + to->used, who, mask, at->count, c);
    if (!leaf && part->count < TOGETHER) {
      for (uint32_t i = 0; i < part->count; i++)
        crowd_leave(q, to->ray[part->first + i], child);
      continue;
    }
    to->used += part->count;
    to->count++;
  }
}

#endif
