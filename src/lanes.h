// lanes.h — sixteen of everything, number by number: a column for each
// component.
//
// A loop over lanes without calls and branches is what compilers make vector
// instructions of.  Each lane's arithmetic is that of one alone, and so are its
// results.

#ifndef LANES_H
#define LANES_H

#include "vec.h"

enum { LANES = 16 };

// A number, a vector for every lane.
typedef struct lanes {
  float v[LANES];
} lanes;

typedef struct lanes3 {
  float x[LANES], y[LANES], z[LANES];
} lanes3;

static inline vec3 lanes_at(const lanes3 *v, int i) {
  return (vec3){v->x[i], v->y[i], v->z[i]};
}

static inline void lanes_set(lanes3 *v, int i, vec3 a) {
  v->x[i] = a.x, v->y[i] = a.y, v->z[i] = a.z;
}

#endif
