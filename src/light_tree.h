// light_tree.h — one of many small lights, with a probability near its share
// of the light at a place.

#ifndef LIGHT_TREE_H
#define LIGHT_TREE_H

#include "arena.h"
#include "light_bound.h"

// The most emitters of a leaf.
enum { LIGHT_LEAF = 4 };

typedef struct light_node {
  light_group group;
  uint32_t first;  // of two children side by side, or of count emitters
  uint32_t count;  // 0: not a leaf
  uint32_t parent;
} light_node;

// The root is node 0.  Source: Conty Estevez and Kulla 2018, "Importance
// Sampling of Many Lights with Adaptive Tree Splitting".
typedef struct light_tree {
  light_emitter *emitters;  // in the order of the leaves
  uint32_t *leaf_of;        // by emitter: its node
  light_node *nodes;
  uint32_t count;  // emitters
} light_tree;

void light_tree_build(light_tree *out, const light_emitter *emitters,
                      uint32_t count, arena *mem);

// About how much light all of them together may bring to a place.
float light_tree_bound(const light_tree *t, const light_place *at);

// An emitter by a uniform number, with its probability; false when there is
// none to be seen.
bool light_tree_pick(const light_tree *t, const light_place *at, double u,
                     uint32_t *emitter, float *share);

// The probability of that emitter.
float light_tree_share(const light_tree *t, const light_place *at,
                       uint32_t emitter);

#endif
