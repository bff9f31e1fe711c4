// wide_distance.h — where a ray meets up to eight triangles: triangle_hit and
// slab_hold in their very arithmetic, for those that floats decide.

#ifndef WIDE_DISTANCE_H
#define WIDE_DISTANCE_H

#include "wide_tests.h"

// The largest magnitude of three.
SIMD f8 f8_peak(const f8 v[3]) {
  return f8_max(f8_max(f8_abs(v[0]), f8_abs(v[1])), f8_abs(v[2]));
}

// t_error of triangle.c.
SIMD f8 leaf_error(const leaf_shear *c, f8 det) {
  f8 g2 = f8_all(2 * 0x1p-24f), g3 = f8_all(3 * 0x1p-24f);
  f8 g5 = f8_all(5.1f * 0x1p-24f), two = f8_all(2), three = f8_all(3);
  f8 mx = f8_peak(c->x), my = f8_peak(c->y), mz = f8_peak(c->z);
  f8 me = f8_peak(c->e);
  f8 dz = f8_mul(g3, mz), dx = f8_mul(g5, f8_add(mx, mz));
  f8 dy = f8_mul(g5, f8_add(my, mz));
  f8 de = f8_add(f8_mul(f8_mul(g2, mx), my), f8_mul(dy, mx));
  de = f8_mul(two, f8_add(de, f8_mul(dx, my)));
  f8 sum = f8_add(f8_mul(f8_mul(g3, me), mz), f8_mul(de, mz));
  sum = f8_mul(three, f8_add(sum, f8_mul(dz, me)));
  return f8_div(sum, f8_abs(det));
}

// What the rounding of edge function i may change of t det, in roundings;
// j and k are its corners.
SIMD f8 leaf_loss(const leaf_shear *c, f8 t, int i, int j, int k) {
  f8 sum = f8_add(f8_abs(f8_mul(c->x[k], c->y[j])),
                  f8_abs(f8_mul(c->y[k], c->x[j])));
  sum = f8_add(sum, f8_abs(c->e[i]));
  return f8_mul(sum, f8_abs(f8_sub(c->z[i], t)));
}

// Whether the t of single precision is within 12 roundings of `reach` of where
// the ray meets the triangle.  Then holding it to that point, as slab_hold does
// for large triangles, changes nothing: the margins of slab_ray are wider.
SIMD uint32_t leaf_firm(const leaf_shear *c, const f8 ez[3], f8 t, f8 size,
                        f8 reach) {
  f8 loss = f8_add(leaf_loss(c, t, 0, 1, 2), leaf_loss(c, t, 1, 2, 0));
  loss = f8_add(loss, leaf_loss(c, t, 2, 0, 1));
  f8 sum = f8_add(f8_add(f8_abs(ez[0]), f8_abs(ez[1])), f8_abs(ez[2]));
  loss = f8_add(loss, f8_mul(f8_all(5), sum));
  loss = f8_add(loss, f8_mul(f8_all(3), f8_mul(f8_abs(t), size)));
  loss = f8_add(loss, f8_all(FLT_MIN * 0x1p6f));
  return f8_lt(loss, f8_mul(f8_mul(f8_all(12), reach), size)) &
         f8_lt(f8_all(0x1p-90f), reach);
}

// Where the lines of the rays enter and leave the boxes of the triangles
// themselves, one axis, and the longest side so far: slab_hold of slab.c.
SIMD void leaf_slab(f8 *near, f8 *far, f8 *side, const leaf_tests *of, int k) {
  f8 a = of->at.of[k], b = of->at.of[3 + k], c = of->at.of[6 + k];
  f8 inv = of->inv[k], zero = f8_all(0);
  f8 lo = f8_min(f8_min(a, b), c), hi = f8_max(f8_max(a, b), c);
  f8 in = f8_where_lt(inv, zero, hi, lo), out = f8_where_lt(inv, zero, lo, hi);
  in = f8_mul(f8_sub(in, of->enter[k]), inv);
  out = f8_mul(f8_sub(out, of->leave[k]), inv);
  *near = f8_max(in, *near);
  *far = f8_min(out, *far);
  *side = f8_max(f8_sub(hi, lo), *side);
}

// What is known of the candidates of a leaf: t and the weights of the second
// and third corner; `hits` by triangle_hit and slab_hold, where single
// precision decides; the others in `unsure`, and of these in `close` those of
// which only t is not known, because its error reaches 0.
typedef struct leaf_found {
  float t[8], b1[8], b2[8];
  uint32_t hits, unsure, close;
} leaf_found;

// Of the candidates m; c is from leaf_edges.
SIMD void leaf_distances(leaf_found *out, leaf_shear *c, const leaf_tests *of,
                         uint32_t m) {
  f8 zero = f8_all(0), infinite = f8_all(INFINITY);
  f8 det = f8_add(f8_add(c->e[0], c->e[1]), c->e[2]), size = f8_abs(det);
  c->z[0] = f8_mul(of->sz, c->z[0]);
  c->z[1] = f8_mul(of->sz, c->z[1]);
  c->z[2] = f8_mul(of->sz, c->z[2]);
  const f8 ez[3] = {f8_mul(c->e[0], c->z[0]), f8_mul(c->e[1], c->z[1]),
                    f8_mul(c->e[2], c->z[2])};
  f8 t = f8_div(f8_add(f8_add(ez[0], ez[1]), ez[2]), det);
  f8 small = f8_min(f8_min(f8_abs(c->e[0]), f8_abs(c->e[1])), f8_abs(c->e[2]));
  f8 error = leaf_error(c, det);
  uint32_t clear = f8_lt(zero, small) & f8_lt(f8_all(FLT_MIN * 0x1p24f), size) &
                   f8_lt(size, infinite);
  uint32_t sure = clear & f8_lt(error, f8_abs(t));
  f8 near = f8_all(-INFINITY), far = infinite, side = zero;
  leaf_slab(&near, &far, &side, of, 0);
  leaf_slab(&near, &far, &side, of, 1);
  leaf_slab(&near, &far, &side, of, 2);
  uint32_t in = m & f8_lt(zero, t) & f8_le(of->tmin, t) & f8_le(t, of->tmax) &
                f8_lt(t, infinite) & f8_le(near, far) & f8_le(near, of->best);
  // Held to a point, t stays in the span of the triangle's box.
  uint32_t held = f8_le(side, f8_all(of->large));
  if ((in & sure & ~held) != 0)
    held |= leaf_firm(c, ez, t, size, of->reach) &
            f8_le(f8_all(FLT_MIN), f8_abs(of->sz));
  out->unsure = m & (~sure | (in & ~held));
  out->close = m & clear & f8_le(f8_abs(t), error) & f8_lt(error, infinite);
  t = f8_min(far, f8_max(near, t));
  f8_store(out->t, t);
  f8_store(out->b1, f8_div(c->e[1], det));
  f8_store(out->b2, f8_div(c->e[2], det));
  out->hits = in & sure & held & f8_le(of->tmin, t) & f8_le(t, of->tmax) &
              f8_le(t, of->best);
}

#endif
