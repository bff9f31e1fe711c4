// vertex_lanes_find.h — from columns to vertices.

#ifndef VERTEX_LANES_FIND_H
#define VERTEX_LANES_FIND_H

#include "vertex_lanes_facet.h"
#include "vertex_lanes_smooth.h"

// surface_paint, at once where there is nothing to be interpolated.
static inline void lane_paint(surface *at, const scene *s, const hit *h) {
  if (s->mesh.texcoord_index != NULL || s->mesh.colors != NULL) {
    surface_paint(at, s, h);
    return;
  }
  at->uv = (vec2){0, 0};
  at->color = vec3_all(1);
  at->material = s->material_of != NULL
                     ? &s->materials[s->material_of[h->triangle]]
                     : NULL;
}

// vertex_face, at once where there are no bumps.
static inline void lane_face(vertex *v, const scene *s, const hit *h) {
  const material *m = v->at.material;
  if (m != NULL && (m->map_bump.image != NULL || m->map_norm.image != NULL)) {
    vertex_face(v, s, h);
    return;
  }
  v->ng = v->at.front ? v->at.ng : vec3_neg(v->at.ng);
  v->ns = v->at.front ? v->at.ns : vec3_neg(v->at.ns);
}

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
  lane_paint(at, s, h);
  v->wo = lanes_at(&w->wo, i);
  lane_face(v, s, h);
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
