// surface_normal.c — shading normals: bent, so that no direction about them
// ends on the wrong side of the facet; and read from textures.

#include "surface.h"

// A shading normal leans at most this far, as a cosine, from ng: 89.4 degrees.
// It keeps the two on one side after any rounding.
#define LEAN_MIN 0.01f

vec3 surface_lean(vec3 n, vec3 ng) {
  n = vec3_unit(n);
  float c = vec3_dot(n, ng);
  if (c >= LEAN_MIN) return n;
  vec3 across = vec3_mad(n, -c, ng);
  if (!(vec3_dot(across, across) > 0.5f)) return ng;  // also NaN
  return vec3_unit(vec3_mad(vec3_unit(across), LEAN_MIN, ng));
}

// Let n = ns + s ng, with a = wo.ns, b = wo.ng, c = ns.ng.  The cosine of the
// mirror direction, 2 (wo.n)(n.ng) / n.n - b, is t where
//   (b - t) s^2 + 2 (a - c t) s + (2 a c - b - t) = 0.
// A negative last term says that ns is on the wrong side of it; then exactly
// one root is positive.  Source: the aim is that of Keller et al., "The Iray
// Light Transport Simulation and Rendering System", 2017, section A.3.
vec3 surface_bend(vec3 ns, vec3 ng, vec3 wo) {
  float a = vec3_dot(wo, ns), b = vec3_dot(wo, ng), c = vec3_dot(ns, ng);
  if (!(b > 0)) return ng;
  float t = float_min(0.5f * b, SURFACE_CLEARANCE);
  float last = 2 * a * c - b - t;
  if (last >= 0) return ns;
  float half = a - c * t;
  float root = sqrtf(half * half - (b - t) * last);
  float s = half > 0 ? -last / (half + root) : (root - half) / (b - t);
  return vec3_unit(vec3_mad(ns, s, ng));
}

// Whether the refraction of wo about n crosses the facet of ng.  Total
// reflection has none that could fail to.
static bool crosses(vec3 n, vec3 ng, vec3 wo, float eta) {
  float cos_i = vec3_dot(wo, n);
  float square = (eta - 1) * (eta + 1) + cos_i * cos_i;
  if (square < 0) return true;
  return vec3_dot(wo, ng) + vec3_dot(n, ng) * (sqrtf(square) - cos_i) > 0;
}

vec3 surface_bend_glass(vec3 ns, vec3 ng, vec3 wo, float eta) {
  vec3 n = surface_bend(ns, ng, wo);
  if (eta >= 1 || crosses(n, ng, wo, eta)) return n;
  // ng itself always will do; halve the way to it 20 times.
  float no = 0, yes = 1;
  for (int i = 0; i < 20; i++) {
    float s = 0.5f * (no + yes);
    if (crosses(vec3_unit(vec3_lerp(n, ng, s)), ng, wo, eta))
      yes = s;
    else
      no = s;
  }
  return vec3_unit(vec3_lerp(n, ng, yes));
}

// A normal that faced away from wo gets this cosine to it.
#define FACE_MIN 0x1p-10f

vec3 surface_face(vec3 ns, vec3 wo) {
  float c = vec3_dot(ns, wo);
  if (c > 0) return ns;
  vec3 across = vec3_mad(ns, -c, wo);
  if (!(vec3_dot(across, across) > 0x1p-20f)) return wo;
  return vec3_unit(vec3_mad(vec3_unit(across), FACE_MIN, wo));
}

