// vertex_lanes_facet.h — where the hits are, and on which side.

#ifndef VERTEX_LANES_FACET_H
#define VERTEX_LANES_FACET_H

#include "vertex_lanes.h"

#include <float.h>

// winding_normal, ng and the side that the ray came from.
static inline void lanes_facet(lane_work *w) {
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
static inline void lanes_point(lane_work *w) {
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

#endif
