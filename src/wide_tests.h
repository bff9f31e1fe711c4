// wide_tests.h — eight tests at once: a ray with each triangle of a leaf, or
// rays of a packet each with a triangle.

#ifndef WIDE_TESTS_H
#define WIDE_TESTS_H

#include "wide_edges.h"
#include "wide_packet.h"

// Where the numbers of eight tests lie: one ray and the n triangles of a leaf;
// or, where p is not NULL, half h of a packet and a triangle for each of its
// rays, corners by axis.
typedef struct leaf_tests {
  const wide_walk *w;
  const uint32_t *leaf;
  size_t n;
  const packet *p;
  int h;
  f8 (*corner)[3];
} leaf_tests;

SIMD f8 tests_corner(const leaf_tests *of, size_t i, uint32_t axis) {
  return of->p ? of->corner[i][axis] : leaf_load(of->leaf, of->n, i, axis);
}

// Of eight rays, or eight times one.
SIMD f8 tests_pick(const leaf_tests *of, const float *each, const float *one) {
  return of->p ? f8_load(each + HALF * of->h) : f8_all(*one);
}

// A number of the rays: where a packet has it, and where a walk has it.
#define TESTS_RAYS(of, in_packet, in_walk) \
  tests_pick(of, (of)->p ? (of)->p->in_packet : NULL, \
             (of)->p ? NULL : &(of)->w->in_walk)

#endif
