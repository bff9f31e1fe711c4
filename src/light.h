// light.h — all the lights of a scene: where to look for light from a point.

#ifndef LIGHT_H
#define LIGHT_H

#include "light_env.h"
#include "light_memory.h"
#include "light_sky.h"
#include "light_tree.h"
#include "rng.h"
#include "scene.h"

#include <string.h>

// A directional light.
typedef struct light_far {
  vec3 wi, irradiance;  // towards it; on a facing plane
  float power;          // mean of R, G, B
} light_far;

// An emitter by the triangle of the mesh that it is.
typedef struct light_name {
  uint32_t triangle, emitter;
} light_name;

typedef struct light_set {
  const scene *scene;
  light_env env;
  light_far *far;
  size_t far_count;
  light_tree near;    // shining triangles and point lights
  light_name *names;  // of the triangles, rising
  size_t name_count;
  light_parts parts;           // of near
  light_env whole;             // all of env
  light_sky sky;               // the parts of that; count 0: not cut
  const light_memory *memory;  // of one or the other; NULL: none
} light_set;

// What shines in a scene, which must stay: triangles with emission, always;
// point and directional lights where lights_on; what of the environment is
// worth looking for, where env_on.
void light_set_build(light_set *out, const scene *s, bool lights_on,
                     bool env_on, arena *mem, pool *threads);

// Whether there is anything to sample at all.
bool light_set_any(const light_set *l);

// Cut near, or env, into parts; a memory of them that has learned nothing, in
// mem.  The box is the scene's.  NULL when they are not such that they could be
// remembered.
light_memory *light_set_cut(light_set *l, vec3 lo, vec3 hi, arena *mem);
light_memory *light_set_cut_sky(light_set *l, vec3 lo, vec3 hi, arena *mem,
                                pool *threads);

// One direction in which there may be light.  Where nothing is in between,
// f(wo, wi) cos radiance / pdf estimates the light from all lights that
// light_pdf_* knows of, and from the deltas.
typedef struct light_sample {
  vec3 wi;        // unit
  vec3 radiance;  // along -wi; of a delta the irradiance on a facing plane
  float pdf;      // per steradian; of a delta the probability to choose it
  bool delta;     // a point or a direction: no scattered ray finds it
  bool has_end;   // the light is at `to`; else it comes from everywhere
  vec3 to;
  uint32_t part;  // of the memory; LIGHT_NO_PART: none
  float chosen;   // the probability of that part
} light_sample;

#define LIGHT_NO_PART UINT32_MAX

// u.x with digits that a float has not, so that each of a million lights gets
// its share: they are drawn from the digits of all three.
static inline double light_finer(vec3 u) {
  uint32_t bits[3];
  memcpy(bits, &u, sizeof bits);
  uint64_t z = rng_mix(((uint64_t)bits[0] << 32 | bits[1]) +
                       bits[2] * UINT64_C(0x9e3779b97f4a7c15));
  return (double)u.x + (double)(z >> 32) * 0x1p-56;
}

// Choose by u, three numbers of [0, 1): light, then direction.  n is the
// normal of what is lit at p from the side of n only; zero when it lets light
// through.  A light that is only partly opaque shines as much less.  False, and
// pdf 0, when no light was found.
bool light_sample_at(const light_set *l, vec3 p, vec3 n, vec3 u,
                     light_sample *out);

// The same for n questions, which wait for the tables of the environment
// together.
typedef struct light_question {
  vec3 p, n, u;
} light_question;

void light_samples_at(const light_set *l, const light_question *q, size_t n,
                      light_sample *out);

// The same but for directions of the environment: true where such a one is left
// to be found, of out->part with probability out->chosen.
bool light_ask_all_but_env(const light_set *l, const light_question *q,
                           light_sample *out);

// The density with which light_sample_at, for the same p and n, gives the
// direction to the point q of a triangle, by that triangle; 0 when it does not
// shine this way, or leaves it to scattered rays to find that out.
float light_pdf_triangle(const light_set *l, vec3 p, vec3 n, uint32_t triangle,
                         vec3 q);

// The share of choices that goes evenly to all kinds of light that there are:
// nobody knows what is in between.
#define LIGHT_EVEN_SHARE 0.2f

// The probability that light_sample_at asks the environment.
float light_env_share(const light_set *l, vec3 p, vec3 n);

// The same for the environment in the unit direction whose env_uv is uv.
float light_pdf_env(const light_set *l, vec3 p, vec3 n, vec2 uv);

#endif
