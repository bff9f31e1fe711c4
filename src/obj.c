// obj.c

#include "obj.h"

#include "obj_merge.h"
#include "obj_pack.h"
#include "obj_parse.h"
#include "obj_source.h"

#include <inttypes.h>
#include <stdatomic.h>
#include <string.h>
#include <time.h>

// A helping of text: large enough that its start costs nothing, small enough
// for a cache and for many threads.
enum { OBJ_PIECE = 1 << 20, OBJ_PIECE_MAX = 1 << 22 };

// Parsed pieces are kept in blocks of this size.
enum { OBJ_BLOCK = 1 << 24 };

// One reading of one file.  Chunks, places and findings have one entry per
// piece (places one more), buffers and scratch one per worker.
typedef struct obj_job {
  obj_source source;
  size_t pieces;
  obj_chunk *chunks;
  obj_place *places;
  obj_findings *findings;
  obj_buffer *buffers;
  obj_chunk *growing;  // chunks in the making
  obj_store *stores;   // and where they are packed
  obj_scratch *scratch;
  int workers;
  atomic_size_t failed;  // the first piece known to have a problem
  mesh m;
} obj_job;

// Where a problem lies that has no line.
#define NO_LINE UINT64_MAX

static double now_seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// Parse piece i.  Pieces behind a problem are left out: the first one in the
// file is the one that counts.
static void parse_piece(void *context, size_t i, int worker) {
  obj_job *job = context;
  obj_chunk *c = &job->growing[worker];
  if (i > atomic_load(&job->failed)) return;
  span text;
  obj_chunk_reset(c);
  if (obj_source_read(&job->source, i, &job->buffers[worker], &text,
                      &c->problem)) {
    obj_parse(c, text);
  } else {
    c->problem_line = NO_LINE;
  }
  job->chunks[i] = obj_pack(c, &job->stores[worker]);
  if (job->chunks[i].problem_line == 0) return;
  size_t first = atomic_load(&job->failed);
  while (i < first && !atomic_compare_exchange_weak(&job->failed, &first, i))
    continue;
}

static void merge_piece_vertices(void *context, size_t i, int worker) {
  obj_job *job = context;
  (void)worker;
  obj_merge_vertices(&job->m, &job->chunks[i], &job->places[i]);
}

static void merge_piece_faces(void *context, size_t i, int worker) {
  obj_job *job = context;
  job->findings[i] = obj_merge_faces(&job->m, &job->chunks[i], &job->places[i],
                                     &job->scratch[worker]);
}

// The message of the first malformed statement.
static bool parse_problem(const obj_job *job, error *err) {
  size_t i = atomic_load(&job->failed);
  const obj_chunk *c = &job->chunks[i];
  if (c->problem_line == NO_LINE) return fail(err, "%s", c->problem.text);
  return fail(err, "%s:%" PRIu64 ": %.500s", job->source.name,
              job->places[i].line + c->problem_line, c->problem.text);
}

// Parse piece i again to learn the line of one of its faces: lines of faces
// are not kept, because only messages need them.
static uint64_t face_line(obj_job *job, size_t i, size_t face,
                          size_t *positions) {
  obj_chunk c = {.watched_face = face};
  span text;
  error ignored;
  if (obj_source_read(&job->source, i, &job->buffers[0], &text, &ignored))
    obj_parse(&c, text);
  *positions = job->places[i].position + c.watched_positions;
  uint64_t line = job->places[i].line + c.watched_line;
  obj_chunk_free(&c);
  return line;
}

// The message of the first face with a position that does not exist.
static bool position_problem(obj_job *job, size_t i, error *err) {
  const obj_findings *f = &job->findings[i];
  size_t at_line;
  uint64_t line = face_line(job, i, f->index[0].first, &at_line);
  const char *name = job->source.name;
  long long bad = (long long)f->index[0].index;
  if (bad >= 0)
    return fail(err,
                "%s:%" PRIu64 ": position %lld does not exist, expected "
                "1 to %zu",
                name, line, bad + 1, job->m.position_count);
  return fail(err,
              "%s:%" PRIu64 ": position %lld reaches back too far, "
              "expected -1 to -%zu",
              name, line, bad - (long long)at_line, at_line);
}

// Arrays of the mesh as large as the chunks say.
static void allocate_mesh(obj_job *job, arena *mem) {
  mesh *m = &job->m;
  obj_place total = job->places[job->pieces];
  bool colors = false, texcoords = false, normals = false;
  for (size_t i = 0; i < job->pieces; i++) {
    colors = colors || job->chunks[i].has_color;
    texcoords = texcoords || job->chunks[i].has_texcoord;
    normals = normals || job->chunks[i].has_normal;
  }
  m->position_count = total.position;
  m->normal_count = total.normal;
  m->texcoord_count = total.texcoord;
  m->triangle_count = total.triangle;
  m->face_count = total.face;
  m->positions = ARENA_NEW(mem, vec3, total.position);
  m->normals = ARENA_NEW(mem, vec3, total.normal);
  m->texcoords = ARENA_NEW(mem, vec2, total.texcoord);
  if (colors) m->colors = ARENA_NEW(mem, vec3, total.position);
  m->position_index = ARENA_NEW(mem, uint32_t, 3 * total.triangle);
  if (texcoords && total.texcoord > 0)
    m->texcoord_index = ARENA_NEW(mem, uint32_t, 3 * total.triangle);
  if (normals && total.normal > 0)
    m->normal_index = ARENA_NEW(mem, uint32_t, 3 * total.triangle);
}

