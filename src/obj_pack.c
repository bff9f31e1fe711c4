// obj_pack.c

#include "obj_pack.h"

#include "pages.h"

#include <string.h>

// n bytes in the store, aligned for any of the arrays.
static void *store_take(obj_store *s, size_t bytes) {
  bytes = (bytes + 15) / 16 * 16;
  if (bytes > s->left) {
    s->left = bytes > s->block_bytes ? bytes : s->block_bytes;
    s->at = arena_alloc(&s->mem, s->left, 1);
    pages_expect(s->at, s->left);
  }
  void *p = s->at;
  s->at += bytes;
  s->left -= bytes;
  return p;
}

// A copy of an array in the store; NULL when it is empty.
static void *store_copy(obj_store *s, const void *from, size_t bytes) {
  if (bytes == 0) return NULL;
  return memcpy(store_take(s, bytes), from, bytes);
}

// One kind of index of n corners, whose first one is given.
static uint32_t *pack_indices(obj_store *s, const uint32_t *first, size_t n) {
  uint32_t *packed = store_take(s, n * sizeof *packed);
  for (size_t i = 0; i < n; i++)
    packed[i] = first[3 * i];
  return packed;
}

static void pack_corners(obj_chunk *p, const obj_chunk *c, obj_store *s) {
  p->corners = NULL;
  p->faces = NULL;
  size_t n = c->corner_count;
  if (n == 0) return;
  p->position_indices = pack_indices(s, &c->corners->position, n);
  if (c->has_texcoord)
    p->texcoord_indices = pack_indices(s, &c->corners->texcoord, n);
  if (c->has_normal)
    p->normal_indices = pack_indices(s, &c->corners->normal, n);
  if (n != 3 * c->face_count)
    p->faces = store_copy(s, c->faces, c->face_count * sizeof *c->faces);
}

obj_chunk obj_pack(obj_chunk *c, obj_store *s) {
  obj_chunk p = *c;
  p.positions = store_copy(s, c->positions, c->position_count * sizeof(vec3));
  p.normals = store_copy(s, c->normals, c->normal_count * sizeof(vec3));
  p.texcoords = store_copy(s, c->texcoords, c->texcoord_count * sizeof(vec2));
  p.colors = NULL;
  if (c->has_color)
    p.colors = store_copy(s, c->colors, c->position_count * sizeof(vec3));
  pack_corners(&p, c, s);
  p.events = store_copy(s, c->events, c->event_count * sizeof *c->events);
  p.names = store_copy(s, c->names, c->name_bytes);
  p.unknown = store_copy(s, c->unknown, c->unknown_count * sizeof *c->unknown);
  obj_chunk_reset(c);
  return p;
}
