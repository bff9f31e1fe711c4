// vertex_many_kernel.h — the vertices of many hits, compiled once a level.

#ifndef VERTEX_MANY_KERNEL_H
#define VERTEX_MANY_KERNEL_H

#include "vertex_lanes_find.h"

// Up to LANES hits; lanes beyond n hold the last one again.
static inline void lanes_run(lane_work *w, const scene *s, const hit *hits,
                             const ray *rays, int n, vertex *out) {
  for (int i = 0; i < LANES; i++) {
    int k = i < n ? i : n - 1;
    lane_gather(w, i, s, &hits[k], &rays[k]);
  }
  lanes_find(w);
  for (int i = 0; i < n; i++)
    lane_scatter(w, i, s, &hits[i], &rays[i], &out[i]);
}

static void vertex_many_kernel(const scene *s, const hit *hits, const ray *rays,
                               size_t n, vertex *out) {
  lane_work w;
  for (size_t i = 0; i < n; i += LANES) {
    int m = n - i < LANES ? (int)(n - i) : LANES;
    lanes_run(&w, s, hits + i, rays + i, m, out + i);
  }
}

#endif
