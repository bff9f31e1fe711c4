// wide_packet_leaf.h — the rays of a packet and a leaf.

#ifndef WIDE_PACKET_LEAF_H
#define WIDE_PACKET_LEAF_H

#include "wide_leaf.h"

// Ray i has found something; with `any` that is all it asked.
SIMD void packet_found(packet *p, uint32_t i, bool any) {
  p->until[i] = any ? -1 : p->best[i].t;
  if (any) p->alive &= ~(1u << i);
}

// The triangle of each of eight rays, by its number in the leaf.
typedef struct packet_choice {
  uint32_t of[HALF];
} packet_choice;

// Corner i of each, axes turned; those of the leaf are in `all`.
SIMD void choice_corner(leaf_corners *out, const leaf_corners *all,
                        const packet_choice *which, int i) {
  out->of[3 * i] = f8_choose(all->of[3 * i], which->of);
  out->of[3 * i + 1] = f8_choose(all->of[3 * i + 1], which->of);
  out->of[3 * i + 2] = f8_choose(all->of[3 * i + 2], which->of);
}

// The rays m of half h and the triangle of each, by number in the leaf's list.
SIMD void packet_settle(packet *p, leaf_tests *of, const uint32_t *list,
                        const packet_choice *which, uint32_t m, int h,
                        bool any) {
  leaf_shear c;
  leaf_found f;
  uint32_t first = (uint32_t)(HALF * h);
  tests_of_packet(of, p, h);
  leaf_edges(&c, &of->rays, &of->at);
  leaf_distances(&f, &c, of, m);
  for (m = f.hits | f.unsure; m != 0; m &= m - 1) {
    uint32_t k = (uint32_t)__builtin_ctz(m);
    hit at = {f.t[k], f.b1[k], f.b2[k], list[which->of[k]]};
    if ((f.unsure >> k & 1) != 0) {
      wide_walk w = packet_walk(p, first + k);
      if (!tests_one(of, &w, k, f.close >> k & 1, &at)) continue;
    }
    if (any || hit_keep(&p->best[first + k], &at))
      packet_found(p, first + k, any);
  }
}

// The rays m at a leaf: the edge functions ray by ray, then what is left, a
// triangle of each ray at a time.
SIMD void packet_leaf(packet *p, const wide_tree *t, uint32_t child, uint32_t m,
                      bool any) {
  uint32_t n = wide_leaf_count(child), left = 0;
  const uint32_t *leaf = t->triangles + 10 * (size_t)wide_leaf_first(child);
  uint32_t may[PACKET];
  leaf_corners at;
  corners_load(&at, leaf, n, p->turned);
  for (uint32_t all = m; all != 0; all &= all - 1) {
    uint32_t i = (uint32_t)__builtin_ctz(all);
    leaf_shear c;
    leaf_rays r = {{f8_all(p->o[0][i]), f8_all(p->o[1][i]), f8_all(p->o[2][i])},
                   f8_all(p->sx[i]),
                   f8_all(p->sy[i])};
    may[i] = leaf_edges(&c, &r, &at) & ((1u << n) - 1);
    left |= (uint32_t)(may[i] != 0) << i;
  }
  while (left != 0) {
    packet_choice which[2] = {0};
    uint32_t now = left;
    for (uint32_t all = now; all != 0; all &= all - 1) {
      uint32_t i = (uint32_t)__builtin_ctz(all);
      which[i / HALF].of[i % HALF] = (uint32_t)__builtin_ctz(may[i]);
      may[i] &= may[i] - 1;
      left &= ~((uint32_t)(may[i] == 0) << i);
    }
    for (int h = 0; h < 2; h++) {
      uint32_t half = now >> HALF * h & 0xff;
      if (half == 0) continue;
      leaf_tests of;
      choice_corner(&of.at, &at, &which[h], 0);
      choice_corner(&of.at, &at, &which[h], 1);
      choice_corner(&of.at, &at, &which[h], 2);
      packet_settle(p, &of, leaf + 9 * n, &which[h], half, h, any);
    }
    left &= p->alive;
  }
  p->all_until = packet_most(p->until);
}

#endif
