// tracer.h — many rays asked at once.

#ifndef TRACER_H
#define TRACER_H

#include "ray.h"

// The answers to n rays, together where t can, else one by one; left as in
// ray.h.
static inline void tracer_closest_many(const tracer *t, const ray *rays,
                                       const uint32_t *left, hit *hits,
                                       size_t n) {
  if (t->closest_many != NULL) {
    t->closest_many(t->tree, rays, left, hits, n);
    return;
  }
  for (size_t i = 0; i < n; i++) {
    hits[i] = (hit){.t = rays[i].tmax, .triangle = HIT_NONE};
    t->closest(t->tree, &rays[i], &hits[i]);
  }
}

static inline void tracer_any_many(const tracer *t, const ray *rays,
                                   bool *blocked, size_t n) {
  if (t->any_many != NULL) {
    t->any_many(t->tree, rays, blocked, n);
    return;
  }
  for (size_t i = 0; i < n; i++)
    blocked[i] = t->any(t->tree, &rays[i]);
}

#endif
