// wide_packet_leaf.h — the rays of a packet and a leaf.

#ifndef WIDE_PACKET_LEAF_H
#define WIDE_PACKET_LEAF_H

#include "wide_leaf.h"

// Ray i has found something.
SIMD void packet_found(packet *p, uint32_t i, bool any) {
  p->until[i] = any ? -1 : p->best[i].t;
  if (any) p->alive &= ~(1u << i);
}

// The triangle of each of eight rays, by its number in the leaf.
typedef struct packet_choice {
  uint32_t of[HALF];
} packet_choice;

// Their corners by axis.
SIMD void choice_corners(f8 out[3][3], const uint32_t *leaf, size_t n,
                         const packet_choice *which) {
  for (size_t i = 0; i < 3; i++)
    for (size_t k = 0; k < 3; k++)
      out[i][k] = f8_choose(leaf_load(leaf, n, i, k), which->of);
}

// The rays m of half h and the triangle of each.
SIMD void packet_settle(packet *p, const uint32_t *leaf, uint32_t n,
                        const packet_choice *which, uint32_t m, int h,
                        bool any) {
  const uint32_t *axis = p->turned;
  f8 at[3][3];
  float u[8], v[8];
  uint32_t first = (uint32_t)(HALF * h);
  leaf_found f;
  choice_corners(at, leaf, n, which);
  leaf_rays r = {{f8_load(p->o[0] + first), f8_load(p->o[1] + first),
                  f8_load(p->o[2] + first)},
                 f8_load(p->sx + first),
                 f8_load(p->sy + first)};
  leaf_shear c;
  leaf_corner(&c, &r, 0, at[0][axis[0]], at[0][axis[1]], at[0][axis[2]]);
  leaf_corner(&c, &r, 1, at[1][axis[0]], at[1][axis[1]], at[1][axis[2]]);
  leaf_corner(&c, &r, 2, at[2][axis[0]], at[2][axis[1]], at[2][axis[2]]);
  leaf_inside(&c);
  const leaf_tests of = {.leaf = leaf, .n = n, .p = p, .h = h, .corner = at};
  leaf_distances(&f, &c, &of, m);
  f8_store(u, f8_div(c.e[1], f8_load(f.det)));
  f8_store(v, f8_div(c.e[2], f8_load(f.det)));
  for (m = f.hits; m != 0; m &= m - 1) {
    uint32_t k = (uint32_t)__builtin_ctz(m);
    hit at_k = {f.t[k], u[k], v[k], leaf[9 * n + which->of[k]]};
    if (any || hit_keep(&p->best[first + k], &at_k))
      packet_found(p, first + k, any);
  }
  for (uint32_t unsure = f.unsure; unsure != 0; unsure &= unsure - 1) {
    uint32_t k = (uint32_t)__builtin_ctz(unsure);
    hit at_k;
    wide_walk w = packet_walk(p, first + k);
    bool close = f.close >> k & 1;
    if (!leaf_one(&w, &of, which->of[k], close, &at_k)) continue;
    if (any || hit_keep(&p->best[first + k], &at_k))
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
  for (uint32_t all = m; all != 0; all &= all - 1) {
    uint32_t i = (uint32_t)__builtin_ctz(all);
    leaf_shear c;
    leaf_rays r = {{f8_all(p->o[0][i]), f8_all(p->o[1][i]), f8_all(p->o[2][i])},
                   f8_all(p->sx[i]),
                   f8_all(p->sy[i])};
    may[i] = leaf_edges(&c, &r, p->turned, leaf, n);
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
      if (half != 0) packet_settle(p, leaf, n, &which[h], half, h, any);
    }
    left &= p->alive;
  }
  p->all_until = packet_most(p->until);
}

#endif
