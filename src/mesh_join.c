// mesh_join.c — meshes put in their places, and several made into one.

#include "mesh_join.h"

#include <stdlib.h>
#include <string.h>

void mesh_place(mesh *m, float scale, bool up_z) {
  for (size_t i = 0; i < m->position_count; i++) {
    vec3 p = vec3_scale(m->positions[i], scale);
    m->positions[i] = up_z ? (vec3){p.x, p.z, -p.y} : p;
  }
  for (size_t i = 0; up_z && i < m->normal_count; i++) {
    vec3 n = m->normals[i];
    m->normals[i] = (vec3){n.x, n.z, -n.y};
  }
}

// Make room in out, which stays empty, for what sum counts; its pointers only
// say which optional arrays there are.
static void join_allocate(mesh *out, const mesh *sum, arena *mem) {
  *out = (mesh){0};
  size_t corners = 3 * sum->triangle_count;
  out->positions = ARENA_NEW(mem, vec3, sum->position_count);
  out->normals = ARENA_NEW(mem, vec3, sum->normal_count);
  out->texcoords = ARENA_NEW(mem, vec2, sum->texcoord_count);
  out->position_index = ARENA_NEW(mem, uint32_t, corners);
  if (sum->colors) out->colors = ARENA_NEW(mem, vec3, sum->position_count);
  if (sum->normal_index) out->normal_index = ARENA_NEW(mem, uint32_t, corners);
  if (sum->texcoord_index)
    out->texcoord_index = ARENA_NEW(mem, uint32_t, corners);
  out->runs = ARENA_NEW(mem, mesh_run, sum->run_count);
  out->object_names = ARENA_NEW(mem, const char *, sum->object_count);
  out->group_names = ARENA_NEW(mem, const char *, sum->group_count);
  out->material_names = ARENA_NEW(mem, const char *, sum->material_count);
  out->material_lines = ARENA_NEW(mem, uint64_t, sum->material_count);
  out->libraries = ARENA_NEW(mem, const char *, sum->library_count);
  out->library_lines = ARENA_NEW(mem, uint64_t, sum->library_count);
}

// Add the counts of p to sum.
static void join_count(mesh *sum, const mesh *p) {
  sum->position_count += p->position_count;
  sum->normal_count += p->normal_count;
  sum->texcoord_count += p->texcoord_count;
  sum->triangle_count += p->triangle_count;
  sum->run_count += p->run_count;
  sum->object_count += p->object_count;
  sum->group_count += p->group_count;
  sum->material_count += p->material_count;
  sum->library_count += p->library_count;
  sum->face_count += p->face_count;
  sum->object_statements += p->object_statements;
  sum->group_statements += p->group_statements;
  sum->line_elements += p->line_elements;
  sum->point_elements += p->point_elements;
}

// Copy n elements to the end of an array that holds `at` of them.
static void append(void *array, size_t at, const void *from, size_t n,
                   size_t size) {
  if (n > 0) memcpy((char *)array + at * size, from, n * size);
}

// Append indices shifted by `shift`; from may be NULL: no corner has any.
static void append_index(uint32_t *to, size_t at, const uint32_t *from,
                         size_t n, size_t shift) {
  if (to == NULL) return;
  for (size_t i = 0; i < n; i++)
    to[at + i] = from == NULL || from[i] == MESH_NONE
                     ? MESH_NONE
                     : from[i] + (uint32_t)shift;
}

// A run's name moved behind those of the parts before; -1 stays.
static int shifted_name(int name, size_t shift) {
  return name < 0 ? name : name + (int)shift;
}

