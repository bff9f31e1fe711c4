// bvh_read.c

#include "bvh_read.h"

// So many triangles are read in one go.
enum { PIECE = 4096 };

// A piece of the mesh: how many of its triangles are kept, where their refs
// begin, and their bounds.
typedef struct mesh_piece {
  uint32_t kept, first_ref;
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

// The triangle behind the last of a piece.
static uint32_t piece_end(const reading *job, size_t item) {
  uint32_t begin = (uint32_t)item * PIECE, n = job->b->triangle_count;
  return n - begin < PIECE ? n : begin + PIECE;
}

// Count the kept triangles of a piece; the next pass fills their refs.
static void count_piece(void *context, size_t item, int worker) {
  (void)worker;
  reading *job = context;
  mesh_piece *p = &job->pieces[item];
  uint32_t end = piece_end(job, item);
  sah_ref unused;
  for (uint32_t t = (uint32_t)item * PIECE; t < end; t++)
    p->kept += ref_of_triangle(job->b, t, &unused);
}

static void fill_piece(void *context, size_t item, int worker) {
  (void)worker;
  reading *job = context;
  mesh_piece *p = &job->pieces[item];
  uint32_t end = piece_end(job, item);
  sah_ref *to = job->refs + p->first_ref;
  p->box = p->centres = sah_box_empty();
  for (uint32_t t = (uint32_t)item * PIECE; t < end; t++) {
    sah_ref r;
    if (!ref_of_triangle(job->b, t, &r)) continue;
    sah_box_join(&p->box, &r.box);
    sah_box_join_centre(&p->centres, &r.box);
    *to++ = r;
  }
}

bvh_part bvh_read(sah_ref **refs, bvh *b, uint32_t percent, arena *mem,
                  pool *threads) {
  uint32_t n = b->triangle_count, kept = 0;
  uint32_t pieces = n / PIECE + (n % PIECE != 0);
  reading job = {.b = b, .pieces = ARENA_NEW(mem, mesh_piece, pieces)};
  pool_run(threads, pieces, count_piece, &job);
  for (uint32_t i = 0; i < pieces; i++) {
    job.pieces[i].first_ref = kept;
    kept += job.pieces[i].kept;
  }
  b->kept = b->refs = kept;
  b->dropped = n - kept;
  *refs = job.refs =
      ARENA_NEW(mem, sah_ref, kept + (size_t)((uint64_t)kept * percent / 100));
  pool_run(threads, pieces, fill_piece, &job);
  bvh_part root = {.end = kept};
  root.box = root.centres = sah_box_empty();
  for (uint32_t i = 0; i < pieces; i++) {
    sah_box_join(&root.box, &job.pieces[i].box);
    sah_box_join(&root.centres, &job.pieces[i].centres);
  }
  return root;
}
