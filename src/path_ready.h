// path_ready.h — what is found of sixteen vertices together, before their
// paths go on one by one.

#ifndef PATH_READY_H
#define PATH_READY_H

#include "lanes.h"
#include "light.h"
#include "path_plain.h"
#include "path_world.h"
#include "sampler.h"
#include "vertex.h"

// The dimensions of one vertex, counted from 2: the first two place the sample
// in its pixel.  The direction comes first, because the first dimensions of a
// sequence are its best.
enum {
  USE_DIRECTION = 0,  // two
  USE_LIGHT = 2,      // two
  USE_PICK = 4,
  USE_LOBE = 5,
  USE_MATTER = 6,
  USE_LIFE = 7,  // opacity, roulette
  USES = 8       // what sampler_8 gives
};

_Static_assert((int)SAMPLER_TURN_FROM == 2 + (int)USE_DIRECTION &&
                   (int)SAMPLER_TURN_EACH == (int)USES,
               "directions turn");

// A lane a vertex.  The numbers of all; the rest of those that are matt, which
// have one lobe and no bumps.
typedef struct path_ready {
  float u[USES][LANES];
  int32_t matt[LANES];
  int32_t plain[LANES];  // plain_kind: whose vertex was not written down
  int32_t held[LANES];   // glass that reflects inwards
  lanes3 p, n;           // the point and the normal that scatters
  lanes3 kd, from;       // albedo; where rays leave
  bool lit;              // whether lights were asked
  // The answer of light_sample_at; the cosine of wi to the normal.
  int32_t found[LANES], delta[LANES], has_end[LANES];
  uint32_t part[LANES];
  lanes3 wi, to, radiance;
  float pdf[LANES], chosen[LANES], cosine[LANES];
  // What bsdf_sample_wi gives, in the world.
  lanes3 leave, weight;
  float leave_pdf[LANES];
  uint32_t left[LANES];  // the triangle that this ray climbs away from
} path_ready;

// A vertex of a path, the numbers for it, and a lane where more is known.
typedef struct stop {
  uint32_t which;  // of the paths
  vertex *at;
  float u[USES];
  const path_ready *ready;  // NULL: nothing
  int lane;
  bool lit;  // also of light
} stop;

// Vertices to be found.  Lights are asked where `lights` is not NULL: then
// path_ready_lights holds for them.
typedef struct ready_job {
  const scene *scene;
  const light_set *lights;
  const path_plain *plain;  // by material; NULL: all vertices are looked at
  uint32_t dimension;       // of the first number
  uint32_t uses;            // bits of the numbers that count; 0: all
  const hit *hits;
  const ray *rays;
  const sampler *numbers, *toward;  // those of directions; NULL: no others
  vertex *at;                       // complete, with the frame where it is matt
  path_ready *ready;                // LANES vertices each
} ready_job;

typedef void ready_function(const ready_job *j, size_t n);

// The numbers of vertex i; all vertices one by one, and none of them matt.
void path_ready_draw(const ready_job *j, size_t i, float u[USES]);
void path_ready_alone(const ready_job *j, size_t n);

// Where the samples of a row begin, by the Sobol' sequence of that seed.
typedef void starts_function(uint64_t seed, const path_row *row,
                             path_start *out);

stop path_ready_stop(vertex *at, const path_ready *r, int lane);

// The stop with the numbers for question i of so many to lights: number i of as
// many equal parts of [0, 1) chooses the light, and the point on it moves on.
stop path_ready_turn(const stop *s, uint32_t i, uint32_t turns);

// The same for n vertices.
void path_ready_turns(path_ready *to, const path_ready *of, size_t n,
                      uint32_t i, uint32_t turns);

// What a stop asks of the lights.
light_question path_ready_question(const stop *s);

// What a light sample meets at a surface: the cosine to it, f, and the density
// with which the BSDF would have found it.
typedef struct meeting {
  float cosine, pdf;
  vec3 f;
} meeting;

// What a stop that is lit knows: the light sample, false where there is none or
// it comes from behind; and the shadow ray to it.
bool path_ready_light(const stop *s, light_sample *l, meeting *m);
ray path_ready_shadow(const stop *s);

// What a stop that is ready knows: the ray that goes on; sets weight and pdf of
// its direction.
ray path_ready_leave(const stop *s, bsdf_sample *d);

// Whether all lights are triangles.
bool path_ready_lights(const light_set *l);

#endif