// The derivatives of position by texture coordinate over a triangle; false
// where the texture is degenerate.
static bool texture_frame(const mesh *m, uint32_t triangle, vec3 *dpdu,
                          vec3 *dpdv) {
  if (m->texcoord_index == NULL) return false;
  vec3 p[3];
  vec2 w[3];
  for (size_t i = 0; i < 3; i++) {
    size_t corner = 3 * (size_t)triangle + i;
    uint32_t k = m->texcoord_index[corner];
    if (k == MESH_NONE) return false;
    p[i] = m->positions[m->position_index[corner]];
    w[i] = m->texcoords[k];
  }
  vec3 e1 = vec3_sub(p[1], p[0]), e2 = vec3_sub(p[2], p[0]);
  float u1 = w[1].x - w[0].x, v1 = w[1].y - w[0].y;
  float u2 = w[2].x - w[0].x, v2 = w[2].y - w[0].y;
  float det = u1 * v2 - v1 * u2;
  if (!(fabsf(det) > 0)) return false;
  *dpdu = vec3_scale(vec3_mad(vec3_scale(e1, v2), -v1, e2), 1 / det);
  *dpdv = vec3_scale(vec3_mad(vec3_scale(e2, u1), -u2, e1), 1 / det);
  return vec3_finite(*dpdu) && vec3_finite(*dpdv);
}

// The slopes of the bump map by u and v, in world units of height: central
// differences over one texel.
static vec2 bump_slopes(const texture_map *m, vec2 uv) {
  float w = (float)m->image->width * fabsf(m->options.scale.x);
  float h = (float)m->image->height * fabsf(m->options.scale.y);
  if (!(w > 0 && h > 0)) return (vec2){0, 0};
  vec2 d = {0.5f / w, 0.5f / h};
  float du = texture_number(m, (vec2){uv.x + d.x, uv.y}) -
             texture_number(m, (vec2){uv.x - d.x, uv.y});
  float dv = texture_number(m, (vec2){uv.x, uv.y + d.y}) -
             texture_number(m, (vec2){uv.x, uv.y - d.y});
  float scale = m->options.bump;
  return (vec2){scale * du * w, scale * dv * h};
}

// Source: Mikkelsen, "Bump Mapping Unparametrized Surfaces on the GPU", 2010:
// the normal less the gradient of the height along the surface.
static vec3 bumped(const texture_map *m, vec2 uv, vec3 n, vec3 dpdu,
                   vec3 dpdv) {
  vec2 slope = bump_slopes(m, uv);
  vec3 across_v = vec3_cross(dpdv, n), across_u = vec3_cross(n, dpdu);
  float det = vec3_dot(dpdu, across_v);
  if (!(fabsf(det) > 0)) return n;
  vec3 gradient = vec3_add(vec3_scale(across_v, slope.x / det),
                           vec3_scale(across_u, slope.y / det));
  return vec3_unit(vec3_sub(n, gradient));
}

// Red along dpdu, green along dpdv, blue along n, each 2 x - 1.
static vec3 normal_mapped(const texture_map *m, vec2 uv, vec3 n, vec3 dpdu,
                          vec3 dpdv) {
  vec3 c = vec3_sub(vec3_scale(texture_rgb(m, uv), 2), vec3_all(1));
  vec3 t = vec3_unit(vec3_mad(dpdu, -vec3_dot(dpdu, n), n));
  vec3 b = vec3_cross(n, t);
  if (vec3_dot(b, dpdv) < 0) b = vec3_neg(b);
  vec3 along = vec3_add(vec3_scale(t, c.x), vec3_scale(b, c.y));
  return vec3_unit(vec3_mad(along, c.z, n));
}

vec3 surface_mapped_normal(const scene *s, const surface *at, const hit *h) {
  const material *m = at->material;
  if (m == NULL) return at->ns;
  bool bump = m->map_bump.image != NULL, norm = m->map_norm.image != NULL;
  vec3 dpdu, dpdv;
  if (!bump && !norm) return at->ns;
  if (!texture_frame(&s->mesh, h->triangle, &dpdu, &dpdv)) return at->ns;
  vec3 n = at->ns;
  if (norm) n = normal_mapped(&m->map_norm, at->uv, n, dpdu, dpdv);
  if (bump) n = bumped(&m->map_bump, at->uv, n, dpdu, dpdv);
  return surface_lean(n, at->ng);
}
