// wide_box.h — a ray on its way, and the eight boxes of a node.
//
// Boxes may be tested in any arithmetic that is not narrower than slab.h.

#ifndef WIDE_BOX_H
#define WIDE_BOX_H

#include "simd.h"
#include "slab.h"
#include "triangle.h"
#include "wide_tree.h"

// What one ray needs on its way.
typedef struct wide_walk {
  ray r;
  ray_shear shear;
  slab_ray slab;
  uint32_t enter[3];  // which half of wide_node.plane[k] the ray enters by
  hit best;
} wide_walk;

// False for a ray that can hit nothing; the same ones as for a bvh.
SIMD bool walk_start(wide_walk *w, const wide_tree *t, const ray *r) {
  vec3 d = ray_flush(r->d);
  if (t->nodes == NULL || !vec3_finite(r->o) || !vec3_finite(d)) return false;
  if (d.x == 0 && d.y == 0 && d.z == 0) return false;
  w->r = (ray){r->o, d, r->tmin, r->tmax};
  w->shear = ray_shear_of(d);
  w->slab = slab_ray_of(r->o, d, &t->box);
  w->enter[0] = w->slab.x >> 4;
  w->enter[1] = w->slab.y >> 4;
  w->enter[2] = w->slab.z >> 4;
  w->best = (hit){.t = r->tmax, .triangle = HIT_NONE};
  return true;
}

// Cut the spans of eight boxes along one axis.
SIMD void cut_axis(f8 *near, f8 *far, const wide_node *n, int k,
                   const uint32_t *side, const float of[3]) {
  f8 base = f8_all(n->base[k]), scale = f8_all(n->scale[k]);
  f8 inv = f8_all(of[0]);
  f8 a = f8_of_bytes(n->plane[k][side[k]]);
  f8 b = f8_of_bytes(n->plane[k][side[k] ^ 1]);
  a = f8_sub(f8_add(base, f8_mul(a, scale)), f8_all(of[1]));
  b = f8_sub(f8_add(base, f8_mul(b, scale)), f8_all(of[2]));
  *near = f8_max(f8_mul(a, inv), *near);
  *far = f8_min(f8_mul(b, inv), *far);
}

// Which children the ray enters before its best hit, and where.
SIMD uint32_t cut_node(const wide_walk *w, const wide_node *n, float near[8]) {
  const slab_ray *s = &w->slab;
  f8 a = f8_all(w->r.tmin), b = f8_all(w->best.t);
  cut_axis(&a, &b, n, 0, w->enter,
           (float[3]){s->inv.x, s->o_enter.x, s->o_leave.x});
  cut_axis(&a, &b, n, 1, w->enter,
           (float[3]){s->inv.y, s->o_enter.y, s->o_leave.y});
  cut_axis(&a, &b, n, 2, w->enter,
           (float[3]){s->inv.z, s->o_enter.z, s->o_leave.z});
  f8_store(near, a);
  return f8_le(a, b) & ((1u << n->count) - 1);
}

#endif
