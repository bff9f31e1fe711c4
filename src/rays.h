// rays.h — sets of rays to measure a tracer with: made, read, traced, timed.

#ifndef RAYS_H
#define RAYS_H

#include "error.h"
#include "mesh.h"
#include "pool.h"
#include "ray.h"

// Rays that are all asked the same question.
typedef struct ray_set {
  ray *rays;
  size_t count;
  bool any;  // whether anything is hit; else the closest hit
} ray_set;

// Where rays of a renderer come from.  primary: one jittered ray a pixel of a
// camera outside the mesh, in tiles of 16 x 16.  ao: any hit, 16 cosine
// distributed rays from each primary hit.  aod: the same rays, 10 % of the
// diagonal long.  bounce: one such ray a hit, unlimited, shuffled.  random:
// between two points uniform in the bounding box.
typedef enum ray_kind {
  RAYS_PRIMARY,
  RAYS_AO,
  RAYS_AOD,
  RAYS_BOUNCE,
  RAYS_RANDOM,
  RAYS_KINDS  // how many there are
} ray_kind;

// The name of a kind as above, and the kind of a name; false for no such name.
const char *rays_kind_name(ray_kind kind);
bool rays_kind_of(ray_kind *out, const char *name);

// What rays_generate needs: a mesh, something that traces it, and the size.
typedef struct ray_source {
  const mesh *m;
  tracer tree;
  pool *threads;  // may be NULL
  int size;       // primary rays are size x size; 0: 1024
  size_t limit;   // at most about so many of the other kinds; 0: 2^20
} ray_source;

// Rays of one kind, the same for any number of threads and any correct tree.
// Empty when the mesh has no finite vertex.
void rays_generate(ray_set *out, ray_kind kind, const ray_source *from,
                   arena *mem);

// Trace all rays `repeat` times, after once for warming up, on all threads,
// and return the median of the seconds; with repeat 0, those of the warm-up.
// hits has s->count elements; a miss gets HIT_NONE and t = tmax, an occluded
// ray of an `any` set gets triangle 0 and t = tmax.
double rays_trace(hit *hits, const ray_set *s, tracer tree, pool *threads,
                  int repeat);

// How many of n hits are not HIT_NONE.
size_t rays_count_hits(const hit *hits, size_t n);

// A set as a file, little-endian: "RAYS", u32 flags (bit 0: any hit), u64
// count, then for each ray the floats of origin, tmin, direction, tmax.  out
// is untouched on failure; a file shorter or longer than its count says is
// refused.
bool rays_load(ray_set *out, const char *path, arena *mem, error *err);
bool rays_save(const ray_set *s, const char *path, error *err);

// The answers as a file: "HITS", u32 flags, u64 count as above, then for each
// ray f32 t and i32 triangle, -1 for a miss.
bool rays_save_hits(const ray_set *s, const hit *hits, const char *path,
                    error *err);

#endif
