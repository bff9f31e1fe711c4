// vertex_lanes.h — sixteen hits, number by number.
//
// Each loop over lanes has neither calls nor branches, so that a compiler
// makes vector instructions of it.  The arithmetic is that of surface.c and
// vertex.c, step by step, and so are its results.  A lane that would take one
// of the rare ways there is odd: its hit is handed over.
//
// Compiled once a level, as wide_kernel.h is.

#ifndef VERTEX_LANES_H
#define VERTEX_LANES_H

#include "lanes.h"
#include "vertex.h"

// A vector in double precision for every lane.
typedef struct lanes64 {
  double x[LANES], y[LANES], z[LANES];
} lanes64;

// What is known of the hits, and what becomes of it; see surface.
typedef struct lane_work {
  lanes3 corner[3], normal_at[3], d;
  lanes b1, b2;
  int32_t smooth[LANES], odd[LANES], front[LANES];
  lanes64 edge1, edge2, facet, point;  // facet: the normal, of any length
  lanes3 ng, ns, wo, p, p_error, p_smooth, inward;
} lane_work;

// Ask for what lane_gather will read next, when vertex_expect has been heard.
static inline void lane_expect(const scene *s, const hit *h)
    __attribute__((always_inline));
static inline void lane_expect(const scene *s, const hit *h) {
  const mesh *m = &s->mesh;
  size_t at = 3 * (size_t)h->triangle;
  for (size_t k = 0; k < 3; k++) {
    __builtin_prefetch(&m->positions[m->position_index[at + k]]);
    uint32_t which = m->normal_index != NULL ? m->normal_index[at + k] : 0;
    if (m->normals != NULL && which != MESH_NONE)
      __builtin_prefetch(&m->normals[which]);
  }
}

// Corners and normals of a hit into lane i.
static inline void lane_gather(lane_work *w, int i, const scene *s,
                               const hit *h, const ray *r) {
  const mesh *m = &s->mesh;
  size_t at = 3 * (size_t)h->triangle;
  int with_normal = 0;
  for (size_t k = 0; k < 3; k++) {
    vec3 p = m->positions[m->position_index[at + k]];
    w->corner[k].x[i] = p.x, w->corner[k].y[i] = p.y, w->corner[k].z[i] = p.z;
    uint32_t which =
        m->normal_index == NULL ? MESH_NONE : m->normal_index[at + k];
    vec3 n = which == MESH_NONE ? (vec3){0, 0, 1} : m->normals[which];
    w->normal_at[k].x[i] = n.x, w->normal_at[k].y[i] = n.y;
    w->normal_at[k].z[i] = n.z;
    with_normal += which != MESH_NONE;
  }
  w->b1.v[i] = h->b1, w->b2.v[i] = h->b2;
  w->d.x[i] = r->d.x, w->d.y[i] = r->d.y, w->d.z[i] = r->d.z;
  w->smooth[i] = with_normal == 3;
  w->odd[i] = with_normal == 1 || with_normal == 2;
}

// vec3_unit where the square of v is in range; elsewhere the lane is odd.
static inline void lanes_unit(lanes3 *v, int32_t *odd) {
  for (int i = 0; i < LANES; i++) {
    float square = v->x[i] * v->x[i] + v->y[i] * v->y[i] + v->z[i] * v->z[i];
    float scale = 1 / sqrtf(square);
    odd[i] |= !(square > 0x1p-90f && square < 0x1p120f);
    v->x[i] *= scale, v->y[i] *= scale, v->z[i] *= scale;
  }
}

#endif
