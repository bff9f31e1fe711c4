// light_tree.c — going down, each child is as likely as it is important.

#include "light_tree.h"

// The bounds of the emitters of a leaf, and their sum.
static float leaf_bounds(const light_tree *t, const light_node *leaf,
                         const light_place *at, float each[LIGHT_LEAF]) {
  float sum = 0;
  for (uint32_t i = 0; i < leaf->count; i++) {
    each[i] = light_bound_emitter(&t->emitters[leaf->first + i], at);
    sum += each[i];
  }
  return sum;
}

// The bound of any node; leaves know better than their group, and fill each.
static float node_bound(const light_tree *t, const light_node *k,
                        const light_place *at, float each[LIGHT_LEAF]) {
  if (k->count == 0) return light_bound_group(&k->group, at);
  return leaf_bounds(t, k, at, each);
}

float light_tree_bound(const light_tree *t, const light_place *at) {
  if (t->count == 0) return 0;
  float each[LIGHT_LEAF];
  const light_node *root = &t->nodes[0];
  if (root->count > 0) return leaf_bounds(t, root, at, each);
  return node_bound(t, &t->nodes[root->first], at, each) +
         node_bound(t, &t->nodes[root->first + 1], at, each);
}

// One of n by weights whose sum is given; *u becomes uniform again and *share
// is multiplied by its probability.
static uint32_t choose(const float *weights, uint32_t n, float sum, double *u,
                       float *share) {
  double at = *u * (double)sum;
  uint32_t i = 0, last = 0;
  for (; i < n; i++) {
    if (!(weights[i] > 0)) continue;
    last = i;
    if (at < (double)weights[i]) break;
    at -= (double)weights[i];
  }
  double rest = at / (double)weights[last];
  *u = i == n ? 0.5 : rest;
  *share *= weights[last] / sum;
  return last;
}

static bool is_usable(float sum) {
  return sum > 0 && sum < INFINITY;
}

bool light_tree_pick(const light_tree *t, const light_place *at, double u,
                     uint32_t *emitter, float *share) {
  if (t->count == 0) return false;
  const light_node *k = &t->nodes[0];
  float each[2][LIGHT_LEAF], weights[2];
  weights[0] = node_bound(t, k, at, each[0]);
  uint32_t side = 0;
  *share = 1;
  while (k->count == 0) {
    const light_node *child = &t->nodes[k->first];
    weights[0] = node_bound(t, &child[0], at, each[0]);
    weights[1] = node_bound(t, &child[1], at, each[1]);
    float sum = weights[0] + weights[1];
    if (!is_usable(sum)) return false;
    side = choose(weights, 2, sum, &u, share);
    k = &child[side];
  }
  if (!is_usable(weights[side])) return false;
  *emitter = k->first + choose(each[side], k->count, weights[side], &u, share);
  return *share > 0;
}

// From the leaf up: what the way down did.
float light_tree_share(const light_tree *t, const light_place *at,
                       uint32_t emitter) {
  uint32_t node = t->leaf_of[emitter];
  const light_node *leaf = &t->nodes[node];
  float each[LIGHT_LEAF], other[LIGHT_LEAF];
  float bound = leaf_bounds(t, leaf, at, each);
  if (!is_usable(bound)) return 0;
  float share = each[emitter - leaf->first] / bound;
  while (node != 0 && share > 0) {
    uint32_t left = t->nodes[t->nodes[node].parent].first;
    uint32_t beside = node == left ? left + 1 : left;
    float sum = bound + node_bound(t, &t->nodes[beside], at, other);
    if (!is_usable(sum)) return 0;
    share *= bound / sum;
    node = t->nodes[node].parent;
    bound = node == 0 ? 0 : node_bound(t, &t->nodes[node], at, other);
  }
  return share;
}
