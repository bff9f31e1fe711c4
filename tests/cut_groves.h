// cut_groves.h — meshes with trees that cut triangles, for the tests of both
// ways to do so.

#ifndef CUT_GROVES_H
#define CUT_GROVES_H

#include "num.h"
#include "shapes.h"
#include "wide.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

// bvh_split_build or bvh_shared_build.
typedef void cut_builder(bvh *out, const bvh *mesh, double rays, arena *mem,
                         pool *threads);

// A mesh, its tree and wide tree with triangles cut, its plain tree, the box of
// all, and how rays at it are made: ray i of a sequence.
typedef struct cut_grove {
  shape s;
  bvh cut, plain;
  wide_tree wide;
  tracer tracer;
  vec3 lo, extent;
  ray (*ray)(const struct cut_grove *g, int i, uint64_t *state);
  uint32_t wrong;
} cut_grove;

static inline bvh mesh_of(const shape *s) {
  return (bvh){.positions = s->positions,
               .index = s->index,
               .triangle_count = s->triangles};
}

static inline void cut_grove_plant(cut_grove *g, shape s, cut_builder *build,
                                   arena *mem) {
  bvh of = mesh_of(&s);
  *g = (cut_grove){.s = s, .extent = {1, 1, 1}};
  build(&g->cut, &of, (double)INFINITY, mem, NULL);
  bvh_build(&g->plain, s.positions, s.index, s.triangles, BVH_COARSE, mem,
            NULL);
  wide_tree_build(&g->wide, &g->cut, mem, NULL);
  g->tracer = wide_tracer(&g->wide);
  if (g->cut.nodes == NULL) return;
  g->lo = g->cut.nodes[0].lo;
  g->extent = vec3_sub(g->cut.nodes[0].hi, g->lo);
}

// Whether all five ways to ask agree about r.
static inline bool cut_grove_agrees(const cut_grove *g, const ray *r) {
  hit list = {0}, other = {0}, tree = {0}, plain = {0}, wide = {0};
  bool found = brute_closest(&g->plain, r, &list);
  return brute_closest(&g->cut, r, &other) == found &&
         bvh_closest(&g->cut, r, &tree) == found &&
         bvh_closest(&g->plain, r, &plain) == found &&
         g->tracer.closest(g->tracer.tree, r, &wide) == found &&
         bvh_any(&g->cut, r) == found && bvh_any(&g->plain, r) == found &&
         g->tracer.any(g->tracer.tree, r) == found &&
         memcmp(&other, &list, sizeof list) == 0 &&
         memcmp(&tree, &list, sizeof list) == 0 &&
         memcmp(&plain, &list, sizeof list) == 0 &&
         memcmp(&wide, &list, sizeof list) == 0;
}

enum { CUT_BATCH = 200 };

static inline void cut_grove_batch(void *context, size_t item, int worker) {
  (void)worker;
  cut_grove *g = context;
  uint64_t state = 977 * item + 1;
  for (int i = 0; i < CUT_BATCH; i++) {
    ray r = g->ray(g, i, &state);
    hit h;
    // Only told apart from 0.
    if (!cut_grove_agrees(g, &r)) g->wrong = 1;
    if (!bvh_closest(&g->cut, &r, &h)) continue;
    // Once more with no room for a t that a box denies.
    ray before = r, behind = r;
    before.tmax = behind.tmin = h.t;
    if (!cut_grove_agrees(g, &before) || !cut_grove_agrees(g, &behind))
      g->wrong = 1;
  }
}

// The list, the trees and the wide tree find the same triangle, t and weights
// to the bit, on so many rays, and again on rays that begin or end at the hit.
static inline void cut_grove_check(cut_grove *g, uint32_t rays, pool *threads) {
  pool_run(threads, rays / CUT_BATCH, cut_grove_batch, g);
  if (g->wrong) print_message("# %s differs\n", g->s.name);
  assert_int_equal(g->wrong, 0);
}

static inline bool box_within(vec3 alo, vec3 ahi, vec3 blo, vec3 bhi) {
  return alo.x >= blo.x && alo.y >= blo.y && alo.z >= blo.z && ahi.x <= bhi.x &&
         ahi.y <= bhi.y && ahi.z <= bhi.z;
}

// Whether some leaf that has triangle t holds the box lo..hi.
static inline bool leaf_holds(const bvh *b, uint32_t t, vec3 lo, vec3 hi) {
  for (uint32_t i = 0; i < b->node_count; i++) {
    const bvh_node *n = &b->nodes[i];
    for (uint32_t k = 0; k < n->count; k++)
      if (b->order[n->first + k] == t && box_within(lo, hi, n->lo, n->hi))
        return true;
  }
  return false;
}

// Coordinate k of the point of a triangle with these weights, in double, held
// between its corners as slab_hold does.
static inline double weighted(const vec3 p[3], const double w[3], int k) {
  double v[3];
  for (int i = 0; i < 3; i++)
    v[i] = (double)(k == 0 ? p[i].x : k == 1 ? p[i].y : p[i].z);
  double x = w[0] * v[0] + w[1] * v[1] + w[2] * v[2];
  return fmin(fmax(x, fmin(v[0], fmin(v[1], v[2]))),
              fmax(v[0], fmax(v[1], v[2])));
}

static inline void between(float *lo, float *hi, double x) {
  float near = (float)x;
  *lo = (double)near > x ? nextafterf(near, -INFINITY) : near;
  *hi = (double)near < x ? nextafterf(near, INFINITY) : near;
}

static inline void corners_of(vec3 p[3], const shape *s, uint32_t t) {
  for (int j = 0; j < 3; j++)
    p[j] = s->positions[s->index[3 * (size_t)t + (size_t)j]];
}

// The box of a random point of a triangle, or of one on its edge, between
// neighbouring floats along each axis.
static inline void point_between(vec3 *lo, vec3 *hi, const vec3 p[3], bool edge,
                                 uint64_t *state) {
  double a = (double)shape_random(state), c = (double)shape_random(state);
  if (edge) a = 0;
  const double w[3] = {1 - a, a * (1 - c), a * c};
  between(&lo->x, &hi->x, weighted(p, w, 0));
  between(&lo->y, &hi->y, weighted(p, w, 1));
  between(&lo->z, &hi->z, weighted(p, w, 2));
}

#endif
