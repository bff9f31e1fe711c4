// obj_merge.c

#include "obj_merge.h"

#include "pages.h"
#include "polygon.h"

#include <string.h>

void obj_places(const obj_chunk *chunks, size_t n, obj_place *places) {
  places[0] = (obj_place){0};
  for (size_t i = 0; i < n; i++) {
    const obj_chunk *c = &chunks[i];
    places[i + 1] = (obj_place){
        .position = places[i].position + c->position_count,
        .normal = places[i].normal + c->normal_count,
        .texcoord = places[i].texcoord + c->texcoord_count,
        .face = places[i].face + c->face_count,
        .triangle = places[i].triangle + c->triangle_count,
        .line = places[i].line + c->line_count,
    };
  }
}

// memcpy into memory that nobody has written yet, from arrays that may be NULL
// when they are empty.
static void copy_items(void *to, const void *from, size_t bytes) {
  pages_expect(to, bytes);
  if (bytes > 0) memcpy(to, from, bytes);
}

void obj_merge_vertices(mesh *m, const obj_chunk *c, const obj_place *at) {
  copy_items(m->positions + at->position, c->positions,
             c->position_count * sizeof *c->positions);
  copy_items(m->normals + at->normal, c->normals,
             c->normal_count * sizeof *c->normals);
  copy_items(m->texcoords + at->texcoord, c->texcoords,
             c->texcoord_count * sizeof *c->texcoords);
  if (m->colors == NULL) return;
  for (size_t i = 0; i < c->position_count; i++)
    m->colors[at->position + i] = c->has_color ? c->colors[i] : vec3_all(1);
}

// A chunk's index as one of the whole file; negative when it reaches back too
// far.
static int64_t resolve(uint32_t index, size_t base) {
  if (index < OBJ_RELATIVE) return index;
  return (int64_t)base + (int64_t)(index - OBJ_RELATIVE) - (int64_t)OBJ_BACK;
}

// n indices of a chunk as ones of the whole file, where `total` elements are;
// what is missing or out of range becomes MESH_NONE.  Returns how many are out
// of range.
static size_t resolve_all(uint32_t *to, const uint32_t *from, size_t n,
                          size_t base, size_t total) {
  size_t bad = 0;
  for (size_t i = 0; i < n; i++) {
    uint32_t index = from[i];
    if (index >= total && index != OBJ_NONE) {
      int64_t found = resolve(index, base);
      bool ok = found >= 0 && found < (int64_t)total;
      bad += !ok;
      index = ok ? (uint32_t)found : MESH_NONE;
    }
    to[i] = index;
  }
  return bad;
}

// The faces of a chunk with some index out of range.
static obj_flaw find_flaw(const obj_chunk *c, const uint32_t *given,
                          size_t base, size_t total) {
  obj_flaw flaw = {0};
  size_t corner = 0;
  for (size_t face = 0; face < c->face_count; face++) {
    size_t end = corner + (c->faces != NULL ? c->faces[face] : 3);
    bool bad = false;
    for (uint32_t found; corner < end; corner++) {
      if (resolve_all(&found, given + corner, 1, base, total) == 0) continue;
      if (flaw.count == 0 && !bad) flaw.index = resolve(given[corner], base);
      if (flaw.count == 0) flaw.first = face;
      bad = true;
    }
    flaw.count += bad;
  }
  return flaw;
}

// One kind of index: what the chunk has, the array of the mesh (NULL when it
// has none), where the chunk's elements begin and how many there are in all.
typedef struct index_kind {
  const uint32_t *given;
  uint32_t *mesh;
  size_t base, total;
} index_kind;

// Whether any corner has an index.
static bool has_index(const uint32_t *index, size_t n) {
  for (size_t i = 0; i < n; i++)
    if (index[i] != MESH_NONE) return true;
  return false;
}

// Resolve one kind of index into `to`, which has room for the corners.
static obj_flaw merge_kind(const obj_chunk *c, const index_kind *k,
                           uint32_t *to, bool *has) {
  size_t n = c->corner_count;
  if (k->given == NULL) {
    memset(to, 0xff, n * sizeof *to);
    return (obj_flaw){0};
  }
  size_t bad = resolve_all(to, k->given, n, k->base, k->total);
  *has = has_index(to, n);
  return bad > 0 ? find_flaw(c, k->given, k->base, k->total) : (obj_flaw){0};
}

