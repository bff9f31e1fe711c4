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
  vec3 p_smooth;  // p lifted onto the smooth surface that ns suggests
  vec3 ng, ns;
  vec2 uv;
  vec3 color;  // interpolated vertex colour, 1 where there is none
  uint32_t triangle;
  const material *material;
} surface;

// The surface at a hit of a ray with direction d on scene s.
surface surface_at(const scene *s, const hit *h, vec3 d);

// A ray that leaves the surface along unit w from p, displaced along ng by no
// more than p's error: it does not meet the triangle it left, and does not
// start behind anything else.
ray surface_ray(const surface *s, vec3 w);

// The same from p_smooth, for diffuse bounces and shadow rays on interpolated
// normals: the terminator follows the smooth surface, not the facets.
// Source: Hanika, "Hacking the Shadow Terminator", Ray Tracing Gems II, 2021.
ray surface_smooth_ray(const surface *s, vec3 w);

// The same towards the point q, ending just before it: tmax < 1 with d = q -
// origin.
ray surface_ray_to(const surface *s, vec3 q, bool smooth);

// ns bent towards ng just as far as it takes for the mirror direction of wo
// about it to lie on wo's side of the facet.  All unit, wo on ng's side after
// flipping.
vec3 surface_bend(vec3 ns, vec3 ng, vec3 wo);

// ns after bump or normal map, when the material has one.
vec3 surface_mapped_normal(const scene *s, const surface *at, const hit *h);

#endif