// Append part p to out, which holds the parts before.
static void join_append(mesh *out, const mesh *p) {
  size_t corner = 3 * out->triangle_count, corners = 3 * p->triangle_count;
  append_index(out->position_index, corner, p->position_index, corners,
               out->position_count);
  append_index(out->normal_index, corner, p->normal_index, corners,
               out->normal_count);
  append_index(out->texcoord_index, corner, p->texcoord_index, corners,
               out->texcoord_count);
  append(out->positions, out->position_count, p->positions, p->position_count,
         sizeof(vec3));
  for (size_t i = 0; out->colors != NULL && i < p->position_count; i++)
    out->colors[out->position_count + i] =
        p->colors == NULL ? vec3_all(1) : p->colors[i];
  append(out->normals, out->normal_count, p->normals, p->normal_count,
         sizeof(vec3));
  append(out->texcoords, out->texcoord_count, p->texcoords, p->texcoord_count,
         sizeof(vec2));
  for (size_t i = 0; i < p->run_count; i++) {
    mesh_run r = p->runs[i];
    r.first += (uint32_t)out->triangle_count;
    r.object = shifted_name(r.object, out->object_count);
    r.group = shifted_name(r.group, out->group_count);
    r.material = shifted_name(r.material, out->material_count);
    out->runs[out->run_count + i] = r;
  }
  append(out->object_names, out->object_count, p->object_names, p->object_count,
         sizeof(char *));
  append(out->group_names, out->group_count, p->group_names, p->group_count,
         sizeof(char *));
  append(out->material_names, out->material_count, p->material_names,
         p->material_count, sizeof(char *));
  append(out->material_lines, out->material_count, p->material_lines,
         p->material_count, sizeof(uint64_t));
  append(out->libraries, out->library_count, p->libraries, p->library_count,
         sizeof(char *));
  append(out->library_lines, out->library_count, p->library_lines,
         p->library_count, sizeof(uint64_t));
}

bool mesh_join(mesh *out, const mesh *parts, size_t n, arena *mem, error *err) {
  if (n == 1) {
    *out = parts[0];
    return true;
  }
  mesh sum = {0}, joined;
  for (size_t i = 0; i < n; i++) {
    const mesh *p = &parts[i];
    join_count(&sum, p);
    if (p->colors != NULL) sum.colors = p->colors;
    if (p->normal_index != NULL) sum.normal_index = p->normal_index;
    if (p->texcoord_index != NULL) sum.texcoord_index = p->texcoord_index;
  }
  if (sum.position_count > INT32_MAX || sum.triangle_count > INT32_MAX)
    return fail(err, "the meshes together exceed 2^31 vertices or triangles");
  join_allocate(&joined, &sum, mem);
  for (size_t i = 0; i < n; i++) {
    join_append(&joined, &parts[i]);
    join_count(&joined, &parts[i]);
  }
  *out = joined;
  return true;
}

void mesh_extent(const mesh *m, vec3 *lo, vec3 *hi) {
  vec3 least = vec3_all(INFINITY), most = vec3_all(-INFINITY);
  for (size_t i = 0; i < 3 * m->triangle_count; i++) {
    vec3 p = m->positions[m->position_index[i]];
    if (!vec3_finite(p)) continue;
    least = vec3_min(least, p);
    most = vec3_max(most, p);
  }
  *lo = least;
  *hi = most;
}

// An edge by the places of its ends, the lesser first.
typedef struct placed_edge {
  vec3 a, b;
} placed_edge;

// Order by x, then y, then z; -0 and 0 are equal.
static int compare_places(vec3 a, vec3 b) {
  if (a.x != b.x) return a.x < b.x ? -1 : 1;
  if (a.y != b.y) return a.y < b.y ? -1 : 1;
  if (a.z != b.z) return a.z < b.z ? -1 : 1;
  return 0;
}

static int compare_edges(const void *pa, const void *pb) {
  const placed_edge *a = pa, *b = pb;
  int c = compare_places(a->a, b->a);
  return c != 0 ? c : compare_places(a->b, b->b);
}

// The three edges of a triangle, less those of length 0; how many.
static size_t edges_of(const mesh *m, size_t t, placed_edge out[3]) {
  const uint32_t *corner = m->position_index + 3 * t;
  size_t n = 0;
  for (int i = 0; i < 3; i++) {
    vec3 a = m->positions[corner[i]], b = m->positions[corner[(i + 1) % 3]];
    int c = compare_places(a, b);
    if (c != 0) out[n++] = c < 0 ? (placed_edge){a, b} : (placed_edge){b, a};
  }
  return n;
}

bool mesh_is_closed(const mesh *m, const uint32_t *tag, uint32_t value) {
  arena scratch = {0};
  placed_edge *edges = ARENA_NEW(&scratch, placed_edge, 3 * m->triangle_count);
  size_t n = 0;
  for (size_t t = 0; t < m->triangle_count; t++)
    if (tag[t] == value) n += edges_of(m, t, edges + n);
  qsort(edges, n, sizeof *edges, compare_edges);
  bool closed = true;
  for (size_t i = 0, j; closed && i < n; i = j) {
    for (j = i + 1; j < n && compare_edges(&edges[i], &edges[j]) == 0;)
      j++;
    closed = (j - i) % 2 == 0;
  }
  arena_free(&scratch);
  return closed;
}
