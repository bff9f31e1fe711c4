// wide_few_all.h — any number of rays and all triangles.

#ifndef WIDE_FEW_ALL_H
#define WIDE_FEW_ALL_H

#include "wide_few_leaf.h"
#include "wide_few_ready.h"

// What stops them, leaf by leaf.
SIMD void few_trace(const few_leaves *l, few_rays *r) {
  for (uint32_t i = 0; i < l->count && r->alive != 0; i++) {
    uint32_t m = few_enter(l, i, r) & r->alive, child = l->child[i];
    uint32_t n = wide_leaf_count(child);
    const uint32_t *leaf =
        l->t->triangles + 10 * (size_t)wide_leaf_first(child);
    for (uint32_t k = 0; k < n && m != 0; k++) {
      uint32_t stopped = few_stopped(r, leaf, n, k, m);
      m &= ~stopped;
      r->alive &= ~stopped;
    }
  }
}

// The longest axis of d, as ray_shear_of has it.
SIMD uint32_t longest_axis(vec3 d) {
  vec3 a = vec3_abs(ray_flush(d));
  uint32_t xz = a.x > a.z ? 0 : 2, yz = a.y > a.z ? 1 : 2;
  return a.x > a.y ? xz : yz;
}

// All n rays.  Never inlined: alone it has more registers.
APART void few_run(const wide_tree *t, const ray *rays, bool *blocked,
                   size_t n) {
  few_leaves l;
  few_rays r;
  uint32_t list[3][FEW_RAYS];
  few_leaves_of(&l, t);
  for (size_t from = 0; from < n; from += FEW_RAYS) {
    uint32_t count[3] = {0};
    size_t size = n - from < FEW_RAYS ? n - from : FEW_RAYS;
    for (uint32_t i = 0; i < size; i++) {
      uint32_t axis = longest_axis(rays[from + i].d);
      list[axis][count[axis]++] = i;
    }
    for (uint32_t axis = 0; axis < 3; axis++)
      for (uint32_t i = 0; i < count[axis]; i += 8) {
        uint32_t left = count[axis] - i, some = left < 8 ? left : 8;
        r.axis = turned_axes[axis];
        few_ready(&r, &l, rays + from, list[axis] + i, some);
        uint32_t can = r.alive;
        few_trace(&l, &r);
        for (uint32_t k = 0; k < some; k++)
          blocked[from + list[axis][i + k]] = ((can & ~r.alive) >> k & 1) != 0;
      }
  }
}

#endif
