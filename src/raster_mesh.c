// raster_mesh.c

#include "raster_mesh.h"

#include <stddef.h>
#include <stdlib.h>

// What the shaders get, by fours: texture coordinates and the material's number
// fill the fourth places.
typedef struct vertex {
  vec3 position;
  float curved;  // 1 where the normals say that the triangle is no facet
  vec3 normal;
  float u;
  vec3 facet;
  float v;
  vec3 color;
  float material;
} vertex;

// The unit normal by the winding, in double as in the path engine; +z where
// the triangle has no area.
static vec3 facet_normal(const vec3 p[3]) {
  double a[3] = {(double)p[1].x - (double)p[0].x,
                 (double)p[1].y - (double)p[0].y,
                 (double)p[1].z - (double)p[0].z};
  double b[3] = {(double)p[2].x - (double)p[0].x,
                 (double)p[2].y - (double)p[0].y,
                 (double)p[2].z - (double)p[0].z};
  double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                 a[0] * b[1] - a[1] * b[0]};
  double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  if (!(length > 0)) return (vec3){0, 0, 1};
  return (vec3){(float)(n[0] / length), (float)(n[1] / length),
                (float)(n[2] / length)};
}

// A corner's normal this near to the facet's, 0.1 degrees, means the facet.
#define FLAT_COSINE 0.9999985f

// The shading normals of the corners: the file's, or the facet's where it
// gives none; turned to the winding's side where as a whole they are not.
static void shading_normals(vertex v[3], const mesh *m, size_t triangle) {
  bool own[3] = {false, false, false};
  float side = 0;
  for (size_t i = 0; i < 3; i++) {
    v[i].normal = v[i].facet;
    uint32_t k =
        m->normal_index == NULL ? MESH_NONE : m->normal_index[3 * triangle + i];
    if (k == MESH_NONE) continue;
    vec3 n = vec3_unit(m->normals[k]);
    if (!(fabsf(vec3_dot(n, n) - 1) < 0.01f)) continue;
    v[i].normal = n;
    own[i] = true;
    side += vec3_dot(n, v[i].facet);
  }
  for (size_t i = 0; i < 3; i++)
    if (own[i] && side < 0) v[i].normal = vec3_neg(v[i].normal);
  float curved = 0;
  for (size_t i = 0; i < 3; i++)
    if (vec3_dot(v[i].normal, v[i].facet) < FLAT_COSINE) curved = 1;
  for (size_t i = 0; i < 3; i++)
    v[i].curved = curved;
}

// The three vertices of a triangle; false where one is not finite.
static bool vertices_of(vertex v[3], const mesh *m, size_t triangle,
                        vec3 origin) {
  vec3 p[3];
  for (size_t i = 0; i < 3; i++) {
    uint32_t k = m->position_index[3 * triangle + i];
    p[i] = m->positions[k];
    if (!vec3_finite(p[i])) return false;
    v[i] = (vertex){.position = vec3_sub(p[i], origin), .color = vec3_all(1)};
    if (m->colors != NULL) v[i].color = m->colors[k];
    uint32_t t = m->texcoord_index == NULL
                     ? MESH_NONE
                     : m->texcoord_index[3 * triangle + i];
    if (t == MESH_NONE) continue;
    v[i].u = m->texcoords[t].x;
    v[i].v = m->texcoords[t].y;
  }
  for (size_t i = 0; i < 3; i++)
    v[i].facet = facet_normal(p);
  shading_normals(v, m, triangle);
  return true;
}

static bool lets_through(const scene *s, uint32_t of) {
  return s->material_count > 0 && s->materials[of].passes;
}

// Room for the parts, and for the sheets.
static void make_parts(raster_mesh *out, const scene *s, arena *mem) {
  out->blocks = raster_blocks_of(s, mem);
  out->of_block = ARENA_NEW(mem, raster_part, out->blocks.count);
  out->part_count = s->material_count > 0 ? s->material_count : 1;
  out->parts = ARENA_NEW(mem, raster_part, out->part_count);
  out->block_end = ARENA_NEW(mem, size_t, out->part_count);
  size_t sheets = 0;
  for (size_t i = 0; i < out->blocks.count; i++)
    if (lets_through(s, out->blocks.items[i].material))
      sheets += out->blocks.items[i].count;
  out->sheets = ARENA_NEW(mem, raster_sheet, sheets);
  out->sheet_index = ARENA_NEW(mem, uint32_t, 3 * sheets);
}

static void add_sheet(raster_mesh *out, const vertex v[3], uint32_t first,
                      uint32_t of) {
  vec3 sum = vec3_add(v[0].position, vec3_add(v[1].position, v[2].position));
  out->sheets[out->sheet_count++] = (raster_sheet){
      .middle = vec3_scale(sum, 1.0f / 3), .first = first, .material = of};
}

