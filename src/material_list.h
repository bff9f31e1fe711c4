// material_list.h — the materials of all triangles of a scene.

#ifndef MATERIAL_LIST_H
#define MATERIAL_LIST_H

#include "material.h"
#include "mesh.h"
#include "scene_file.h"

// The distinct outcomes of the decision table, in order of first use, and for
// each triangle which.
typedef struct material_list {
  material *materials;
  size_t count;
  uint32_t *of_triangle;
} material_list;

// Read the libraries of the mesh at path, and set written[i] to what they say
// of its material_names[i], or to NULL.  A library that is missing is one
// warning; a name that no library defines is one too, unless a library is
// missing.  root is that of mtl_read_all.
bool material_list_written(const mtl_material **written, const mesh *m,
                           const char *path, const char *root, arena *mem,
                           report *r, error *err);

// Decide for every run of m.  A material of the scene file goes before one of
// the libraries with the same name.  Fails when an assign names no material.
bool material_list_decide(material_list *out, const mesh *m,
                          const mtl_material *const *written,
                          const scene_file *file, bool name_rules, arena *mem,
                          error *err);

// Find the textures of all materials and read their heads; one that cannot be
// had is left out with a warning that names the path tried.
void material_list_find(material_list *list, texture_store *store, report *r);

// Decode what was found: of material i the statements whose bits are set in
// wanted[i], or all where wanted is NULL.
void material_list_decode(material_list *list, texture_store *store,
                          const unsigned *wanted, report *r);

#endif
