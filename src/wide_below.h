// wide_below.h — how much of the tree lies below the triangles of a leaf.

#ifndef WIDE_BELOW_H
#define WIDE_BELOW_H

#include "wide_above.h"

// Nodes and leaves that a leaf looks at, at most: a sphere of any number of
// triangles is not looked through for each of them.
enum { PATCH_LOOKS = 128 };

// Children of a node but one wait, if they reach a plane of m that is alive.
APART void meet_node(leaf_planes *p, const wide_node *w, uint32_t but,
                     uint32_t m) {
  f8 side[2][3];
  uint8_t reached[WIDE] = {0};
  uint32_t any = 0;
  for (int i = 0; i < 6; i++)
    side[i % 2][i / 2] =
        f8_mad(f8_of_bytes(w->plane[i / 2][i % 2]), f8_all(w->scale[i / 2]),
               f8_all(w->base[i / 2]));
  for (m &= p->alive; m != 0; m &= m - 1) {
    uint32_t k = (uint32_t)__builtin_ctz(m);
    uint32_t reach = w->valid;
    for (int f = 0; f < FACES && reach != 0; f++) {
      f8 v[3] = {side[p->x[k][f] > 0][0], side[p->y[k][f] > 0][1],
                 side[p->z[k][f] > 0][2]};
      reach &= lanes_reach(p, k, f, v);
    }
    any |= reach;
    for (; reach != 0; reach &= reach - 1)
      reached[__builtin_ctz(reach)] |= (uint8_t)(1u << k);
  }
  for (; any != 0; any &= any - 1) {
    uint32_t i = (uint32_t)__builtin_ctz(any);
    p->child[p->waiting] = w->child[i];
    p->reached[p->waiting] = reached[i];
    p->waiting += w->child[i] != but;
  }
}

// All below a node but what is below one of its children.
APART void meet_below(leaf_planes *p, const wide_tree *t, uint32_t node,
                      uint32_t but) {
  p->waiting = 0;
  meet_node(p, &t->nodes[node], but, 0xff);
  while (p->waiting > 0 && p->alive != 0) {
    uint32_t child = p->child[--p->waiting], m = p->reached[p->waiting];
    if (p->looks++ == PATCH_LOOKS || p->waiting > PATCH_WAITING - WIDE)
      p->alive = 0;
    if (child & WIDE_LEAF_BIT)
      meet_leaf(p, t, child, m);
    else
      meet_node(p, &t->nodes[child], 0, m);
  }
}

// wide_level.patches: level by level up from the leaf, until something is above
// each plane.
static uint32_t kernel_patches(const wide_tree *t, const wide_leaf_place *at,
                               uint32_t *patch) {
  const uint32_t n = wide_leaf_count(at->leaf);
  const uint32_t *leaf = t->triangles + 10 * (size_t)wide_leaf_first(at->leaf);
  uint32_t levels = 0, but = at->leaf;
  leaf_planes p;
  p.unsure = at->unsure;
  p.alive = p.looks = 0;
  for (uint32_t k = 0; k < n; k++)
    set_planes(&p, k,
               (vec3[]){leaf_corner(leaf, n, k, 0), leaf_corner(leaf, n, k, 1),
                        leaf_corner(leaf, n, k, 2)});
  meet_leaf(&p, t, at->leaf, 0xff);
  for (uint32_t k = 0; k < n; k++)
    patch[k] = p.alive >> k & 1 ? at->leaf : 0;
  for (uint32_t node = at->node; node != 0; node = at->parent[node]) {
    meet_below(&p, t, node, but);
    if (p.alive == 0) break;
    for (uint32_t k = 0; k < n; k++)
      if (p.alive >> k & 1) patch[k] = node;
    levels += (uint32_t)__builtin_popcount(p.alive);
    but = node;
  }
  return levels;
}

#endif
