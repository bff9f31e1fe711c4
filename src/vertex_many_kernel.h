// vertex_many_kernel.h — the geometry of sixteen hits, number by number.
//
// Each loop below runs over lanes and has neither calls nor branches, so that
// a compiler makes vector instructions of it.  The arithmetic is that of
// surface.c and vertex.c, step by step, and so are its results.  A lane that
// would take one of the rare ways there is odd: its hit is handed over.
//
// Compiled once a level, as wide_kernel.h is.

#ifndef VERTEX_MANY_KERNEL_H
#define VERTEX_MANY_KERNEL_H

#include "vertex.h"

#include <float.h>

enum { LANES = 16 };

// A number, a vector, a vector in double precision for every lane.
typedef struct lanes {
  float v[LANES];
} lanes;

typedef struct lanes3 {
  float x[LANES], y[LANES], z[LANES];
} lanes3;

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

// Corners and normals of a hit into lane i.
static void lane_gather(lane_work *w, int i, const scene *s, const hit *h,
                        const ray *r) {
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

// winding_normal, ng and the side that the ray came from.
static void lanes_facet(lane_work *w) {
  const lanes3 *p = w->corner;
  lanes64 *a = &w->edge1, *b = &w->edge2, *f = &w->facet;
  for (int i = 0; i < LANES; i++) {
    a->x[i] = (double)p[1].x[i] - (double)p[0].x[i];
    a->y[i] = (double)p[1].y[i] - (double)p[0].y[i];
    a->z[i] = (double)p[1].z[i] - (double)p[0].z[i];
    b->x[i] = (double)p[2].x[i] - (double)p[0].x[i];
    b->y[i] = (double)p[2].y[i] - (double)p[0].y[i];
    b->z[i] = (double)p[2].z[i] - (double)p[0].z[i];
    f->x[i] = a->y[i] * b->z[i] - a->z[i] * b->y[i];
    f->y[i] = a->z[i] * b->x[i] - a->x[i] * b->z[i];
    f->z[i] = a->x[i] * b->y[i] - a->y[i] * b->x[i];
  }
  for (int i = 0; i < LANES; i++) {
    double square = f->x[i] * f->x[i] + f->y[i] * f->y[i] + f->z[i] * f->z[i];
    double scale = 1 / sqrt(square);
    double along = f->x[i] * (double)w->d.x[i] + f->y[i] * (double)w->d.y[i] +
                   f->z[i] * (double)w->d.z[i];
    w->odd[i] |= !(square > 0);
    w->front[i] = along <= 0;
    w->ng.x[i] = (float)(0 + scale * f->x[i]);
    w->ng.y[i] = (float)(0 + scale * f->y[i]);
    w->ng.z[i] = (float)(0 + scale * f->z[i]);
  }
}

// Half a unit in the last place, as rounding_error of surface.c.
static inline float lane_error(float p, float a, float b, float c) {
  float sum = fabsf(a) + fabsf(b) + fabsf(c);
  return fabsf(p) * 0x1.00001p-24f + sum * 0x1p-50f + FLT_TRUE_MIN;
}

// The point, its error and the step inwards.
static void lanes_point(lane_work *w) {
  const lanes3 *c = w->corner;
  const lanes64 *a = &w->edge1, *b = &w->edge2;
  lanes64 *q = &w->point;
  for (int i = 0; i < LANES; i++) {
    double b1 = (double)w->b1.v[i], b2 = (double)w->b2.v[i];
    q->x[i] = (double)c[0].x[i] + b1 * a->x[i] + b2 * b->x[i];
    q->y[i] = (double)c[0].y[i] + b1 * a->y[i] + b2 * b->y[i];
    q->z[i] = (double)c[0].z[i] + b1 * a->z[i] + b2 * b->z[i];
    float x = (float)q->x[i], y = (float)q->y[i], z = (float)q->z[i];
    w->p.x[i] = x, w->p.y[i] = y, w->p.z[i] = z;
    w->p_error.x[i] = lane_error(x, c[0].x[i], c[1].x[i], c[2].x[i]);
    w->p_error.y[i] = lane_error(y, c[0].y[i], c[1].y[i], c[2].y[i]);
    w->p_error.z[i] = lane_error(z, c[0].z[i], c[1].z[i], c[2].z[i]);
  }
  const double third = 1.0 / 3;
  for (int i = 0; i < LANES; i++) {
    double x = 0 + third * (double)c[0].x[i] + third * (double)c[1].x[i] +
               third * (double)c[2].x[i] - q->x[i];
    double y = 0 + third * (double)c[0].y[i] + third * (double)c[1].y[i] +
               third * (double)c[2].y[i] - q->y[i];
    double z = 0 + third * (double)c[0].z[i] + third * (double)c[1].z[i] +
               third * (double)c[2].z[i] - q->z[i];
    double length = sqrt(x * x + y * y + z * z);
    float errors = w->p_error.x[i] + w->p_error.y[i] + w->p_error.z[i];
    double step = 4 * (double)errors, share = step / length;
    share = step < length ? share : 1;
    w->inward.x[i] = (float)(0 + share * x);
    w->inward.y[i] = (float)(0 + share * y);
    w->inward.z[i] = (float)(0 + share * z);
  }
}

// The normals of the corners made unit; odd where they do not agree with ng.
static void lanes_shade_normal(lane_work *w) {
  float agree[LANES] = {0};
  for (int k = 0; k < 3; k++) {
    lanes3 *n = &w->normal_at[k];
    lanes_unit(n, w->odd);
    for (int i = 0; i < LANES; i++) {
      float x = n->x[i], y = n->y[i], z = n->z[i];
      w->odd[i] |= !(fabsf(x * x + y * y + z * z - 1) < 0.01f);
      agree[i] += x * w->ng.x[i] + y * w->ng.y[i] + z * w->ng.z[i];
    }
  }
  for (int i = 0; i < LANES; i++)
    w->odd[i] |= w->smooth[i] & (agree[i] < 0);
}

// smooth_lift of surface.c, before it is known whether it counts.
static void lanes_lift(const lane_work *w, lanes64 *lift) {
  *lift = (lanes64){{0}, {0}, {0}};
  for (int k = 0; k < 3; k++) {
    const lanes3 *n = &w->normal_at[k], *c = &w->corner[k];
    for (int i = 0; i < LANES; i++) {
      double b1 = (double)w->b1.v[i], b2 = (double)w->b2.v[i];
      double b = k == 0 ? 1 - b1 - b2 : k == 1 ? b1 : b2;
      double side = w->front[i] ? 1 : -1;
      double x = (double)n->x[i], y = (double)n->y[i], z = (double)n->z[i];
      double height = side * (((double)c->x[i] - w->point.x[i]) * x +
                              ((double)c->y[i] - w->point.y[i]) * y +
                              ((double)c->z[i] - w->point.z[i]) * z);
      double by = side * b * height;
      by = height > 0 ? by : 0;
      lift->x[i] += by * x, lift->y[i] += by * y, lift->z[i] += by * z;
    }
  }
}

// The corners' normals by the weights of the point, unit.
static void lanes_blend(lane_work *w) {
  const lanes3 *n = w->normal_at;
  lanes3 *ns = &w->ns;
  for (int i = 0; i < LANES; i++) {
    double b1 = (double)w->b1.v[i], b2 = (double)w->b2.v[i];
    float c0 = (float)(1 - b1 - b2), c1 = (float)b1, c2 = (float)b2;
    ns->x[i] = n[0].x[i] * c0 + c1 * n[1].x[i] + c2 * n[2].x[i];
    ns->y[i] = n[0].y[i] * c0 + c1 * n[1].y[i] + c2 * n[2].y[i];
    ns->z[i] = n[0].z[i] * c0 + c1 * n[1].z[i] + c2 * n[2].z[i];
  }
  lanes_unit(ns, w->odd);
}

// ns, and p lifted to the smooth surface.
static void lanes_smooth(lane_work *w) {
  lanes64 lift;
  lanes3 *ns = &w->ns;
  lanes_shade_normal(w);
  lanes_lift(w, &lift);
  lanes_blend(w);
  for (int i = 0; i < LANES; i++) {
    float lean =
        ns->x[i] * w->ng.x[i] + ns->y[i] * w->ng.y[i] + ns->z[i] * w->ng.z[i];
    double side = w->front[i] ? 1 : -1;
    double up = side * (lift.x[i] * w->facet.x[i] + lift.y[i] * w->facet.y[i] +
                        lift.z[i] * w->facet.z[i]);
    int32_t smooth = w->smooth[i];
    double on = (smooth & (up > 0)) ? 1 : 0;
    w->odd[i] |= smooth & !(lean >= 0.01f);
    ns->x[i] = smooth ? ns->x[i] : w->ng.x[i];
    ns->y[i] = smooth ? ns->y[i] : w->ng.y[i];
    ns->z[i] = smooth ? ns->z[i] : w->ng.z[i];
    w->p_smooth.x[i] = (float)(w->point.x[i] + on * lift.x[i]);
    w->p_smooth.y[i] = (float)(w->point.y[i] + on * lift.y[i]);
    w->p_smooth.z[i] = (float)(w->point.z[i] + on * lift.z[i]);
  }
}

static inline vec3 lane_of(const lanes3 *v, int i) {
  return (vec3){v->x[i], v->y[i], v->z[i]};
}

// Lane i as the vertex of its hit.
static void lane_scatter(const lane_work *w, int i, const scene *s,
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
static void lanes_run(lane_work *w, const scene *s, const hit *hits,
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
