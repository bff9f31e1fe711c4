// bvh_read.c

#include "bvh_read.h"

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

// Whether a triangle can be hit: its corners are finite and span an area.
static bool triangle_kept(const vec3 p[3]) {
  if (!vec3_finite(p[0]) || !vec3_finite(p[1]) || !vec3_finite(p[2]))
    return false;
  double ax = (double)p[1].x - (double)p[0].x,
         ay = (double)p[1].y - (double)p[0].y,
         az = (double)p[1].z - (double)p[0].z;
  double bx = (double)p[2].x - (double)p[0].x,
         by = (double)p[2].y - (double)p[0].y,
         bz = (double)p[2].z - (double)p[0].z;
  return ay * bz != az * by || az * bx != ax * bz || ax * by != ay * bx;
}

// Read triangle t into r; false when it is dropped.
static bool ref_of_triangle(const bvh *b, uint32_t t, sah_ref *r) {
  const uint32_t *v = b->index + 3 * (size_t)t;
  vec3 p[3] = {b->positions[v[0]], b->positions[v[1]], b->positions[v[2]]};
  if (!triangle_kept(p)) return false;
  r->box = sah_box_empty();
  for (int i = 0; i < 3; i++) {
    sah_box corner = {{p[i].x, p[i].y, p[i].z}, {p[i].x, p[i].y, p[i].z}};
    sah_box_join(&r->box, &corner);
  }
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
  p->box = p->centres = sah_box_empty();
  for (uint32_t t = begin; t < end; t++) {
    if (!ref_of_triangle(job->b, t, to)) continue;
    sah_box_join(&p->box, &to->box);
    sah_box_join_centre(&p->centres, &to->box);
    to++;
  }
  p->kept = (uint32_t)(to - job->refs) - begin;
}

bvh_part bvh_read(sah_ref **refs, bvh *b, uint32_t percent, arena *mem,
                  pool *threads) {
  uint32_t n = b->triangle_count, pieces = n / PIECE + (n % PIECE != 0);
  size_t room = n + (size_t)((uint64_t)n * percent / 100);
  reading job = {.b = b,
                 .pieces = ARENA_NEW(mem, mesh_piece, pieces),
                 .refs = ARENA_NEW(mem, sah_ref, room)};
  pool_run(threads, pieces, read_piece, &job);
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
