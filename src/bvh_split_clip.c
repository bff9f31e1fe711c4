// bvh_split_clip.c — all in double, widened by far more than doubles err, and
// rounded outwards to floats.

#include "bvh_split_clip.h"

#include <math.h>

// The widening, in units of the triangle's largest coordinate along an axis.
#define CLIP_MARGIN 0x1p-40

// The points of a triangle's outline that lie in a slice: its corners, and
// where its edges cross the planes.  Between them they span the part.
typedef struct clip_bounds {
  double lo[3], hi[3];
} clip_bounds;

static void add_point(clip_bounds *b, const double v[3]) {
  for (int k = 0; k < 3; k++) {
    b->lo[k] = v[k] < b->lo[k] ? v[k] : b->lo[k];
    b->hi[k] = v[k] > b->hi[k] ? v[k] : b->hi[k];
  }
}

// Where edge a b crosses a plane across an axis, if it does.
static void add_crossing(clip_bounds *b, const double a[3], const double c[3],
                         int axis, double at) {
  if ((a[axis] < at) == (c[axis] < at)) return;
  double t = (at - a[axis]) / (c[axis] - a[axis]), v[3];
  for (int k = 0; k < 3; k++)
    v[k] = a[k] + t * (c[k] - a[k]);
  v[axis] = at;
  add_point(b, v);
}

// The next float that is not above, not below.
static float round_down(double x) {
  float f = (float)x;
  return (double)f > x ? nextafterf(f, -INFINITY) : f;
}

static float round_up(double x) {
  float f = (float)x;
  return (double)f < x ? nextafterf(f, INFINITY) : f;
}

// Round outwards and cut down to the box; false when nothing is left.
static bool bound_in_box(sah_box *out, const sah_box *box,
                         const clip_bounds *b) {
  *out = *box;
  for (int k = 0; k < 3; k++) {
    float lo = round_down(b->lo[k]), hi = round_up(b->hi[k]);
    if (lo > out->lo[k]) out->lo[k] = lo;
    if (hi < out->hi[k]) out->hi[k] = hi;
    if (!(out->lo[k] <= out->hi[k])) return false;
  }
  return true;
}

bool bvh_split_clip(sah_box *out, const sah_box *box, const vec3 p[3],
                    bvh_slice slice) {
  double v[3][3], margin[3] = {0};
  for (int i = 0; i < 3; i++) {
    v[i][0] = (double)p[i].x;
    v[i][1] = (double)p[i].y;
    v[i][2] = (double)p[i].z;
    for (int k = 0; k < 3; k++)
      margin[k] = fmax(margin[k], CLIP_MARGIN * fabs(v[i][k]));
  }
  sah_box within = *box;
  int axis = slice.axis;
  if (slice.lo > within.lo[axis]) within.lo[axis] = slice.lo;
  if (slice.hi < within.hi[axis]) within.hi[axis] = slice.hi;
  double lo = (double)within.lo[axis] - margin[axis];
  double hi = (double)within.hi[axis] + margin[axis];
  clip_bounds b = {{HUGE_VAL, HUGE_VAL, HUGE_VAL},
                   {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
  for (int i = 0; i < 3; i++) {
    const double *next = v[(i + 1) % 3];
    if (v[i][axis] >= lo && v[i][axis] <= hi) add_point(&b, v[i]);
    add_crossing(&b, v[i], next, axis, lo);
    add_crossing(&b, v[i], next, axis, hi);
  }
  for (int k = 0; k < 3; k++) {
    b.lo[k] -= margin[k];
    b.hi[k] += margin[k];
  }
  return bound_in_box(out, &within, &b);
}
