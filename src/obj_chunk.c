// obj_chunk.c

#include "obj_chunk.h"

#include "arena.h"

void obj_add_position(obj_chunk *c, vec3 p) {
  size_t n = c->position_count++;
  if (n == c->position_room)
    c->positions = array_grow(c->positions, &c->position_room, n + 1, sizeof p);
  c->positions[n] = p;
}

void obj_add_normal(obj_chunk *c, vec3 n) {
  size_t i = c->normal_count++;
  if (i == c->normal_room)
    c->normals = array_grow(c->normals, &c->normal_room, i + 1, sizeof n);
  c->normals[i] = n;
}

void obj_add_texcoord(obj_chunk *c, vec2 t) {
  size_t i = c->texcoord_count++;
  if (i == c->texcoord_room)
    c->texcoords = array_grow(c->texcoords, &c->texcoord_room, i + 1, sizeof t);
  c->texcoords[i] = t;
}

// Room for one corner more.
void obj_grow_corners(obj_chunk *c) {
  c->corners = array_grow(c->corners, &c->corner_room, c->corner_count + 1,
                          sizeof *c->corners);
}

void obj_add_face(obj_chunk *c, size_t first, uint64_t line) {
  size_t n = c->corner_count - first, i = c->face_count++;
  if (i == c->face_room)
    c->faces = array_grow(c->faces, &c->face_room, i + 1, sizeof *c->faces);
  c->faces[i] = (uint32_t)n;
  c->triangle_count += n - 2;
  if (i == c->watched_face) {
    c->watched_line = line;
    c->watched_positions = c->position_count;
  }
}

void obj_chunk_reset(obj_chunk *c) {
  obj_chunk room = *c;
  *c = (obj_chunk){.watched_face = SIZE_MAX};
  c->positions = room.positions;
  c->position_room = room.position_room;
  c->colors = room.colors;
  c->color_room = room.color_room;
  c->normals = room.normals;
  c->normal_room = room.normal_room;
  c->texcoords = room.texcoords;
  c->texcoord_room = room.texcoord_room;
  c->corners = room.corners;
  c->corner_room = room.corner_room;
  c->faces = room.faces;
  c->face_room = room.face_room;
  c->events = room.events;
  c->event_room = room.event_room;
  c->names = room.names;
  c->name_room = room.name_room;
  c->unknown = room.unknown;
  c->unknown_room = room.unknown_room;
}

void obj_chunk_free(obj_chunk *c) {
  array_free(c->positions);
  array_free(c->colors);
  array_free(c->normals);
  array_free(c->texcoords);
  array_free(c->corners);
  array_free(c->faces);
  array_free(c->events);
  array_free(c->names);
  array_free(c->unknown);
  *c = (obj_chunk){0};
}
