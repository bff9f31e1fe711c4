// sah_box.h — boxes of the builders of trees, four floats at a time.

#ifndef SAH_BOX_H
#define SAH_BOX_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

// A box in the registers' layout: lanes x, y, z and one that means nothing.
typedef struct sah_box {
  float lo[4], hi[4];
} sah_box;

// Four lanes as the machine's registers have them.
typedef float sah_lanes __attribute__((vector_size(16)));
typedef int32_t sah_slices __attribute__((vector_size(16)));

static inline sah_lanes sah_load(const float from[4]) {
  sah_lanes v;
  memcpy(&v, from, sizeof v);
  return v;
}

// a < b ? a : b and a > b ? a : b, lane by lane.
static inline sah_lanes sah_min(sah_lanes a, sah_lanes b) {
#if defined(__SSE__)
  return _mm_min_ps(a, b);
#else
  sah_slices m = a < b;
  return (sah_lanes)(((sah_slices)a & m) | ((sah_slices)b & ~m));
#endif
}

static inline sah_lanes sah_max(sah_lanes a, sah_lanes b) {
#if defined(__SSE__)
  return _mm_max_ps(a, b);
#else
  sah_slices m = a > b;
  return (sah_lanes)(((sah_slices)a & m) | ((sah_slices)b & ~m));
#endif
}

// The centre of a box, 0 in the fourth lane: what lies there may be no number
// to count with.  Halves first: the sum of two coordinates near FLT_MAX would
// overflow.
static inline sah_lanes sah_centre(const sah_box *b) {
  const sah_slices three = {-1, -1, -1, 0};
  const sah_lanes half = {0.5f, 0.5f, 0.5f, 0.5f};
  sah_lanes lo = (sah_lanes)((sah_slices)sah_load(b->lo) & three);
  sah_lanes hi = (sah_lanes)((sah_slices)sah_load(b->hi) & three);
  return half * lo + half * hi;
}

// A triangle while the tree is built, 32 bytes: its box, which spares the
// builder a walk to the vertices, and its number in the fourth lane of lo.
typedef union sah_ref {
  sah_box box;
  struct {
    float lo[3];
    uint32_t triangle;
    float hi[3];
    uint32_t unused;
  } as;
} sah_ref;

// The empty box.
static inline sah_box sah_box_empty(void) {
  const float inf = INFINITY;
  return (sah_box){{inf, inf, inf, inf}, {-inf, -inf, -inf, -inf}};
}

// lo and hi joined to those of a, four lanes at a time.
static inline void sah_grow(sah_box *a, sah_lanes lo, sah_lanes hi) {
  sah_lanes x = sah_min(lo, sah_load(a->lo)), y = sah_max(hi, sah_load(a->hi));
  memcpy(a->lo, &x, sizeof x);
  memcpy(a->hi, &y, sizeof y);
}

// a grown to hold b; a grown to hold the centre of b.
static inline void sah_box_join(sah_box *a, const sah_box *b) {
  sah_grow(a, sah_load(b->lo), sah_load(b->hi));
}

static inline void sah_box_join_centre(sah_box *a, const sah_box *b) {
  sah_lanes c = sah_centre(b);
  sah_grow(a, c, c);
}

#endif
