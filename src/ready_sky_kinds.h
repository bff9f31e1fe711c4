// ready_sky_kinds.h — which kind of light sixteen places ask, where an
// environment is one of them: shares_at of light.c, step by step.

#ifndef READY_SKY_KINDS_H
#define READY_SKY_KINDS_H

#include "light.h"
#include "ready_leaf.h"

// The probabilities of lamps nearby, of those far away, and of the environment.
typedef struct sky_kinds {
  float near[LANES], far[LANES], sky[LANES];
} sky_kinds;

// light_bound_group.
static inline void sky_bound_group(const light_group *g, const lanes3 *from,
                                   const lanes3 *normal, float *out) {
  const light_group k = *g;
  const int cone = k.cos_cone > -1;
  for (int i = 0; i < LANES; i++) {
    vec3 way = vec3_sub(k.middle, lanes_at(from, i));
    float distance = float_max(vec3_length(way), k.radius);
    float inverse = 1 / distance, sine = k.radius * inverse;
    float facing = vec3_dot(lanes_at(normal, i), way) * inverse;
    float cosine = float_min(1, facing + sine);
    float c = -vec3_dot(k.axis, way) * inverse;
    float aside = c * k.cos_cone + sqrtf(float_max(1 - c * c, 0)) * k.sin_cone;
    float ahead = float_min(1, (c < k.cos_cone ? aside : 1) + sine);
    int narrow = cone & (sine < 1);
    ahead = narrow ? ahead : 1;
    float falls = k.power * cosine * (inverse * inverse);
    float bound = ahead * (falls < INFINITY ? falls : 0);
    int lit = (cosine > 0) & (ahead > 0) & (distance > 0);
    out[i] = lit ? bound : 0;
  }
}

// node_bound of light_tree.c, added.
static inline void sky_bound_node(const light_tree *t, const light_node *k,
                                  const lanes3 *from, const lanes3 *normal,
                                  float *sum) {
  float one[LANES], all[LANES] = {0};
  if (k->count == 0) sky_bound_group(&k->group, from, normal, all);
  for (uint32_t e = 0; e < k->count; e++) {
    ready_bound(from, normal, &t->emitters[k->first + e], one);
    for (int i = 0; i < LANES; i++)
      all[i] += one[i];
  }
  for (int i = 0; i < LANES; i++)
    sum[i] += all[i];
}

// light_tree_bound.
static inline void sky_bound_tree(const light_tree *t, const lanes3 *from,
                                  const lanes3 *normal, float *sum) {
  memset(sum, 0, LANES * sizeof *sum);
  if (t->count == 0) return;
  const light_node *root = &t->nodes[0], *of = &t->nodes[root->first];
  if (root->count > 0) {
    sky_bound_node(t, root, from, normal, sum);
    return;
  }
  sky_bound_node(t, &of[0], from, normal, sum);
  sky_bound_node(t, &of[1], from, normal, sum);
}

// far_weight of all directional lights.
static inline void sky_bound_far(const light_set *l, const lanes3 *normal,
                                 float *sum) {
  memset(sum, 0, LANES * sizeof *sum);
  for (size_t k = 0; k < l->far_count; k++) {
    light_far f = l->far[k];
    for (int i = 0; i < LANES; i++)
      sum[i] += f.power * float_max(vec3_dot(lanes_at(normal, i), f.wi), 0);
  }
}

// share_of.
static inline float lane_kind(float weight, float sum, int kinds) {
  float share =
      (1 - LIGHT_EVEN_SHARE) * weight / sum + LIGHT_EVEN_SHARE / (float)kinds;
  int any = (weight > 0) & (sum < INFINITY);
  return any ? share : 0;
}

// Normals are not zero.
static inline void sky_kinds_at(const light_set *l, const lanes3 *from,
                                const lanes3 *normal, sky_kinds *out) {
  const bool alone = l->near.count == 0 && l->far_count == 0;
  const float sky = l->env.irradiance;
  for (int i = 0; i < LANES; i++)
    out->near[i] = out->far[i] = 0, out->sky[i] = 1;
  if (alone) return;
  sky_bound_tree(&l->near, from, normal, out->near);
  sky_bound_far(l, normal, out->far);
  for (int i = 0; i < LANES; i++) {
    float near = out->near[i], far = out->far[i], sum = near + far + sky;
    int kinds = (near > 0) + (far > 0) + (sky > 0);
    out->near[i] = lane_kind(near, sum, kinds);
    out->far[i] = lane_kind(far, sum, kinds);
    out->sky[i] = lane_kind(sky, sum, kinds);
  }
}

#endif
