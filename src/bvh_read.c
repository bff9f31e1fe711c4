// bvh_read.c

#include "bvh_read.h"

#include <float.h>
#include <string.h>

// So many triangles are read in one go.
enum { PIECE = 4096 };

// A piece of the mesh: how many of its triangles are kept, and their bounds.
typedef struct mesh_piece {
  uint32_t kept;
  sah_box box, centres;
} mesh_piece;

// What the threads share.
typedef struct reading {
  const bvh *b;
  mesh_piece *pieces;
  sah_ref *refs;
} reading;

// Whether a finite triangle spans an area, in double precision.
static bool spans_area(const vec3 p[3]) {
  double ax = (double)p[1].x - (double)p[0].x,
         ay = (double)p[1].y - (double)p[0].y,
         az = (double)p[1].z - (double)p[0].z;
  double bx = (double)p[2].x - (double)p[0].x,
         by = (double)p[2].y - (double)p[0].y,
         bz = (double)p[2].z - (double)p[0].z;
  return ay * bz != az * by || az * bx != ax * bz || ax * by != ay * bx;
}

static inline sah_lanes lanes_of(vec3 p) {
  return (sah_lanes){p.x, p.y, p.z, 0};
}

// x, y and z moved on by one lane.
static inline sah_lanes turned(sah_lanes v) {
  return (sah_lanes){v[1], v[2], v[0], 0};
}

static inline sah_lanes lanes_abs(sah_lanes v) {
  return (sah_lanes)((sah_slices)v & INT32_MAX);
}

// Whether single precision knows that a and b, each rounded once, are not
// parallel: the products of their cross product differ by more than all
// roundings together, and by more than what underflow may do.
static inline bool surely_apart(sah_lanes a, sah_lanes b) {
  const sah_lanes some = {0x1p-20f, 0x1p-20f, 0x1p-20f, 1};
  const sah_lanes least = {FLT_MIN, FLT_MIN, FLT_MIN, FLT_MIN};
  sah_lanes u = a * turned(b), v = turned(a) * b;
  sah_slices m =
      lanes_abs(u - v) > some * (lanes_abs(u) + lanes_abs(v)) + least;
  return (m[0] | m[1] | m[2]) != 0;
}

// Read triangle t into r; false when it is dropped: a corner is not finite or
// it has no area.
static bool ref_of_triangle(const bvh *b, uint32_t t, sah_ref *r) {
  const uint32_t *v = b->index + 3 * (size_t)t;
  vec3 p[3] = {b->positions[v[0]], b->positions[v[1]], b->positions[v[2]]};
  sah_lanes c[3] = {lanes_of(p[0]), lanes_of(p[1]), lanes_of(p[2])};
  sah_slices finite = (c[0] - c[0]) + (c[1] - c[1]) + (c[2] - c[2]) == 0;
  if ((finite[0] & finite[1] & finite[2]) == 0) return false;
  if (!surely_apart(c[1] - c[0], c[2] - c[0]) && !spans_area(p)) return false;
  sah_lanes lo = sah_min(sah_min(c[0], c[1]), c[2]);
  sah_lanes hi = sah_max(sah_max(c[0], c[1]), c[2]);
  memcpy(r->box.lo, &lo, sizeof lo);
  memcpy(r->box.hi, &hi, sizeof hi);
  r->as.triangle = t;
  return true;
}

// The refs of a piece, where they go when no triangle before is dropped.
static void read_piece(void *context, size_t item, int worker) {
  (void)worker;
  reading *job = context;
  mesh_piece *p = &job->pieces[item];
  uint32_t begin = (uint32_t)item * PIECE, n = job->b->triangle_count;
  uint32_t end = n - begin < PIECE ? n : begin + PIECE;
  sah_ref *to = job->refs + begin;
  sah_box box = sah_box_empty(), centres = box;
  for (uint32_t t = begin; t < end; t++) {
    if (!ref_of_triangle(job->b, t, to)) continue;
    sah_box_join(&box, &to->box);
    sah_box_join_centre(&centres, &to->box);
    to++;
  }
  p->box = box;
  p->centres = centres;
  p->kept = (uint32_t)(to - job->refs) - begin;
}

bvh_part bvh_read(sah_ref **refs, bvh *b, uint32_t percent, arena *mem,
                  pool *threads) {
  uint32_t n = b->triangle_count, pieces = n / PIECE + (n % PIECE != 0);
  size_t room = n + (size_t)((uint64_t)n * percent / 100);
  reading job = {.b = b,
                 .pieces = ARENA_NEW(mem, mesh_piece, pieces),
                 .refs = ARENA_NEW(mem, sah_ref, room)};
  pool_run_near(threads, pieces, read_piece, &job);
  bvh_part root = {.end = 0};
  root.box = root.centres = sah_box_empty();
  for (uint32_t i = 0; i < pieces; i++) {
    const mesh_piece *p = &job.pieces[i];
    sah_box_join(&root.box, &p->box);
    sah_box_join(&root.centres, &p->centres);
    // Close the gap that dropped triangles have left.
    if (root.end < i * PIECE)
      memmove(job.refs + root.end, job.refs + (size_t)i * PIECE,
              p->kept * sizeof *job.refs);
    root.end += p->kept;
  }
  b->kept = b->refs = root.end;
  b->dropped = n - root.end;
  *refs = job.refs;
  return root;
}
