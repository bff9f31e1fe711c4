// path_share.h — what one path of a group sees on a matt surface, all of the
// group may see.

#ifndef PATH_SHARE_H
#define PATH_SHARE_H

#include "path_group.h"
#include "vertex.h"

// Paths that look for all of a group play roulette as if they had so much of
// their throughput: to each pixel what they find is worth less.
#define SHARE_SCALE 0.5f

// Where a path first met a matt surface: where its ray left, the normal and the
// albedo, and the probability that a ray did.
typedef struct share_stand {
  vec3 from, n, albedo;
  float odds;  // 0: it met something else
} share_stand;

// What that ray met, if that is matt too, with normals turned to where it came
// from; and the weight by which each of the group gets what is found there.
typedef struct share_find {
  bool any;
  vec3 p, n, ng, radiance;
  float weight[GROUP];
} share_find;

// Paths side by side, group by group.
typedef struct path_shares {
  path_groups groups;
  share_stand stand[INTEGRATOR_BATCH];
  share_find find[INTEGRATOR_BATCH];
  vec3 own[INTEGRATOR_BATCH];  // radiance that is not shared
} path_shares;

// Nobody has met anything yet.
void path_shares_begin(path_shares *s);

// Path i has left `at` by that stand.  Whether what its ray met there is such
// that a ray from there is seen to find it; then it is kept.
bool path_shares_find(path_shares *s, size_t i, const vertex *at);

// Ask who else of each group sees what one has found, and settle the weights.
void path_shares_connect(path_shares *s, const tracer *t, path_stats *stats);

// The radiance along path i: its own, and its share of what all have found.
vec3 path_shares_sum(const path_shares *s, size_t i);

#endif
