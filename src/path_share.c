// path_share.c — the trick: light that leaves a matt surface leaves it alike in
// all directions, so what one path learns of it holds for its neighbours too.
// They only need to look there.

#include "path_share.h"

#include "tracer.h"

#include <string.h>

void path_shares_begin(path_shares *s) {
  for (size_t i = 0; i < s->groups.count; i++) {
    s->stand[i].odds = 0;
    s->find[i].any = false;
    s->own[i] = vec3_all(0);
  }
}

// Whether a ray from there that nothing stops could be scattered to a place,
// and finds the side that was found.
static bool faces(const share_stand *from, const share_find *to) {
  vec3 d = vec3_sub(to->p, from->from);
  return from->odds > 0 && vec3_dot(from->n, d) > 0 && vec3_dot(to->n, d) < 0 &&
         vec3_dot(to->ng, d) < 0;
}

// Its density per area of what is found, times pi.
static float density(const share_stand *from, const share_find *to) {
  vec3 d = vec3_sub(to->p, from->from);
  float square = vec3_dot(d, d);  // its square would be 0 in small scenes
  return vec3_dot(from->n, d) / square * (-vec3_dot(to->ng, d) / square);
}

bool path_shares_find(path_shares *s, size_t i, const vertex *at) {
  share_find f = {.p = at->at.p, .n = at->ns, .ng = at->ng};
  f.weight[i % GROUP] = density(&s->stand[i], &f);
  f.any = faces(&s->stand[i], &f) && f.weight[i % GROUP] > 0 &&
          isfinite(f.weight[i % GROUP]);
  s->find[i] = f;
  return f.any;
}

// All ways from a stand of a group to what somebody else has found.
typedef struct ways {
  size_t count;
  ray rays[GROUP * GROUP];
  int from[GROUP * GROUP], to[GROUP * GROUP];
} ways;

static void find_ways(ways *w, const share_stand *stand,
                      const share_find *find) {
  w->count = 0;
  for (int to = 0; to < GROUP; to++)
    for (int from = 0; from < GROUP && find[to].any; from++) {
      if (from == to || !faces(&stand[from], &find[to])) continue;
      vec3 o = stand[from].from;
      ray r = ray_from(o, vec3_sub(find[to].p, o));
      r.tmax = SURFACE_SHADOW_END;
      w->rays[w->count] = r;
      w->from[w->count] = from;
      w->to[w->count++] = to;
    }
}

// The balance heuristic: what is found is as if drawn from the mean of all
// densities with which a path of the group could have found it.  Source: Veach
// and Guibas 1995; for paths of neighbours: Bekaert, Sbert and Halton 2002.
static void balance(share_find *f, const share_stand *stand) {
  float sum = 0;
  for (int k = 0; k < GROUP; k++)
    sum += stand[k].odds * f->weight[k];
  for (int k = 0; k < GROUP; k++)
    f->weight[k] /= sum;
}

void path_shares_connect(path_shares *s, const tracer *t, path_stats *stats) {
  ways w;
  bool blocked[GROUP * GROUP];
  for (size_t i = 0; i < s->groups.count; i += GROUP) {
    const share_stand *stand = &s->stand[i];
    share_find *find = &s->find[i];
    find_ways(&w, stand, find);
    tracer_any_many(t, w.rays, blocked, w.count);
    stats->rays += w.count;
    stats->shared += w.count;
    for (size_t k = 0; k < w.count; k++)
      if (!blocked[k])
        find[w.to[k]].weight[w.from[k]] =
            density(&stand[w.from[k]], &find[w.to[k]]);
    for (int k = 0; k < GROUP; k++)
      if (find[k].any) balance(&find[k], stand);
  }
}

vec3 path_shares_sum(const path_shares *s, size_t i) {
  const share_find *find = &s->find[i / GROUP * GROUP];
  vec3 sum = vec3_all(0);
  for (int k = 0; k < GROUP; k++)
    if (find[k].any && find[k].weight[i % GROUP] > 0)
      sum = vec3_mad(sum, find[k].weight[i % GROUP], find[k].radiance);
  return vec3_add(s->own[i], vec3_mul(s->stand[i].albedo, sum));
}
