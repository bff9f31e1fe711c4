// wide_kernel.h — all ways down the wide tree, compiled once a level.
//
// A file that includes this is given its instructions by the Makefile and
// defines one wide_level.  All levels find the same, to the bit.

#ifndef WIDE_KERNEL_H
#define WIDE_KERNEL_H

#include "wide_below.h"
#include "wide_few_all.h"
#include "wide_single.h"
#include "wide_together.h"

static bool kernel_closest(const void *tree, const ray *r, hit *h) {
  wide_walk w;
  if (!walk_start(&w, tree, r) || !walk_tree(&w, tree, false, NULL))
    return false;
  *h = w.best;
  return true;
}

static bool kernel_closest_counted(const void *tree, const ray *r, hit *h,
                                   bvh_visits *v) {
  wide_walk w;
  if (!walk_start(&w, tree, r) || !walk_tree(&w, tree, false, v)) return false;
  *h = w.best;
  return true;
}

static bool kernel_any(const void *tree, const ray *r) {
  wide_walk w;
  return walk_start(&w, tree, r) && walk_tree(&w, tree, true, NULL);
}

static void kernel_closest_many(const void *tree, const ray *rays,
                                const uint32_t *left, hit *hits, size_t n) {
  if (((const wide_tree *)tree)->depth > FLIGHT_DEPTH || n > UINT32_MAX) {
    for (size_t i = 0; i < n; i++) {
      hits[i] = (hit){.t = rays[i].tmax, .triangle = HIT_NONE};
      kernel_closest(tree, &rays[i], &hits[i]);
    }
    return;
  }
  stream s;
  s.t = tree;
  s.rays = rays;
  s.left = s.t->patch != NULL ? left : NULL;
  s.hits = hits;
  s.blocked = NULL;
  stream_run(&s, n, false);
}

static void kernel_any_many(const void *tree, const ray *rays, bool *blocked,
                            size_t n) {
  if (((const wide_tree *)tree)->depth > FLIGHT_DEPTH || n > UINT32_MAX) {
    for (size_t i = 0; i < n; i++)
      blocked[i] = kernel_any(tree, &rays[i]);
    return;
  }
  if (is_few(tree)) {
    few_run(tree, rays, blocked, n);
    return;
  }
  stream s;
  s.t = tree;
  s.rays = rays;
  s.left = NULL;
  s.hits = NULL;
  s.blocked = blocked;
  if (s.t->nodes != NULL && crowd_likely(rays, n))
    crowds_run(&s, (uint32_t)n);
  else
    stream_run(&s, n, true);
}

// The entries of this level.
#define WIDE_KERNEL_ENTRIES \
  kernel_closest, kernel_any, kernel_closest_many, kernel_any_many, \
      kernel_closest_counted, kernel_patches

#endif
