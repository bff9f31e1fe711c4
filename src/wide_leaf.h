// wide_leaf.h — a ray and a leaf.

#ifndef WIDE_LEAF_H
#define WIDE_LEAF_H

#include "wide_distance.h"

// The corners of triangle i of the n of a leaf.
SIMD void leaf_corners(vec3 p[3], const uint32_t *leaf, size_t n, uint32_t i) {
  for (uint32_t k = 0; k < 3; k++, leaf += 3 * n) {
    memcpy(&p[k].x, leaf + i, sizeof(float));
    memcpy(&p[k].y, leaf + n + i, sizeof(float));
    memcpy(&p[k].z, leaf + 2 * n + i, sizeof(float));
  }
}

// h becomes the best hit if it is nearer, or as near and of a lower number.
SIMD bool hit_keep(hit *best, const hit *h) {
  if (h->t > best->t || (h->t == best->t && h->triangle > best->triangle))
    return false;
  *best = *h;
  return true;
}

// A candidate that single precision does not decide, in all the precision that
// it needs: triangle i of the n of a leaf; `close` as in leaf_found.
static bool leaf_one(const wide_walk *w, const leaf_tests *of, uint32_t i,
                     bool close, hit *h) {
  vec3 p[3];
  leaf_corners(p, of->leaf, of->n, i);
  ray r = w->r;
  r.d = ray_flush(r.d);
  if (close && !triangle_ahead(&r, p)) return false;
  slab_ray s = {.inv = {w->inv[0], w->inv[1], w->inv[2]},
                .o_enter = {w->enter[0], w->enter[1], w->enter[2]},
                .o_leave = {w->leave[0], w->leave[1], w->leave[2]},
                .x = 2 * w->side[0],
                .y = 4 + 2 * w->side[1],
                .z = 8 + 2 * w->side[2],
                .large = w->large};
  h->triangle = of->leaf[9 * of->n + i];
  return triangle_hit(&r, &w->shear, p[0], p[1], p[2], h) &&
         slab_hold(&s, &r, p, h);
}

// The candidates m of a leaf: whether there is a better hit, or with `any` one
// at all.
SIMD bool leaf_settle(wide_walk *w, leaf_shear *c, const uint32_t *leaf,
                      uint32_t n, uint32_t m, bool any) {
  float v[8], u[8];
  leaf_found f;
  bool found = false;
  const leaf_tests of = {.w = w, .leaf = leaf, .n = n};
  leaf_distances(&f, c, &of, m);
  m = f.hits;
  if (any && m != 0) return true;
  if (m != 0) {
    f8_store(u, c->e[1]);
    f8_store(v, c->e[2]);
  }
  for (; m != 0; m &= m - 1) {
    uint32_t i = (uint32_t)__builtin_ctz(m);
    hit h = {f.t[i], u[i] / f.det[i], v[i] / f.det[i], leaf[9 * n + i]};
    found |= hit_keep(&w->best, &h);
  }
  for (uint32_t unsure = f.unsure; unsure != 0; unsure &= unsure - 1) {
    hit h;
    uint32_t i = (uint32_t)__builtin_ctz(unsure);
    if (!leaf_one(w, &of, i, f.close >> i & 1, &h)) continue;
    if (any) return true;
    found |= hit_keep(&w->best, &h);
  }
  return found;
}

// Test the triangles of a leaf and keep the best hit: the smallest t, of equal
// t the lowest triangle.  With `any`, stop at the first.
SIMD bool walk_leaf(wide_walk *w, const wide_tree *t, uint32_t child,
                    bool any) {
  uint32_t n = wide_leaf_count(child);
  const uint32_t *leaf = t->triangles + 10 * (size_t)wide_leaf_first(child);
  leaf_shear c;
  leaf_rays r = walk_rays(w);
  uint32_t m = leaf_edges(&c, &r, w->axis, leaf, n);
  return m != 0 && leaf_settle(w, &c, leaf, n, m, any);
}

#endif
