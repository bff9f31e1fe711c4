// wide_tests.h — eight tests at once, each of a ray with a triangle.

#ifndef WIDE_TESTS_H
#define WIDE_TESTS_H

#include "wide_edges.h"
#include "wide_packet.h"
#include "wide_ready.h"

// Eight rays, in the terms of wide_walk but all axes turned by the shear, and a
// triangle for each.
typedef struct leaf_tests {
  leaf_corners at;
  leaf_rays rays;
  f8 sz, tmin, tmax, best, reach;
  f8 inv[3], enter[3], leave[3];
  float large;
} leaf_tests;

SIMD void tests_walk_axis(leaf_tests *of, const wide_walk *w, int k) {
  of->inv[k] = f8_all(w->inv[w->axis[k]]);
  of->enter[k] = f8_all(w->enter[w->axis[k]]);
  of->leave[k] = f8_all(w->leave[w->axis[k]]);
}

// One ray eight times.
SIMD void tests_of_walk(leaf_tests *of, const wide_walk *w) {
  of->rays = walk_rays(w);
  of->sz = f8_all(w->sz);
  of->tmin = f8_all(w->tmin);
  of->tmax = f8_all(w->tmax);
  of->best = f8_all(w->best.t);
  of->reach = f8_all(w->reach);
  tests_walk_axis(of, w, 0);
  tests_walk_axis(of, w, 1);
  tests_walk_axis(of, w, 2);
  of->large = w->large;
}

SIMD void tests_packet_axis(leaf_tests *of, const packet *p, int i, int k) {
  const packet_axis *x = &p->axis[p->turned[k]];
  of->inv[k] = f8_load(x->inv + i);
  of->enter[k] = f8_load(x->enter + i);
  of->leave[k] = f8_load(x->leave + i);
}

// Half h of a packet.
SIMD void tests_of_packet(leaf_tests *of, const packet *p, int h) {
  int i = HALF * h;
  of->rays = (leaf_rays){
      {f8_load(p->o[0] + i), f8_load(p->o[1] + i), f8_load(p->o[2] + i)},
      f8_load(p->sx + i),
      f8_load(p->sy + i)};
  of->sz = f8_load(p->sz + i);
  of->tmin = f8_load(p->tmin + i);
  of->tmax = f8_load(p->tmax + i);
  of->best = f8_load(p->until + i);
  of->reach = f8_load(p->reach + i);
  tests_packet_axis(of, p, i, 0);
  tests_packet_axis(of, p, i, 1);
  tests_packet_axis(of, p, i, 2);
  of->large = p->large;
}

// Eight rays of any directions.
SIMD void tests_of_walks(leaf_tests *of, const char *const row[8],
                         float large) {
  f8 v[8], w[8];
  f8_columns(v, row, 0);
  of->rays = (leaf_rays){{v[0], v[1], v[2]}, v[3], v[4]};
  of->sz = v[5];
  of->tmin = v[6];
  of->tmax = v[7];
  f8_columns(v, row, sizeof(f8));
  f8_columns(w, row, 2 * sizeof(f8));
  turn_axes(of->inv, v, v[7], w[3]);
  turn_axes(of->enter, v + 4, v[7], w[3]);
  turn_axes(of->leave, w, v[7], w[3]);
  of->reach = v[3];
  of->best = w[4];
  of->large = large;
}

#endif
