// wide_leaf.h — a ray and a leaf.

#ifndef WIDE_LEAF_H
#define WIDE_LEAF_H

#include "wide_distance.h"

// h becomes the best hit if it is nearer, or as near and of a lower number.
SIMD bool hit_keep(hit *best, const hit *h) {
  if (h->t > best->t || (h->t == best->t && h->triangle > best->triangle))
    return false;
  *best = *h;
  return true;
}

// A triangle among others: coordinate k of corner i is at[(3 i + k) step], axes
// turned by the shear.
typedef struct leaf_triangle {
  const float *at;
  size_t step;
} leaf_triangle;

// A corner of it; axis k is axis[k] of the world.
SIMD vec3 triangle_corner(const leaf_triangle *of, size_t i,
                          const uint32_t axis[3]) {
  vec3 p;
  const float *at = of->at + 3 * i * of->step;
  memcpy((char *)&p + axis[0] * sizeof(float), at, sizeof(float));
  memcpy((char *)&p + axis[1] * sizeof(float), at + of->step, sizeof(float));
  memcpy((char *)&p + axis[2] * sizeof(float), at + 2 * of->step,
         sizeof(float));
  return p;
}

// One that single precision does not decide, in all the precision that it
// needs; `close` as in leaf_found.  Sets all of *h but its triangle.
static bool leaf_one(const wide_walk *w, const leaf_triangle *of, bool close,
                     hit *h) {
  vec3 p[3] = {triangle_corner(of, 0, w->axis), triangle_corner(of, 1, w->axis),
               triangle_corner(of, 2, w->axis)};
  ray r = *w->r;
  r.d = ray_flush(r.d);
  if (close && !triangle_ahead(&r, p)) return false;
  slab_ray s = {.inv = {w->inv[0], w->inv[1], w->inv[2]},
                .o_enter = {w->enter[0], w->enter[1], w->enter[2]},
                .o_leave = {w->leave[0], w->leave[1], w->leave[2]},
                .x = 2 * w->side[0],
                .y = 4 + 2 * w->side[1],
                .z = 8 + 2 * w->side[2],
                .large = w->large};
  ray_shear shear = {(int)w->axis[2], w->sx, w->sy, w->sz};
  return triangle_hit(&r, &shear, p[0], p[1], p[2], h) &&
         slab_hold(&s, &r, p, h);
}

// The triangle of lane k.
SIMD bool tests_one(const leaf_tests *of, const wide_walk *w, uint32_t k,
                    bool close, hit *h) {
  float all[9][8];
  memcpy(all, of->at.of, sizeof all);
  return leaf_one(w, &(leaf_triangle){&all[0][k], 8}, close, h);
}

// Test the triangles of a leaf and keep the best hit: the smallest t, of equal
// t the lowest triangle.  With `any`, stop at the first.
SIMD bool walk_leaf(wide_walk *w, const wide_tree *t, uint32_t child,
                    bool any) {
  uint32_t n = wide_leaf_count(child);
  const uint32_t *leaf = t->triangles + 10 * (size_t)wide_leaf_first(child);
  leaf_shear c;
  leaf_tests of;
  leaf_found f;
  bool found = false;
  corners_load(&of.at, leaf, n, w->axis);
  of.rays = walk_rays(w);
  uint32_t m = leaf_edges(&c, &of.rays, &of.at) & ((1u << n) - 1);
  if (m == 0) return false;
  tests_of_walk(&of, w);
  leaf_distances(&f, &c, &of, m);
  if (any && f.hits != 0) return true;
  for (m = f.hits | f.unsure; m != 0; m &= m - 1) {
    uint32_t i = (uint32_t)__builtin_ctz(m);
    hit h = {f.t[i], f.b1[i], f.b2[i], leaf[9 * n + i]};
    bool unsure = f.unsure >> i & 1, close = f.close >> i & 1;
    if (unsure && !tests_one(&of, w, i, close, &h)) continue;
    if (any) return true;
    found |= hit_keep(&w->best, &h);
  }
  return found;
}

#endif
