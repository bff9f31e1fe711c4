// obj_merge.c

#include "obj_merge.h"

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

// memcpy for arrays that may be NULL when they are empty.
static void copy_items(void *to, const void *from, size_t bytes) {
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
    m->colors[at->position + i] =
        c->colors != NULL ? c->colors[i] : vec3_all(1);
}

// A chunk's index as one of the whole file; negative when it reaches back too
// far.
static int64_t resolve(uint32_t index, size_t base) {
  if (index < OBJ_RELATIVE) return index;
  return (int64_t)base + (int64_t)(index - OBJ_RELATIVE) - (int64_t)OBJ_BACK;
}

static void add_flaw(obj_flaw *flaw, size_t face) {
  if (flaw->count++ == 0) flaw->first = face;
}

// Resolve an optional index in place: MESH_NONE when it is out of range.
static bool resolve_optional(uint32_t *index, size_t base, size_t total) {
  if (*index == OBJ_NONE) return true;
  int64_t i = resolve(*index, base);
  bool ok = i >= 0 && i < (int64_t)total;
  *index = ok ? (uint32_t)i : MESH_NONE;
  return ok;
}

// Resolve the n corners of a face in place.
static void resolve_face(const mesh *m, obj_corner *corners, size_t n,
                         const obj_place *at, size_t face, obj_findings *f) {
  bool texcoords = true, normals = true;
  for (size_t i = 0; i < n; i++) {
    obj_corner *c = &corners[i];
    int64_t p = resolve(c->position, at->position);
    if (p < 0 || p >= (int64_t)m->position_count) {
      if (f->position.count == 0) f->bad_position = p;
      add_flaw(&f->position, face);
      p = 0;
    }
    c->position = (uint32_t)p;
    texcoords &=
        resolve_optional(&c->texcoord, at->texcoord, m->texcoord_count);
    normals &= resolve_optional(&c->normal, at->normal, m->normal_count);
    if (c->texcoord != MESH_NONE) f->has_texcoord = true;
    if (c->normal != MESH_NONE) f->has_normal = true;
  }
  if (!texcoords) add_flaw(&f->texcoord, face);
  if (!normals) add_flaw(&f->normal, face);
}

// Write one corner of the mesh.
static void set_corner(mesh *m, size_t at, obj_corner c) {
  m->position_index[at] = c.position;
  if (m->texcoord_index != NULL) m->texcoord_index[at] = c.texcoord;
  if (m->normal_index != NULL) m->normal_index[at] = c.normal;
}

// Cut a face of n > 3 corners into triangles; false when it crosses itself or
// has no area.
static bool merge_polygon(mesh *m, const obj_corner *corners, size_t n,
                          size_t at, obj_scratch *s) {
  s->points = array_grow(s->points, &s->point_room, n, sizeof *s->points);
  s->corners =
      array_grow(s->corners, &s->corner_room, 3 * n, sizeof *s->corners);
  for (size_t i = 0; i < n; i++)
    s->points[i] = m->positions[corners[i].position];
  bool ok = polygon_triangulate(s->points, n, s->corners, &s->mem);
  arena_free(&s->mem);
  for (size_t i = 0; i < 3 * (n - 2); i++)
    set_corner(m, at + i, corners[s->corners[i]]);
  return ok;
}

obj_findings obj_merge_faces(mesh *m, obj_chunk *c, const obj_place *at,
                             obj_scratch *scratch) {
  obj_findings f = {0};
  obj_corner *corners = c->corners;
  size_t out = 3 * at->triangle;
  for (size_t face = 0; face < c->face_count; face++) {
    size_t n = c->faces[face];
    resolve_face(m, corners, n, at, face, &f);
    if (f.position.count > 0) return f;
    if (n == 3) {
      for (size_t i = 0; i < 3; i++)
        set_corner(m, out + i, corners[i]);
    } else if (!merge_polygon(m, corners, n, out, scratch)) {
      add_flaw(&f.polygon, face);
    }
    corners += n;
    out += 3 * (n - 2);
  }
  return f;
}

void obj_scratch_free(obj_scratch *s) {
  array_free(s->points);
  array_free(s->corners);
  arena_free(&s->mem);
  *s = (obj_scratch){0};
}
