// raster_block.c

#include "raster_block.h"

static uint32_t material_at(const scene *s, size_t triangle) {
  return s->material_of == NULL ? 0 : s->material_of[triangle];
}

// Whether a block ends before triangle t, which is not the first of run r.
static bool ends_before(const scene *s, const raster_block *b, size_t t) {
  return b->count == RASTER_BLOCK_MOST || material_at(s, t) != b->material;
}

// The blocks in the order of the file; out NULL: only count them.
static size_t cut(const scene *s, raster_block *out) {
  const mesh *m = &s->mesh;
  raster_block b = {0};
  size_t n = 0, run = 0;
  for (size_t t = 0; t < m->triangle_count; t++) {
    bool starts = run < m->run_count && m->runs[run].first == t;
    if (b.count > 0 && (starts || ends_before(s, &b, t))) {
      if (out != NULL) out[n] = b;
      n++;
      b.count = 0;
    }
    if (starts) run++;
    if (b.count == 0)
      b = (raster_block){.first = (uint32_t)t, .material = material_at(s, t)};
    b.count++;
  }
  if (b.count > 0 && out != NULL) out[n] = b;
  return n + (b.count > 0);
}

static void measure(raster_block *b, const mesh *m) {
  b->lo = vec3_all(INFINITY), b->hi = vec3_all(-INFINITY);
  for (size_t i = 0; i < 3 * (size_t)b->count; i++) {
    vec3 p = m->positions[m->position_index[3 * (size_t)b->first + i]];
    if (!vec3_finite(p)) continue;
    b->lo = vec3_min(b->lo, p);
    b->hi = vec3_max(b->hi, p);
  }
}

raster_blocks raster_blocks_of(const scene *s, arena *mem) {
  arena scratch = {0};
  size_t n = cut(s, NULL), kinds = s->material_count + 1;
  raster_block *in_file = ARENA_NEW(&scratch, raster_block, n);
  size_t *place = ARENA_NEW(&scratch, size_t, kinds + 1);
  cut(s, in_file);
  for (size_t i = 0; i < n; i++)
    place[in_file[i].material + 1]++;
  for (size_t k = 0; k < kinds; k++)
    place[k + 1] += place[k];
  raster_blocks out = {ARENA_NEW(mem, raster_block, n), n};
  for (size_t i = 0; i < n; i++) {
    measure(&in_file[i], &s->mesh);
    out.items[place[in_file[i].material]++] = in_file[i];
  }
  arena_free(&scratch);
  return out;
}

// sign (a . (p - from) / scale - at z) >= 0, where z = forward . (p - from):
// the side of a window that is reached at `at` steps along a.
static raster_plane side_of(const camera_view *v, vec3 a, double at,
                            double sign) {
  double length = (double)vec3_dot(a, a);
  double middle = -(double)vec3_dot(v->corner, a) / length;
  const float *axis = &a.x, *forward = &v->forward.x, *eye = &v->eye.x;
  raster_plane p = {.d = 0};
  for (int k = 0; k < 3; k++) {
    p.n[k] =
        sign * ((double)axis[k] / length + (middle - at) * (double)forward[k]);
    p.d -= p.n[k] * (double)eye[k];
  }
  return p;
}

raster_frustum raster_frustum_of(const camera_view *v, const int window[4]) {
  raster_frustum f = {
      {side_of(v, v->right, window[0], 1), side_of(v, v->right, window[2], -1),
       side_of(v, v->down, window[1], 1), side_of(v, v->down, window[3], -1)}};
  const float *forward = &v->forward.x, *eye = &v->eye.x;
  for (int k = 0; k < 3; k++) {
    f.side[4].n[k] = (double)forward[k];
    f.side[4].d -= (double)forward[k] * (double)eye[k];
  }
  return f;
}

raster_frustum raster_frustum_of_matrix(const float m[16], vec3 origin) {
  static const struct {
    int row, sign;
  } sides[5] = {{0, 1}, {0, -1}, {1, 1}, {1, -1}, {0, 0}};
  raster_frustum f;
  const float *from = &origin.x;
  for (int i = 0; i < 5; i++) {
    raster_plane *p = &f.side[i];
    const float *row = m + sides[i].row;
    p->d = (double)m[15] + sides[i].sign * (double)row[12];
    for (int k = 0; k < 3; k++) {
      p->n[k] = (double)m[4 * k + 3] + sides[i].sign * (double)row[4 * k];
      p->d -= p->n[k] * (double)from[k];
    }
  }
  return f;
}

// Rounding moves a vertex by less than this share of what is added up.
#define ROUNDING 1e-5

// Whether the corner of the box that is farthest along n lies outside.
static bool box_outside(const raster_block *b, const raster_plane *p) {
  const float *lo = &b->lo.x, *hi = &b->hi.x;
  double sum = p->d, size = fabs(p->d);
  for (int k = 0; k < 3; k++) {
    double far = p->n[k] * (double)(p->n[k] > 0 ? hi[k] : lo[k]);
    double most = fmax(fabs((double)lo[k]), fabs((double)hi[k]));
    sum += far;
    size += fabs(p->n[k]) * most;
  }
  return sum < -ROUNDING * size;
}

bool raster_block_outside(const raster_block *b, const raster_frustum *f) {
  if (b->lo.x > b->hi.x) return true;
  for (int i = 0; i < 5; i++)
    if (box_outside(b, &f->side[i])) return true;
  return false;
}

static bool same_point(vec3 a, vec3 b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}

bool raster_is_edge(const mesh *m, size_t triangle) {
  const uint32_t *k = m->position_index + 3 * triangle;
  vec3 a = m->positions[k[0]], b = m->positions[k[1]], c = m->positions[k[2]];
  return same_point(a, b) || same_point(b, c) || same_point(c, a);
}
