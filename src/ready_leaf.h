// ready_leaf.h — light_tree_pick where the root is a leaf: a few lamps, all
// weighed by all lanes.

#ifndef READY_LEAF_H
#define READY_LEAF_H

#include "ready_work.h"

// light_bound_emitter; a point is all in one place, above which all is.
static inline void ready_bound(const lanes3 *from, const lanes3 *normal,
                               const light_emitter *e, float *out) {
  const light_triangle t = e->shape;
  const float power = e->power;
  const int point = e->is_point;
  for (int i = 0; i < LANES; i++) {
    vec3 p = lanes_at(from, i), n = lanes_at(normal, i);
    vec3 way = vec3_sub(t.middle, p);
    float distance = float_max(vec3_length(way), t.radius);
    float inverse = 1 / distance, sine = t.radius * inverse;
    float cosine = float_min(1, vec3_dot(n, way) * inverse + sine);
    float height = vec3_dot(t.n, vec3_sub(p, t.a));
    float falls = power * cosine * (inverse * inverse);
    falls = falls < INFINITY ? falls : 0;
    float bound = float_min(1, height * inverse + sine) * falls;
    bound = height > LIGHT_LEAST_HEIGHT * t.radius ? bound : 0;
    bound = point ? falls : bound;
    bound = cosine > 0 ? bound : 0;
    out[i] = distance > 0 ? bound : 0;
  }
}

// choose of light_tree.c among k weights a lane: the emitter and its share.
static inline void ready_choose(ready_work *w, float each[][LANES], uint32_t k,
                                const double *u) {
  float sum[LANES] = {0};
  for (uint32_t e = 0; e < k; e++)
    for (int i = 0; i < LANES; i++)
      sum[i] += each[e][i];
  for (int i = 0; i < LANES; i++) {
    double at = u[i] * (double)sum[i];
    uint32_t last = 0, left = 1;
    float weight = each[0][i];
    for (uint32_t e = 0; e < k; e++) {
      float x = each[e][i];
      uint32_t live = left & (x > 0);
      last = live ? e : last;
      weight = live ? x : weight;
      left &= 1 ^ (live & (at < (double)x));
      at -= live & left ? (double)x : 0;
    }
    w->light.emitter[i] = last;
    w->light.share[i] = weight / sum[i];
    w->r.found[i] = (sum[i] > 0) & (sum[i] < INFINITY) & (u[i] < 1) &
                    (w->light.share[i] > 0) & w->r.matt[i];
  }
}

static inline void ready_leaf(ready_work *w, const light_tree *t,
                              const double *u) {
  const light_node *root = &t->nodes[0];
  float each[LIGHT_LEAF][LANES];
  for (uint32_t e = 0; e < root->count; e++)
    ready_bound(&w->v.p, &w->r.n, &t->emitters[root->first + e], each[e]);
  ready_choose(w, each, root->count, u);
  for (int i = 0; i < LANES; i++) {
    w->light.emitter[i] += root->first;
    w->r.part[i] = LIGHT_NO_PART;
  }
}

#endif
