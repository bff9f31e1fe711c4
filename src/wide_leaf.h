// wide_leaf.h — a ray and a leaf.

#ifndef WIDE_LEAF_H
#define WIDE_LEAF_H

#include "wide_distance.h"

// The corners of triangle i of the n of a leaf.
SIMD void leaf_corners(vec3 p[3], const uint32_t *leaf, uint32_t n,
                       uint32_t i) {
  for (uint32_t k = 0; k < 3; k++, leaf += 3 * (size_t)n) {
    memcpy(&p[k].x, leaf + i, sizeof(float));
    memcpy(&p[k].y, leaf + n + i, sizeof(float));
    memcpy(&p[k].z, leaf + 2 * (size_t)n + i, sizeof(float));
  }
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
  leaf_corners(p, leaf, n, i);
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

// Whether t_near_zero of triangle.c gives no t > 0 for triangle p.
static bool leaf_behind(const ray *r, const vec3 p[3]) {
  vec3 d = ray_flush(r->d);
  double ax = (double)p[0].x - (double)r->o.x,
         bx = (double)p[1].x - (double)p[0].x;
  double ay = (double)p[0].y - (double)r->o.y,
         by = (double)p[1].y - (double)p[0].y;
  double az = (double)p[0].z - (double)r->o.z,
         bz = (double)p[1].z - (double)p[0].z;
  double cx = (double)p[2].x - (double)p[0].x,
         cy = (double)p[2].y - (double)p[0].y;
  double cz = (double)p[2].z - (double)p[0].z;
  double x0 = by * cz, x1 = bz * cy, y0 = bz * cx, y1 = bx * cz;
  double z0 = bx * cy, z1 = by * cx;
  double nx = x0 - x1, ny = y0 - y1, nz = z0 - z1;
  double side = nx * ax + ny * ay + nz * az;
  double bound = 8 * 0x1p-53 *
                 ((fabs(x0) + fabs(x1)) * fabs(ax) +
                  (fabs(y0) + fabs(y1)) * fabs(ay) +
                  (fabs(z0) + fabs(z1)) * fabs(az));
  double speed = nx * (double)d.x + ny * (double)d.y + nz * (double)d.z;
  return (!(fabs(side) > bound)) | ((side < 0) & (speed > 0)) |
         ((side > 0) & (speed < 0));
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
    if ((f.close >> i & 1) != 0) {
      vec3 p[3];
      leaf_corners(p, leaf, n, i);
      if (leaf_behind(&w->r, p)) continue;
    }
    if (!leaf_one(w, leaf, n, i, &h)) continue;
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
