// vertex_many_kernel.h — the vertices of many hits, compiled once a level.

#ifndef VERTEX_MANY_KERNEL_H
#define VERTEX_MANY_KERNEL_H

#include "vertex_lanes_facet.h"
#include "vertex_lanes_smooth.h"

static inline vec3 lane_of(const lanes3 *v, int i) {
  return (vec3){v->x[i], v->y[i], v->z[i]};
}

// Lane i as the vertex of its hit.
static inline void lane_scatter(const lane_work *w, int i, const scene *s,
                                const hit *h, const ray *r, vertex *v) {
  if (w->odd[i]) {
    *v = vertex_at(s, h, r->d);
    return;
  }
  surface *at = &v->at;
  at->p = lane_of(&w->p, i);
  at->p_error = lane_of(&w->p_error, i);
  at->p_smooth = lane_of(&w->p_smooth, i);
  at->inward = lane_of(&w->inward, i);
  at->ng = lane_of(&w->ng, i);
  at->ns = lane_of(&w->ns, i);
  at->front = w->front[i];
  at->smooth = w->smooth[i];
  at->triangle = h->triangle;
  surface_paint(at, s, h);
  v->wo = lane_of(&w->wo, i);
  vertex_face(v, s, h);
}

// Up to LANES hits; lanes beyond n hold the last one again.
static inline void lanes_run(lane_work *w, const scene *s, const hit *hits,
                             const ray *rays, int n, vertex *out) {
  for (int i = 0; i < LANES; i++) {
    int k = i < n ? i : n - 1;
    lane_gather(w, i, s, &hits[k], &rays[k]);
  }
  for (int i = 0; i < LANES; i++) {
    w->wo.x[i] = -w->d.x[i];
    w->wo.y[i] = -w->d.y[i];
    w->wo.z[i] = -w->d.z[i];
  }
  lanes_unit(&w->wo, w->odd);
  lanes_facet(w);
  lanes_point(w);
  lanes_smooth(w);
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
