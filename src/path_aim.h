// path_aim.h — rays aimed at mirrors and glass, beside the scattered ones of a
// path, for the lamps that are seen in them.

#ifndef PATH_AIM_H
#define PATH_AIM_H

#include "aim.h"
#include "path_world.h"
#include "sampler.h"
#include "vertex.h"

// The weight of a sample where the other way to find it has so many times the
// density.  Source: Veach 1997, section 9.2.4, the power heuristic.
static inline float path_weight(float rival) {
  return 1 / (1 + rival * rival);
}

// Where a path last was on a surface that is no mirror, and how it could have
// come from there to what it finds by mirrors and glass alone.
typedef struct path_trail {
  const aim_cell *cell;  // NULL: nothing is aimed from there
  float asked;           // rays aimed there, on average
  float rival;           // density of its way by aiming over that by scattering
  uint32_t rays;         // of the path, up to there
} path_trail;

// The way of a path on from there: its next ray, of density pdf, has met a
// mirror or glass as its ray number `rays`.
void path_trail_turn(path_trail *t, float pdf, const ray *r, uint32_t rays);

// The weight of what it finds after so many rays, beside that of aimed rays.
float path_trail_weight(const path_trail *t, uint32_t rays);

// A path at such a surface: its number in the batch, and its state.
typedef struct path_stand {
  uint32_t path;
  const vertex *at;
  const bsdf *bsdf;
  vec3 throughput;
  sampler numbers;
  int segment;
  float scale;  // of the throughput, for how many rays it is worth
} path_stand;

// Aimed rays on their way, of one worker.
typedef struct path_aims path_aims;

// Room for those of INTEGRATOR_BATCH paths.
path_aims *path_aims_room(arena *mem);

// Begin a batch.  What aim_gain says of its rays is added to *gain, which may
// be NULL.
void path_aims_begin(path_aims *a, const aim_map *map, const path_world *world,
                     double *gain);

// Aim some rays of a path after so many others; once at most for a path until
// path_aims_run.
path_trail path_aims_ask(path_aims *a, const path_stand *s, uint32_t rays);

// Follow all of them to their ends.
void path_aims_run(path_aims *a, path_stats *stats);

// What they have brought to a path since this was last asked.
vec3 path_aims_take(path_aims *a, size_t path);

#endif
