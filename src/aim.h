// aim.h — from where a lamp is seen in glass or in a mirror, and in which
// directions.

#ifndef AIM_H
#define AIM_H

#include "arena.h"
#include "vec.h"

#include <stdint.h>

// The most spheres of a cell.
enum { AIM_SPHERES = 8 };

// What a cell aims at: spheres, by columns, and the sums of their
// probabilities up to each.  root and least say what a ray is worth: S is the
// mean square that one aimed ray brings to a white matt surface, B that of a
// scattered ray.
typedef struct aim_cell {
  uint32_t count;     // 0: nothing to aim at
  float root, least;  // sqrt(S), S / B
  float upto[AIM_SPHERES];
  float x[AIM_SPHERES], y[AIM_SPHERES], z[AIM_SPHERES], radius[AIM_SPHERES];
} aim_cell;

// A box halved at a coordinate on an axis, with two children from `next` on;
// or, where axis is AIM_LEAF, cell number `next`.
typedef struct aim_node {
  float at;
  uint32_t axis, next;
} aim_node;

enum { AIM_LEAF = 3 };

// A tree over the places of surfaces for each light_side that they may face;
// the roots are the first nodes.
typedef struct aim_map {
  aim_node *nodes;
  aim_cell *cells;
  float keen;  // 1 / sqrt(what a ray must take away), see aim_asked
} aim_map;

// The cell of a place; NULL where there is nothing to aim at.
const aim_cell *aim_at(const aim_map *m, vec3 p, vec3 n);

// The most rays aimed at once.
enum { AIM_RAYS = 16 };

// How many rays, on average, a path of that throughput aims.
float aim_asked(const aim_map *m, const aim_cell *c, float throughput);

// How much so many take away from the mean square.
float aim_gain(const aim_cell *c, float asked, float throughput);

// A direction from o by three numbers of [0, 1): a sphere, and uniform over
// what o sees of it; *pdf is its density per steradian, over all spheres.
vec3 aim_sample(const aim_cell *c, vec3 o, vec3 u, float *pdf);

// That density in direction wi.
float aim_pdf(const aim_cell *c, vec3 o, vec3 wi);

// 1 less the cosine of half the angle under which a sphere is seen whose
// middle is d away: 2 from inside.
float aim_cone(vec3 d, float radius);

#endif
