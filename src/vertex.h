// vertex.h — where a path meets a surface, and how it leaves it.

#ifndef VERTEX_H
#define VERTEX_H

#include "path_world.h"

// A hit seen from where the ray came from: unit wo, the two normals turned to
// that side, and the frame about the normal n that scatters.
typedef struct vertex {
  surface at;
  vec3 wo, ng, ns;
  vec3 n, t, b;
} vertex;

// At a hit of a ray with direction d; n, t and b come with vertex_matter.
vertex vertex_at(const scene *s, const hit *h, vec3 d);

// Ask the memory for what vertex_at will read first.  Inline always: GCC drops
// the call of a function that does nothing but ask.
static inline void vertex_expect(const scene *s, uint32_t triangle)
    __attribute__((always_inline));
static inline void vertex_expect(const scene *s, uint32_t triangle) {
  const mesh *m = &s->mesh;
  size_t at = 3 * (size_t)triangle;
  __builtin_prefetch(m->position_index + at);
  if (m->normal_index != NULL) __builtin_prefetch(m->normal_index + at);
  if (s->material_of != NULL) __builtin_prefetch(s->material_of + triangle);
}

// The part of that which comes last: the two normals of v->at, turned.
void vertex_face(vertex *v, const scene *s, const hit *h);

// The matter that the path meets there, chosen by u, with glass.eta as seen
// from wo's side; sets the frame that suits it.
matter vertex_matter(vertex *v, const dfg *table, float u);

// Directions to the frame and back, unit.
vec3 vertex_local(const vertex *v, vec3 w);
vec3 vertex_world(const vertex *v, vec3 w);

// Reflections inside glass since the last other event: light goes straight out
// after so many (see chapter 9).
enum { VERTEX_TRAPPED_AFTER = 256 };

// The ray that goes on along d, sampled from b; counts in *inside.  incoming is
// the direction of the ray that came.
ray vertex_leave(const vertex *v, const bsdf *b, const bsdf_sample *d,
                 vec3 incoming, int *inside);

// What one shadow ray is about: the direction to a light, what arrives on a
// facing plane, and where the light is unless it is infinitely far.
typedef struct light_ray {
  bool is_point;
  vec3 to, wi, power;
} light_ray;

// A point or directional light seen from p.
light_ray light_ray_of(const light *l, vec3 p);

// The ray to it; it ends just before the light.
ray light_ray_shadow(const light_ray *l, const surface *from, bool smooth);

// Whether the scene has surfaces that let light straight through.
bool scene_has_sheets(const scene *s);

// What the sheets in the way of a shadow ray that meets something let through:
// 0 where a surface without holes is among them.
float light_ray_through(const light_ray *l, const path_world *w,
                        const surface *from, path_stats *stats);

#endif