// Counts that must fit the mesh's 32-bit indices.
static bool check_limits(const obj_job *job, error *err) {
  obj_place total = job->places[job->pieces];
  size_t most = (size_t)INT32_MAX;
  if (total.position <= most && total.normal <= most &&
      total.texcoord <= most && total.triangle <= most)
    return true;
  return fail(err, "%s: more than %zu vertices or triangles", job->source.name,
              most);
}

// What to say of a tally of one and of more.
typedef struct tally_text {
  report_kind kind;
  const char *one, *many;
} tally_text;

static const tally_text TALLY_TEXT[OBJ_TALLY_COUNT] = {
    [OBJ_TALLY_SHORT_FACE] = {REPORT_WARNING,
                              "face with fewer than 3 corners skipped",
                              "faces with fewer than 3 corners skipped"},
    [OBJ_TALLY_NOT_FINITE] = {REPORT_WARNING,
                              "vertex with a number that is not finite",
                              "vertices with numbers that are not finite"},
    [OBJ_TALLY_FAR] = {REPORT_WARNING, "vertex beyond 1e37",
                       "vertices beyond 1e37"},
    [OBJ_TALLY_BAD_SMOOTH] = {REPORT_WARNING,
                              "smoothing group that is no number taken as off",
                              "smoothing groups that are no number taken as "
                              "off"},
    [OBJ_TALLY_EXTRA] = {REPORT_NOTE, "vertex with numbers too many",
                         "vertices with numbers too many"},
    [OBJ_TALLY_POINT] = {REPORT_NOTE, "point element skipped",
                         "point elements skipped"},
    [OBJ_TALLY_LINE] = {REPORT_NOTE, "line element skipped",
                        "line elements skipped"},
    [OBJ_TALLY_FREE_FORM] = {REPORT_NOTE,
                             "statement of a free-form curve or surface "
                             "skipped",
                             "statements of free-form curves or surfaces "
                             "skipped"},
    [OBJ_TALLY_DISPLAY] = {REPORT_NOTE, "display statement skipped",
                           "display statements skipped"},
    [OBJ_TALLY_UNKNOWN] = {REPORT_NOTE, "statement of no known kind skipped",
                           "statements of no known kind skipped"},
};

// One remark with its place and count.
static void remark(const obj_job *job, report *r, obj_tally t, const char *text,
                   report_kind kind) {
  if (kind == REPORT_WARNING)
    report_warn(r, "%s:%" PRIu64 ": %" PRIu64 " %s", job->source.name, t.line,
                t.count, text);
  else
    report_note(r, "%s:%" PRIu64 ": %" PRIu64 " %s", job->source.name, t.line,
                t.count, text);
}

// Add up the tallies of all chunks.
static void report_tallies(obj_job *job, report *r) {
  for (int k = 0; k < OBJ_TALLY_COUNT; k++) {
    obj_tally sum = {0};
    for (size_t i = 0; i < job->pieces; i++) {
      obj_tally t = job->chunks[i].tally[k];
      if (sum.count == 0) sum.line = job->places[i].line + t.line;
      sum.count += t.count;
    }
    if (k == OBJ_TALLY_POINT) job->m.point_elements = sum.count;
    if (k == OBJ_TALLY_LINE) job->m.line_elements = sum.count;
    if (sum.count > 0)
      remark(job, r, sum,
             sum.count == 1 ? TALLY_TEXT[k].one : TALLY_TEXT[k].many,
             TALLY_TEXT[k].kind);
  }
}

// The first keywords of no known kind, each once.
static void report_unknown(const obj_job *job, report *r) {
  obj_unknown seen[OBJ_UNKNOWN_MAX];
  int count = 0;
  for (size_t i = 0; i < job->pieces; i++)
    for (size_t j = 0; j < job->chunks[i].unknown_count; j++) {
      const obj_unknown *u = &job->chunks[i].unknown[j];
      int k = 0;
      while (k < count && strcmp(seen[k].keyword, u->keyword) != 0)
        k++;
      if (k < count || count == OBJ_UNKNOWN_MAX) continue;
      seen[count++] = *u;
      report_note(r, "%s:%" PRIu64 ": unknown statement \"%s\"",
                  job->source.name, job->places[i].line + u->line, u->keyword);
    }
}

// One warning for all faces with a flaw: how many, and the line of the first.
static void report_flaw(obj_job *job, report *r, size_t offset,
                        const char *text) {
  obj_tally sum = {0};
  for (size_t i = 0; i < job->pieces; i++) {
    obj_flaw flaw;
    memcpy(&flaw, (const char *)&job->findings[i] + offset, sizeof flaw);
    size_t ignored;
    if (flaw.count > 0 && sum.count == 0)
      sum.line = face_line(job, i, flaw.first, &ignored);
    sum.count += flaw.count;
  }
  if (sum.count > 0) remark(job, r, sum, text, REPORT_WARNING);
}

