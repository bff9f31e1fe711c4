// mesh_join.h — meshes put in their places, and several made into one.

#ifndef MESH_JOIN_H
#define MESH_JOIN_H

#include "error.h"
#include "mesh.h"

// Scale m about the origin by scale > 0; with up_z also turn it so that its
// +Z becomes +Y: (x, y, z) to (x, z, -y).
void mesh_place(mesh *m, float scale, bool up_z);

// One mesh of n >= 1 parts, in order: indices and names are shifted, and equal
// names of different parts stay different.  One part is returned as it is.
// Fails when positions or triangles exceed 2^31.
bool mesh_join(mesh *out, const mesh *parts, size_t n, arena *mem, error *err);

// Bounds of the finite corners of triangles; lo > hi when there are none.
void mesh_extent(const mesh *m, vec3 *lo, vec3 *hi);

// Whether the triangles t with tag[t] == value close off a solid: every edge
// is shared by an even number of them.  Corners at equal places are one.
bool mesh_is_closed(const mesh *m, const uint32_t *tag, uint32_t value);

#endif