// Append the triangles of a block.
static void fill_block(raster_mesh *out, raster_part *part, vertex *all,
                       const scene *s, const raster_block *b, bool no_edges) {
  for (size_t t = b->first; t < (size_t)b->first + b->count; t++) {
    vertex *v = all + part->first + part->count;
    if (no_edges && raster_is_edge(&s->mesh, t)) continue;
    if (!vertices_of(v, &s->mesh, t, out->origin)) continue;
    for (size_t i = 0; i < 3; i++)
      v[i].material = (float)b->material;
    if (lets_through(s, b->material))
      add_sheet(out, v, (uint32_t)(v - all), b->material);
    part->count += 3;
  }
}

// Fill the parts block by block; returns the vertices that there are.
static size_t fill_parts(raster_mesh *out, vertex *all, const scene *s,
                         bool no_edges) {
  GLint at = 0;
  size_t i = 0;
  for (size_t of = 0; of < out->part_count; of++) {
    out->parts[of].first = at;
    for (; i < out->blocks.count && out->blocks.items[i].material == of; i++) {
      raster_part *part = &out->of_block[i];
      part->first = at;
      fill_block(out, part, all, s, &out->blocks.items[i], no_edges);
      at += part->count;
    }
    out->parts[of].count = at - out->parts[of].first;
    out->block_end[of] = i;
  }
  return (size_t)at;
}

static void describe_vertices(const gl_api *f) {
  const size_t offsets[] = {offsetof(vertex, position),
                            offsetof(vertex, normal), offsetof(vertex, facet),
                            offsetof(vertex, color)};
  for (GLuint i = 0; i < 4; i++) {
    f->EnableVertexAttribArray(i);
    f->VertexAttribPointer(i, 4, GL_FLOAT, GL_FALSE, sizeof(vertex),
                           (const void *)(uintptr_t)offsets[i]);
  }
}

void raster_mesh_upload(raster_mesh *out, const gl *g, const scene *s,
                        bool no_edges, arena *mem) {
  const gl_api *f = gl_functions(g);
  *out = (raster_mesh){0};
  vec3 middle = vec3_scale(vec3_add(s->lo, s->hi), 0.5f);
  if (vec3_finite(middle)) out->origin = middle;
  make_parts(out, s, mem);
  arena scratch = {0};
  vertex *all = ARENA_NEW(&scratch, vertex, 3 * s->mesh.triangle_count);
  size_t count = fill_parts(out, all, s, no_edges);
  f->GenVertexArrays(1, &out->vertices);
  f->BindVertexArray(out->vertices);
  f->GenBuffers(1, &out->buffer);
  f->BindBuffer(GL_ARRAY_BUFFER, out->buffer);
  f->BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(count * sizeof *all), all,
                GL_STATIC_DRAW);
  out->bytes = count * sizeof *all;
  describe_vertices(f);
  f->GenBuffers(1, &out->indices);
  f->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, out->indices);
  arena_free(&scratch);
}

const raster_part *raster_mesh_in(const raster_mesh *m, size_t of,
                                  const raster_frustum *view, arena *mem,
                                  size_t *count) {
  size_t begin = of > 0 ? m->block_end[of - 1] : 0;
  size_t end = m->block_end[of];
  raster_part *out = ARENA_NEW(mem, raster_part, end - begin);
  *count = 0;
  for (size_t i = begin; i < end; i++) {
    raster_part next = m->of_block[i];
    if (next.count == 0) continue;
    if (view != NULL && raster_block_outside(&m->blocks.items[i], view))
      continue;
    raster_part *last = *count > 0 ? &out[*count - 1] : NULL;
    if (last != NULL && last->first + last->count == next.first)
      last->count += next.count;
    else
      out[(*count)++] = next;
  }
  return out;
}

void raster_mesh_free(const gl *g, raster_mesh *m) {
  const gl_api *f = gl_functions(g);
  f->DeleteVertexArrays(1, &m->vertices);
  f->DeleteBuffers(1, &m->buffer);
  f->DeleteBuffers(1, &m->indices);
}

// Far ones first; of equally far ones the first in the file.
static int farther(const void *a, const void *b) {
  const raster_sheet *x = a, *y = b;
  if (x->depth != y->depth) return x->depth < y->depth ? 1 : -1;
  return x->first < y->first ? -1 : x->first > y->first;
}

void raster_mesh_sort(raster_mesh *m, const gl *g, vec3 eye, vec3 forward) {
  const gl_api *f = gl_functions(g);
  for (size_t i = 0; i < m->sheet_count; i++) {
    raster_sheet *s = &m->sheets[i];
    s->depth = vec3_dot(vec3_sub(s->middle, eye), forward);
  }
  qsort(m->sheets, m->sheet_count, sizeof *m->sheets, farther);
  for (size_t i = 0; i < 3 * m->sheet_count; i++)
    m->sheet_index[i] = m->sheets[i / 3].first + (uint32_t)(i % 3);
  f->BindVertexArray(m->vertices);
  f->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, m->indices);
  f->BufferData(GL_ELEMENT_ARRAY_BUFFER,
                (GLsizeiptr)(3 * m->sheet_count * sizeof *m->sheet_index),
                m->sheet_index, GL_STREAM_DRAW);
}
