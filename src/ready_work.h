// ready_work.h — sixteen vertices on their way to being ready.
//
// Compiled once a level, as wide_kernel.h is.

#ifndef READY_WORK_H
#define READY_WORK_H

#include "path_ready.h"
#include "vertex_lanes_find.h"

// The shining triangles that are asked; see light_triangle.
typedef struct ready_light {
  lanes3 a, ab, ac, n, middle;
  float area[LANES], radius[LANES];
  float share[LANES];  // the probability of that triangle
  uint32_t emitter[LANES];
} ready_light;

// Those triangles seen from the vertices; see view of light_triangle.c.
typedef struct ready_view {
  lanes3 to[3];
  float far[3][LANES];
  float volume[LANES], pairs[LANES], one_pair[LANES], angle[LANES];
  float height[LANES];
  float k[3][LANES];         // weights of the corners
  float b[LANES], c[LANES];  // those of corners 1 and 2, when their sum is 1
} ready_view;

typedef struct ready_work {
  lane_work v;
  path_ready r;
  lanes3 t, b, ng;  // turned to wo's side, as r.n is
  uint32_t key_lo[LANES], key_hi[LANES], index[LANES];
  uint32_t cell[LANES], triangle[LANES];
  int32_t clear;        // whether any is a plain mirror or glass
  float eta[LANES];     // of plain glass, else 1
  int32_t sure[LANES];  // whether a plain one is as it was thought to be
  ready_light light;
  ready_view view;
} ready_work;

// vec3_unit where the square of v is in range; elsewhere the lane is odd.
static inline vec3 lane_unit(vec3 v, int32_t *odd) {
  float square = vec3_dot(v, v);
  *odd |= !(square > 0x1p-90f && square < 0x1p120f);
  return vec3_scale(v, 1 / sqrtf(square));
}

#endif
