// normals.h — shading normals where the file has none, by smoothing groups.

#ifndef NORMALS_H
#define NORMALS_H

#include "mesh.h"
#include "pool.h"

// NORMALS_AUTO: the file's where a corner has one, else by smoothing groups
// (s 0, s off and no s at all: flat).  FILE: the file's, else flat.  SMOOTH:
// one group for everything.  FLAT: none.
typedef enum normals_mode {
  NORMALS_AUTO,
  NORMALS_FILE,
  NORMALS_SMOOTH,
  NORMALS_FLAT
} normals_mode;

// Fill in normal_index and normals of m as mode asks.  A generated normal is
// the mean of the unit normals of the faces of its group around the position,
// weighted by their angle there (Thuermer and Wuethrich 1998); a face that
// differs from the corner's own by more than crease_deg is left out (180:
// none is).  Positions are joined by index, not by coordinates.
void normals_generate(mesh *m, normals_mode mode, float crease_deg, arena *mem,
                      pool *threads);

#endif
