// normals.c

#include "normals.h"

#include <stdlib.h>
#include <string.h>

// Positions that a thread takes at a time.
enum { NORMALS_BATCH = 4096 };

// With more faces than this around a position the crease angle is not looked
// at: comparing all with all would take forever where a fan has a million.
enum { CREASE_FACES_MAX = 1024 };

// One triangle's share in the normals around one of its corners.
typedef struct corner_share {
  int64_t group;
  uint32_t corner;
  bool wants;   // whether this corner needs a normal
  double n[3];  // unit normal of the triangle, 0 when it has no area
  double angle;
} corner_share;

// One worker's memory.
typedef struct share_list {
  corner_share *shares;
  size_t room;
} share_list;

// The generation of normals for a mesh.  around[start[p]] .. are the corners
// at position p; made[c] is the normal of corner c where first[c] = c, and
// first[c] the corner that has the same one otherwise; MESH_NONE where none is
// needed.
typedef struct normals_job {
  const mesh *m;
  bool one_group;        // NORMALS_SMOOTH
  double crease;         // radians
  const int64_t *group;  // of each triangle
  size_t *start;
  uint32_t *around;
  vec3 *made;
  uint32_t *first;
  share_list *lists;
} normals_job;

// The angle whose tangent is t in [0, 1], with arithmetic alone, so that it
// has the same bits everywhere.  Two halvings bring t below 0.2, where seven
// terms of the series err by less than 1e-11.
static double arc_tangent(double t) {
  t = t / (1 + sqrt(1 + t * t));
  t = t / (1 + sqrt(1 + t * t));
  double s = t * t, sum = 0;
  for (int i = 13; i >= 1; i -= 2)
    sum = 1.0 / i - s * sum;
  return 4 * t * sum;
}

// The angle between u and v, 0 to pi; 0 when one has no direction.
static double angle_between(const double u[3], const double v[3]) {
  double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2];
  double z = u[0] * v[1] - u[1] * v[0];
  double sine = sqrt(x * x + y * y + z * z);
  double cosine = u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
  if (!(sine > 0) && !(cosine < 0)) return 0;
  const double pi = 3.14159265358979323846;
  double side = fabs(cosine);
  double angle = sine < side ? arc_tangent(sine / side)
                             : pi / 2 - arc_tangent(side / sine);
  return cosine < 0 ? pi - angle : angle;
}

static void edge(const vec3 a, const vec3 b, double out[3]) {
  out[0] = (double)b.x - (double)a.x;
  out[1] = (double)b.y - (double)a.y;
  out[2] = (double)b.z - (double)a.z;
}

// The share of the triangle that has the given corner.
static void measure_share(const mesh *m, corner_share *s) {
  const uint32_t *t = m->position_index + s->corner / 3 * 3;
  uint32_t k = s->corner % 3;
  vec3 a = m->positions[t[k]], b = m->positions[t[(k + 1) % 3]];
  vec3 c = m->positions[t[(k + 2) % 3]];
  double u[3], v[3];
  edge(a, b, u);
  edge(a, c, v);
  double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2];
  double z = u[0] * v[1] - u[1] * v[0];
  double length = sqrt(x * x + y * y + z * z);
  bool solid = length > 0 && isfinite(length);
  s->n[0] = solid ? x / length : 0;
  s->n[1] = solid ? y / length : 0;
  s->n[2] = solid ? z / length : 0;
  s->angle = solid ? angle_between(u, v) : 0;
}

// Add up the shares that smooth with `own` (all of them when crease is pi or
// more); zero when they cancel.
static vec3 blend(const corner_share *shares, size_t n, const corner_share *own,
                  double crease) {
  double sum[3] = {0};
  for (size_t i = 0; i < n; i++) {
    const corner_share *s = &shares[i];
    if (crease < 3.14159 && angle_between(s->n, own->n) > crease) continue;
    for (int k = 0; k < 3; k++)
      sum[k] += s->angle * s->n[k];
  }
  double length = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
  if (!(length > 1e-9)) return vec3_all(0);
  return (vec3){(float)(sum[0] / length), (float)(sum[1] / length),
                (float)(sum[2] / length)};
}

// The normals of n shares of one group.
static void blend_group(normals_job *job, const corner_share *shares,
                        size_t n) {
  bool each = job->crease < 3.14159 && n <= CREASE_FACES_MAX;
  uint32_t first = MESH_NONE;
  for (size_t i = 0; i < n; i++) {
    if (!shares[i].wants) continue;
    uint32_t corner = shares[i].corner;
    if (each || first == MESH_NONE) {
      first = corner;
      job->made[corner] = blend(shares, n, &shares[i], each ? job->crease : 4);
    }
    job->first[corner] = first;
  }
}

static int compare_shares(const void *a, const void *b) {
  const corner_share *x = a, *y = b;
  if (x->group != y->group) return x->group < y->group ? -1 : 1;
  return x->corner < y->corner ? -1 : x->corner > y->corner;
}

// Whether a corner keeps the normal that the file gave it.
static bool keeps_normal(const normals_job *job, uint32_t corner) {
  return !job->one_group && job->m->normal_index != NULL &&
         job->m->normal_index[corner] != MESH_NONE;
}

