// wide_leaf.h — a ray and a leaf.

#ifndef WIDE_LEAF_H
#define WIDE_LEAF_H

#include "wide_distance.h"

static vec3 corner_of(const uint32_t *leaf, uint32_t n, uint32_t i) {
  vec3 p;
  memcpy(&p.x, leaf + i, sizeof(float));
  memcpy(&p.y, leaf + n + i, sizeof(float));
  memcpy(&p.z, leaf + 2 * (size_t)n + i, sizeof(float));
  return p;
}

// h becomes the best hit if it is nearer, or as near and of a lower number.
SIMD bool hit_keep(hit *best, const hit *h) {
  if (h->t > best->t || (h->t == best->t && h->triangle > best->triangle))
    return false;
  *best = *h;
  return true;
}

// The same for one triangle, in all the precision that it needs.
static bool leaf_one(const wide_walk *w, const uint32_t *leaf, uint32_t n,
                     uint32_t i, hit *h) {
  vec3 p[3];
  for (uint32_t k = 0; k < 3; k++)
    p[k] = corner_of(leaf + 3 * (size_t)k * n, n, i);
  h->triangle = leaf[9 * n + i];
  ray r = w->r;
  r.d = ray_flush(r.d);
  slab_ray s = {.inv = {w->inv[0], w->inv[1], w->inv[2]},
                .o_enter = {w->enter[0], w->enter[1], w->enter[2]},
                .o_leave = {w->leave[0], w->leave[1], w->leave[2]},
                .x = 2 * w->side[0],
                .y = 4 + 2 * w->side[1],
                .z = 8 + 2 * w->side[2],
                .large = w->large};
  return triangle_hit(&r, &w->shear, p[0], p[1], p[2], h) &&
         slab_hold(&s, &r, p, h);
}

// The candidates m of a leaf: whether there is a better hit, or with `any` one
// at all.
SIMD bool leaf_settle(wide_walk *w, leaf_shear *c, const uint32_t *leaf,
                      uint32_t n, uint32_t m, bool any) {
  float t[8], det[8], v[8], u[8];
  uint32_t unsure;
  bool found = false;
  const leaf_tests of = {.w = w, .leaf = leaf, .n = n};
  m = leaf_distances(c, &of, m, t, det, &unsure);
  if (any && m != 0) return true;
  if (m != 0) {
    f8_store(u, c->e[1]);
    f8_store(v, c->e[2]);
  }
  for (; m != 0; m &= m - 1) {
    uint32_t i = (uint32_t)__builtin_ctz(m);
    hit h = {t[i], u[i] / det[i], v[i] / det[i], leaf[9 * n + i]};
    found |= hit_keep(&w->best, &h);
  }
  for (; unsure != 0; unsure &= unsure - 1) {
    hit h;
    if (!leaf_one(w, leaf, n, (uint32_t)__builtin_ctz(unsure), &h)) continue;
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
