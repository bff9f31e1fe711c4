// bvh_split_clip.c — all in double, widened by far more than doubles err, and
// rounded outwards to floats.

#include "bvh_split_clip.h"

#include <math.h>
#include <string.h>

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

// The next float that is not below, not above.  Without a branch, as nobody
// could guess it.
static inline float round_up(double x) {
  float f = (float)x;
  int32_t bits, next;
  memcpy(&bits, &f, sizeof bits);
  next = f == 0 ? 1 : bits + (bits < 0 ? -1 : 1);
  bits = (double)f < x ? next : bits;
  memcpy(&f, &bits, sizeof f);
  return f;
}

static inline float round_down(double x) {
  return -round_up(-x);
}

// Round outwards and cut down to the box; false when nothing is left.
static bool bound_in_box(sah_box *out, const sah_box *box,
                         const clip_bounds *b) {
  bool some = true;
  *out = *box;
  for (int k = 0; k < 3; k++) {
    float lo = round_down(b->lo[k]), hi = round_up(b->hi[k]);
    out->lo[k] = lo > box->lo[k] ? lo : box->lo[k];
    out->hi[k] = hi < box->hi[k] ? hi : box->hi[k];
    some &= out->lo[k] <= out->hi[k];
  }
  return some;
}

bvh_outline bvh_outline_of(const vec3 p[3]) {
  bvh_outline t = {.margin = {0}};
  for (int i = 0; i < 3; i++) {
    t.v[i][0] = (double)p[i].x;
    t.v[i][1] = (double)p[i].y;
    t.v[i][2] = (double)p[i].z;
    for (int k = 0; k < 3; k++) {
      double m = CLIP_MARGIN * fabs(t.v[i][k]);
      t.margin[k] = m > t.margin[k] ? m : t.margin[k];
    }
  }
  return t;
}

bool bvh_split_clip(sah_box *out, const sah_box *box, const bvh_outline *t,
                    bvh_slice slice) {
  sah_box within = *box;
  int axis = slice.axis;
  if (slice.lo > within.lo[axis]) within.lo[axis] = slice.lo;
  if (slice.hi < within.hi[axis]) within.hi[axis] = slice.hi;
  double lo = (double)within.lo[axis] - t->margin[axis];
  double hi = (double)within.hi[axis] + t->margin[axis];
  clip_bounds b = {{HUGE_VAL, HUGE_VAL, HUGE_VAL},
                   {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
  for (int i = 0; i < 3; i++) {
    const double *v = t->v[i], *next = t->v[i < 2 ? i + 1 : 0];
    if (v[axis] >= lo && v[axis] <= hi) add_point(&b, v);
    add_crossing(&b, v, next, axis, lo);
    add_crossing(&b, v, next, axis, hi);
  }
  for (int k = 0; k < 3; k++) {
    b.lo[k] -= t->margin[k];
    b.hi[k] += t->margin[k];
  }
  return bound_in_box(out, &within, &b);
}