// Whether triangle t of m has no area at all, so that no ray can hit it.
static bool is_flat(const mesh *m, size_t t) {
  const uint32_t *i = m->position_index + 3 * t;
  vec3 a = m->positions[i[0]], b = m->positions[i[1]], c = m->positions[i[2]];
  double bx = (double)b.x - (double)a.x, cx = (double)c.x - (double)a.x;
  double by = (double)b.y - (double)a.y, cy = (double)c.y - (double)a.y;
  double bz = (double)b.z - (double)a.z, cz = (double)c.z - (double)a.z;
  return by * cz == bz * cy && bz * cx == bx * cz && bx * cy == by * cx;
}

// The flat ones among the faces that were triangles as written; the first
// triangle of the chunk is number t.
static obj_flaw find_flat(const mesh *m, const obj_chunk *c, size_t t) {
  obj_flaw flaw = {0};
  for (size_t face = 0; face < c->face_count; face++) {
    size_t n = c->faces != NULL ? c->faces[face] : 3;
    if (n == 3 && is_flat(m, t) && flaw.count++ == 0) flaw.first = face;
    t += n - 2;
  }
  return flaw;
}

// Cut a polygon into triangles, given as corners from 0; false when it crosses
// itself or has no area.
static bool cut_polygon(const mesh *m, const uint32_t *positions, size_t n,
                        obj_scratch *s) {
  s->points = array_grow(s->points, &s->point_room, n, sizeof *s->points);
  s->corners =
      array_grow(s->corners, &s->corner_room, 3 * n, sizeof *s->corners);
  for (size_t i = 0; i < n; i++)
    s->points[i] = m->positions[positions[i]];
  bool ok = polygon_triangulate(s->points, n, s->corners, &s->mem);
  arena_free(&s->mem);
  return ok;
}

// Cut all faces of a chunk, whose corners are resolved in the scratch memory,
// and write the triangles into the kinds' arrays from `out` on.
static obj_flaw cut_faces(const mesh *m, const obj_chunk *c,
                          const index_kind kinds[3], size_t out,
                          obj_scratch *s) {
  obj_flaw flaw = {0};
  size_t first = 0;
  for (size_t face = 0; face < c->face_count; face++) {
    size_t n = c->faces[face];
    if (!cut_polygon(m, s->resolved[0] + first, n, s) && flaw.count++ == 0)
      flaw.first = face;
    for (int k = 0; k < 3; k++)
      for (size_t i = 0; kinds[k].mesh != NULL && i < 3 * (n - 2); i++)
        kinds[k].mesh[out + i] = s->resolved[k][first + s->corners[i]];
    first += n;
    out += 3 * (n - 2);
  }
  return flaw;
}

obj_findings obj_merge_faces(const mesh *m, const obj_chunk *c,
                             const obj_place *at, obj_scratch *s) {
  index_kind kinds[3] = {
      {c->position_indices, m->position_index, at->position, m->position_count},
      {c->texcoord_indices, m->texcoord_index, at->texcoord, m->texcoord_count},
      {c->normal_indices, m->normal_index, at->normal, m->normal_count},
  };
  obj_findings f = {0};
  size_t n = c->corner_count, out = 3 * at->triangle;
  if (n == 0) return f;
  for (int k = 0; k < 3; k++) {
    // Triangles go straight into the mesh.
    uint32_t *to = kinds[k].mesh != NULL ? kinds[k].mesh + out : NULL;
    if (to != NULL) pages_expect(to, 3 * c->triangle_count * sizeof *to);
    if (to == NULL || c->faces != NULL) {
      s->resolved[k] = array_grow(s->resolved[k], &s->resolved_room[k], n,
                                  sizeof *s->resolved[k]);
      to = s->resolved[k];
    }
    f.index[k] = merge_kind(c, &kinds[k], to, &f.has[k]);
  }
  if (f.index[0].count > 0) return f;
  if (c->faces != NULL) f.polygon = cut_faces(m, c, kinds, out, s);
  f.flat = find_flat(m, c, at->triangle);
  return f;
}

void obj_scratch_free(obj_scratch *s) {
  array_free(s->points);
  array_free(s->corners);
  for (int k = 0; k < 3; k++)
    array_free(s->resolved[k]);
  arena_free(&s->mem);
  *s = (obj_scratch){0};
}