static void report_flaws(obj_job *job, report *r) {
  report_flaw(job, r, offsetof(obj_findings, index[1]),
              "face(s) with a texture coordinate that does not exist");
  report_flaw(job, r, offsetof(obj_findings, index[2]),
              "face(s) with a normal that does not exist");
  report_flaw(job, r, offsetof(obj_findings, polygon),
              "polygon(s) without area or crossing themselves, cut anyhow");
  report_flaw(job, r, offsetof(obj_findings, flat),
              "triangle(s) without area, which nothing can hit");
  if (job->m.triangle_count == 0)
    report_warn(r, "%s: no faces, nothing to draw", job->source.name);
}

// All pieces are parsed: put them together.
static bool merge_pieces(obj_job *job, const obj_request *q, arena *mem,
                         report *r, error *err) {
  double start = now_seconds();
  obj_places(job->chunks, job->pieces, job->places);
  if (atomic_load(&job->failed) < job->pieces) return parse_problem(job, err);
  if (!check_limits(job, err)) return false;
  allocate_mesh(job, mem);
  obj_merge_events(&job->m, job->chunks, job->places, job->pieces, mem);
  report_unknown(job, r);
  report_tallies(job, r);
  pool_run(q->threads, job->pieces, merge_piece_vertices, job);
  double middle = now_seconds();
  pool_run(q->threads, job->pieces, merge_piece_faces, job);
  bool texcoords = false, normals = false;
  for (size_t i = 0; i < job->pieces; i++) {
    if (job->findings[i].index[0].count > 0)
      return position_problem(job, i, err);
    texcoords = texcoords || job->findings[i].has[1];
    normals = normals || job->findings[i].has[2];
  }
  if (!texcoords) job->m.texcoord_index = NULL;
  if (!normals) job->m.normal_index = NULL;
  report_flaws(job, r);
  if (q->times != NULL) {
    q->times->merge = middle - start;
    q->times->triangulate = now_seconds() - middle;
  }
  return true;
}

// Open what the request names.
static bool open_source(obj_source *s, const obj_request *q, size_t piece,
                        arena *mem, error *err) {
  if (q->text.at == NULL) return obj_source_open(s, q->path, piece, mem, err);
  *s = (obj_source){.name = q->path,
                    .file = -1,
                    .text = q->text,
                    .size = q->text.length,
                    .piece = piece};
  return true;
}

// What each piece and each worker needs.
static void prepare(obj_job *job, arena *own) {
  size_t workers = (size_t)job->workers;
  job->pieces = obj_source_pieces(&job->source);
  job->chunks = ARENA_NEW(own, obj_chunk, job->pieces);
  job->places = ARENA_NEW(own, obj_place, job->pieces + 1);
  job->findings = ARENA_NEW(own, obj_findings, job->pieces);
  job->buffers = ARENA_NEW(own, obj_buffer, workers);
  job->growing = ARENA_NEW(own, obj_chunk, workers);
  job->stores = ARENA_NEW(own, obj_store, workers);
  job->scratch = ARENA_NEW(own, obj_scratch, workers);
  for (size_t i = 0; i < workers; i++)
    job->stores[i].block_bytes = job->pieces > 4 ? OBJ_BLOCK : OBJ_PIECE / 4;
  atomic_init(&job->failed, SIZE_MAX);
}

static void release(obj_job *job) {
  for (int i = 0; i < job->workers; i++) {
    array_free(job->buffers[i].bytes);
    obj_chunk_free(&job->growing[i]);
    arena_free(&job->stores[i].mem);
    obj_scratch_free(&job->scratch[i]);
  }
  obj_source_close(&job->source);
}

bool obj_read_request(mesh *out, const obj_request *q, arena *mem, report *r,
                      error *err) {
  arena own = {0}, result = {0};
  obj_job job = {.workers = pool_threads(q->threads)};
  size_t piece = q->piece_bytes == 0 ? OBJ_PIECE : q->piece_bytes;
  if (piece > OBJ_PIECE_MAX) piece = OBJ_PIECE_MAX;
  double start = now_seconds();
  if (!open_source(&job.source, q, piece, &own, err)) {
    arena_free(&own);
    return false;
  }
  prepare(&job, &own);
  pool_run(q->threads, job.pieces, parse_piece, &job);
  if (q->times != NULL)
    *q->times = (obj_times){.read_parse = now_seconds() - start,
                            .bytes = (size_t)job.source.size};
  bool ok = merge_pieces(&job, q, &result, r, err);
  if (ok) *out = job.m;
  if (ok) arena_adopt(mem, &result);
  arena_free(&result);
  release(&job);
  arena_free(&own);
  return ok;
}

bool obj_read(mesh *out, const char *path, arena *mem, pool *threads, report *r,
              obj_times *times, error *err) {
  obj_request q = {.path = path, .threads = threads, .times = times};
  return obj_read_request(out, &q, mem, r, err);
}
