// vertex_lanes_find.h — from columns to vertices.

#ifndef VERTEX_LANES_FIND_H
#define VERTEX_LANES_FIND_H

#include "vertex_lanes_facet.h"
#include "vertex_lanes_smooth.h"

// Lane i as the vertex of its hit.
static inline void lane_scatter(const lane_work *w, int i, const scene *s,
                                const hit *h, const ray *r, vertex *v) {
  if (w->odd[i]) {
    *v = vertex_at(s, h, r->d);
    return;
  }
  surface *at = &v->at;
  at->p = lanes_at(&w->p, i);
  at->p_error = lanes_at(&w->p_error, i);
  at->p_smooth = lanes_at(&w->p_smooth, i);
  at->inward = lanes_at(&w->inward, i);
  at->ng = lanes_at(&w->ng, i);
  at->ns = lanes_at(&w->ns, i);
  at->front = w->front[i];
  at->smooth = w->smooth[i];
  at->triangle = h->triangle;
  surface_paint(at, s, h);
  v->wo = lanes_at(&w->wo, i);
  vertex_face(v, s, h);
}

// All of the geometry of what was gathered.
static inline void lanes_find(lane_work *w) {
  for (int i = 0; i < LANES; i++) {
    w->wo.x[i] = -w->d.x[i];
    w->wo.y[i] = -w->d.y[i];
    w->wo.z[i] = -w->d.z[i];
  }
  lanes_unit(&w->wo, w->odd);
  lanes_facet(w);
  lanes_point(w);
  lanes_smooth(w);
}

#endif
