// world_hits.h — hits all over a world, and paths into it.

#ifndef WORLD_HITS_H
#define WORLD_HITS_H

#include "worlds.h"

enum { HITS = 6000 };

// Hits of rays from around a world at random points of its triangles.
static inline size_t world_hits(const world *w, uint64_t seed, hit *hits,
                                ray *rays) {
  const mesh *m = &w->scene.mesh;
  vec3 size = vec3_sub(w->scene.hi, w->scene.lo);
  size_t n = 0;
  for (uint64_t i = 0; n < HITS && i < 3 * HITS; i++) {
    rng r = rng_of(seed, i, 0);
    vec3 u = {rng_next(&r), rng_next(&r), rng_next(&r)};
    vec3 from = vec3_add(w->scene.lo, vec3_mul(u, size));
    size_t t = (size_t)(rng_next(&r) * (float)m->triangle_count);
    const uint32_t *v = &m->position_index[3 * t];
    vec3 b = {rng_next(&r), rng_next(&r), rng_next(&r)};
    b = vec3_scale(b, 1 / (b.x + b.y + b.z));
    vec3 to = vec3_scale(m->positions[v[0]], b.x);
    to = vec3_mad(to, b.y, m->positions[v[1]]);
    to = vec3_mad(to, b.z, m->positions[v[2]]);
    ray at = ray_from(from, vec3_sub(to, from));
    if (!w->path.tracer.closest(w->path.tracer.tree, &at, &hits[n])) continue;
    rays[n++] = at;
  }
  return n;
}

// Paths all over a view of 100 x 10 pixels, as samples of 50 of them.
static inline void world_starts(path_start *starts, uint32_t n,
                                const camera_view *view) {
  for (uint32_t i = 0; i < n; i++)
    starts[i] = (path_start){camera_ray(view, (float)(i % 100), (float)i / 40),
                             i % 50, i / 50};
}

#endif
