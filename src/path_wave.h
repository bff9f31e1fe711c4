// path_wave.h — many paths that take their steps together: what there is of
// them between two steps, and the light that their rays meet.

#ifndef PATH_WAVE_H
#define PATH_WAVE_H

#include "path_tracer.h"

// A path between two waves.
typedef struct path {
  sampler numbers;
  vec3 sum, throughput;
  vec3 from, from_n;  // where the last direction was sampled, and the normal
  float pdf;          // of that direction; 0 where only a delta could give it
  float scale;        // of the throughput, for roulette and aiming
  int segment, inside;
  path_trail trail;
} path;

// Rays that have met a surface, and where: few enough for the fastest cache.
enum { MET = 64 };

typedef struct met {
  uint32_t which[MET];
  ray rays[MET];
  hit hits[MET];
  sampler numbers[MET], common[MET];  // those of matt ones: of the group
  vertex at[MET];
  path_ready ready[MET / LANES];
  bool asked[MET];  // whether light is what a light was asked for
  light_sample light[MET];
} met;

// Paths whose rays have met nothing, and where these look, one by one or all.
typedef struct missed {
  uint32_t which[MET];
  env_place at[MET];
  sky_looks all;
} missed;

_Static_assert((int)MET <= (int)LIGHT_TOGETHER, "what is asked together");

// A light sample on its way through the scene: what it brings if nothing is in
// between, to which path; and for sheets, from where to where.
typedef struct shadow {
  uint32_t path;
  vec3 lit;
  light_ray to;
  surface from;
  size_t record;  // in the log; PATH_NO_RECORD: none
} shadow;

// The room of one worker: paths, their rays, and light samples of this wave.
typedef struct wave {
  const path_tracer *by;
  path_stats *stats;
  bool sheets, lights;  // whether there are any
  bool lit;             // whether ready knows of lights
  bool together;        // whether lights are better asked by many at once
  bool asks;            // and by->sky does it
  bool looks;           // whether by->sky also looks
  bool even;            // a constant sky, for which no light is asked
  vec3 sky;
  sampler_kind kind;
  uint32_t uses;            // bits of the numbers that count at vertices
  const path_plain *plain;  // by material, or NULL
  path *paths;
  uint32_t *alive;
  ray *rays, *shadow_rays;
  uint32_t *left;  // by ray: the triangle that it climbs away from
  hit *hits;
  shadow *shadows;
  bool *blocked;
  met *met;
  path_ready *turns;  // of met, of one question after the other
  missed *missed;
  path_aims *aims;      // NULL: no ray is aimed
  path_shares *shares;  // NULL: nothing is shared
  size_t count, next, shadow_count;
  uint32_t steps;  // the rays of each path so far
} wave;

// The weight of a sample of density a where the other way to find it has
// density b.
static inline float wave_weight(float a, float b) {
  return b > 0 ? path_weight(b / a) : 1;
}

wave *wave_room(const path_tracer *by, arena *mem);

// What there is of lights and of sky, and how they are best asked.
void wave_survey(wave *w);

// Begin with n paths, those of pixel GROUP_NO_PIXEL left out.
void wave_begin(wave *w, const path_start *starts, size_t n);

// The ray of path `which` meets nothing: what it finds of the sky waits in
// w->missed, where n others are, for wave_meet_sky.  How many wait now.
size_t wave_miss(const wave *w, size_t n, uint32_t which, const ray *r);

// The sky, for the first n of w->missed; a glowing surface.
void wave_meet_sky(const wave *w, size_t n);
void wave_meet_glow(const wave *w, path *p, const vertex *v);

// Ray i of the wave meets a surface: n of w->met.  Vertices of the first n.
void wave_meet(const wave *w, size_t n, size_t i);
void wave_vertices(const wave *w, size_t n);

// Question i of several to lights: one that is matt knows its answer, if
// by->sky does.
stop wave_turn(const wave *w, const stop *s, uint32_t i);

// Ask lights at once for those of them that are matt, but for plain ones.
void wave_ask(const wave *w, size_t n);

// What path number i has brought since it was last asked; the first n paths.
vec3 wave_take(wave *w, size_t i);
void wave_take_all(wave *w, size_t n, vec3 *out);

#endif
