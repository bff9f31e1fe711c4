// vertex_lanes_smooth.h — normals, and the surface that they mean.

#ifndef VERTEX_LANES_SMOOTH_H
#define VERTEX_LANES_SMOOTH_H

#include "vertex_lanes.h"

// The normals of the corners made unit; odd where they do not agree with ng.
static inline void lanes_shade_normal(lane_work *w) {
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
static inline void lanes_lift(const lane_work *w, lanes64 *lift) {
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
static inline void lanes_blend(lane_work *w) {
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
static inline void lanes_smooth(lane_work *w) {
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

#endif