// All normals at one position.
static void position_normals(normals_job *job, size_t p, share_list *list) {
  size_t n = job->start[p + 1] - job->start[p], kept = 0;
  list->shares = array_grow(list->shares, &list->room, n, sizeof *list->shares);
  bool sorted = true, wanted = false;
  for (size_t i = 0; i < n; i++) {
    uint32_t corner = job->around[job->start[p] + i];
    int64_t group = job->one_group ? 1 : job->group[corner / 3];
    if (group <= 0) continue;
    corner_share s = {.group = group, .corner = corner};
    s.wants = !keeps_normal(job, corner);
    wanted = wanted || s.wants;
    sorted = sorted && (kept == 0 || list->shares[kept - 1].group <= group);
    list->shares[kept++] = s;
  }
  if (!wanted) return;
  if (!sorted) qsort(list->shares, kept, sizeof *list->shares, compare_shares);
  for (size_t i = 0; i < kept; i++)
    measure_share(job->m, &list->shares[i]);
  for (size_t i = 0, end; i < kept; i = end) {
    end = i + 1;
    while (end < kept && list->shares[end].group == list->shares[i].group)
      end++;
    blend_group(job, list->shares + i, end - i);
  }
}

static void normals_batch(void *context, size_t item, int worker) {
  normals_job *job = context;
  size_t end = (item + 1) * NORMALS_BATCH;
  if (end > job->m->position_count) end = job->m->position_count;
  for (size_t p = item * NORMALS_BATCH; p < end; p++)
    position_normals(job, p, &job->lists[worker]);
}

// The corners around each position, in order.
static void gather_corners(normals_job *job, arena *own) {
  const mesh *m = job->m;
  size_t corners = 3 * m->triangle_count;
  job->start = ARENA_NEW(own, size_t, m->position_count + 2);
  job->around = ARENA_NEW(own, uint32_t, corners);
  for (size_t c = 0; c < corners; c++)
    job->start[m->position_index[c] + 2]++;
  for (size_t p = 2; p < m->position_count + 2; p++)
    job->start[p] += job->start[p - 1];
  // start[p + 1] is now where p begins, and moves to where it ends.
  for (size_t c = 0; c < corners; c++)
    job->around[job->start[m->position_index[c] + 1]++] = (uint32_t)c;
}

// The smoothing group of each triangle.
static int64_t *expand_groups(const mesh *m, arena *own) {
  int64_t *group = ARENA_NEW(own, int64_t, m->triangle_count);
  for (size_t r = 0; r < m->run_count; r++)
    for (uint32_t i = 0; i < m->runs[r].count; i++)
      group[m->runs[r].first + i] = m->runs[r].smooth;
  return group;
}

// Append the normals that were made and point the corners at them.
static void append_normals(mesh *m, const normals_job *job, arena *mem) {
  size_t corners = 3 * m->triangle_count, made = 0;
  for (size_t c = 0; c < corners; c++)
    made += job->first[c] == c;
  size_t old = job->one_group ? 0 : m->normal_count;
  vec3 *normals = ARENA_NEW(mem, vec3, old + made);
  if (old > 0) memcpy(normals, m->normals, old * sizeof *normals);
  if (m->normal_index == NULL) {
    m->normal_index = ARENA_NEW(mem, uint32_t, corners);
    memset(m->normal_index, 0xff, corners * sizeof *m->normal_index);
  }
  for (size_t c = 0; c < corners; c++) {
    if (job->first[c] != c) continue;
    normals[old] = job->made[c];
    m->normal_index[c] = (uint32_t)old++;
  }
  // The first of several at a position comes first, so it has its number.
  for (size_t c = 0; c < corners; c++)
    if (job->first[c] != MESH_NONE)
      m->normal_index[c] = m->normal_index[job->first[c]];
  m->normals = normals;
  m->normal_count = old;
}

static bool is_useless(vec3 n) {
  bool zero = n.x == 0 && n.y == 0 && n.z == 0;
  return zero || !vec3_finite(n);
}

// Forget indices of normals that have no direction, new ones and old ones.
// Mostly there is none, and corners, six times as many, need not be asked.
static void drop_useless(mesh *m) {
  size_t good = 0;
  while (good < m->normal_count && !is_useless(m->normals[good]))
    good++;
  if (good == m->normal_count) return;
  for (size_t c = 0; c < 3 * m->triangle_count; c++) {
    if (m->normal_index[c] == MESH_NONE) continue;
    if (is_useless(m->normals[m->normal_index[c]]))
      m->normal_index[c] = MESH_NONE;
  }
}

// Whether some face belongs to a smoothing group.
static bool has_groups(const mesh *m) {
  for (size_t r = 0; r < m->run_count; r++)
    if (m->runs[r].smooth > 0) return true;
  return false;
}

void normals_generate(mesh *m, normals_mode mode, float crease_deg, arena *mem,
                      pool *threads) {
  if (mode == NORMALS_FLAT) m->normal_index = NULL;
  if (m->normal_index != NULL) drop_useless(m);
  bool smooth = mode == NORMALS_SMOOTH;
  if (m->triangle_count > UINT32_MAX / 3) return;  // corners have 32 bits
  if (!smooth && (mode != NORMALS_AUTO || !has_groups(m))) return;
  arena own = {0};
  normals_job job = {.m = m, .one_group = smooth};
  job.crease = (double)crease_deg * (3.14159265358979323846 / 180);
  job.group = smooth ? NULL : expand_groups(m, &own);
  size_t corners = 3 * m->triangle_count;
  gather_corners(&job, &own);
  job.made = ARENA_NEW(&own, vec3, corners);
  job.first = ARENA_NEW(&own, uint32_t, corners);
  memset(job.first, 0xff, corners * sizeof *job.first);
  size_t workers = (size_t)pool_threads(threads);
  job.lists = ARENA_NEW(&own, share_list, workers);
  size_t batches = (m->position_count + NORMALS_BATCH - 1) / NORMALS_BATCH;
  pool_run(threads, batches, normals_batch, &job);
  append_normals(m, &job, mem);
  drop_useless(m);
  for (size_t i = 0; i < workers; i++)
    array_free(job.lists[i].shares);
  arena_free(&own);
}
