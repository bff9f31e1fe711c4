// surface.h — what a hit is made of: position with its error, the two
// normals, texture coordinates; and how a ray leaves it again.

#ifndef SURFACE_H
#define SURFACE_H

#include "scene.h"

// A hit point.  ng is the normal of the flat triangle by its winding, ns the
// interpolated one bent nowhere yet, on the same side as ng; both unit.
typedef struct surface {
  vec3 p;         // from the barycentric weights, not from o + t d
  vec3 p_error;   // |true point - p| <= p_error, componentwise
  vec3 p_smooth;  // p lifted clear of the smooth surface that ns means, on
                  // the side that the ray came from
  vec3 inward;    // a step of a few p_errors towards the triangle's middle
  vec3 ng, ns;
  bool front;   // the ray came from ng's side
  bool smooth;  // some corner has a normal of its own
  vec2 uv;
  vec3 color;  // interpolated vertex colour, 1 where there is none
  uint32_t triangle;
  const material *material;  // NULL when the scene has none
} surface;

// The surface at a hit of a ray with direction d on scene s.
surface surface_at(const scene *s, const hit *h, vec3 d);

// The part of that which is not geometry: uv, colour, material.
void surface_paint(surface *at, const scene *s, const hit *h);

// A ray that leaves the surface along unit w from p, displaced along ng and
// inwards by a few of p's errors: it does not meet the triangle it left, and
// does not start behind anything else.  It starts on the side of w.
ray surface_ray(const surface *s, vec3 w);

// The same from p_smooth, for diffuse bounces and shadow rays on interpolated
// normals: the terminator follows the smooth surface, not the facets.  It
// starts on the side that the ray came from whatever w is: a diffuse direction
// above the horizon of ns and below the facet stays outside.
// Source: Hanika, "Hacking the Shadow Terminator", Ray Tracing Gems II, 2021.
ray surface_smooth_ray(const surface *s, vec3 w);

// Where a shadow ray ends, as a share of its way: 1 less the 16 roundings that
// the difference q - o and the hit distance may have between them.
#define SURFACE_SHADOW_END (1 - 0x1p-20f)

// The same towards the point q, ending just before it: tmax < 1 with d = q -
// origin.
ray surface_ray_to(const surface *s, vec3 q, bool smooth);

// Unit; n, or, where that leans too far from ng, as near to n as is allowed.
vec3 surface_lean(vec3 n, vec3 ng);

// A bent mirror direction clears the facet by this much, as a cosine, or by
// half of what wo itself does when that is less.
#define SURFACE_CLEARANCE 0.01f

// ns bent towards ng just as far as it takes for the mirror direction of wo
// about it to lie on wo's side of the facet.  All unit, wo on ng's side after
// flipping.  wo . result > 0 when wo . ng > 0.
vec3 surface_bend(vec3 ns, vec3 ng, vec3 wo);

// surface_bend, and then as far as it takes for the refracted direction to
// cross the facet; eta is the index on the far side over that on wo's side.
vec3 surface_bend_glass(vec3 ns, vec3 ng, vec3 wo, float eta);

// ns turned just far enough to face wo, for lobes that need no mirror
// direction: wo . result > 0.
vec3 surface_face(vec3 ns, vec3 wo);

// ns after bump or normal map, when the material has one.
vec3 surface_mapped_normal(const scene *s, const surface *at, const hit *h);

// Unit w, moved as little as it takes to lie on the side of the facet that wo
// is on (transmitted: the other one).  It makes up for the last bits of a
// sampled direction, so that no path is ever lost to them.
vec3 surface_keep_side(const surface *s, vec3 w, bool transmitted);

#endif
