// mtl.h — MTL material libraries: what each newmtl says, as it says it.

#ifndef MTL_H
#define MTL_H

#include "arena.h"
#include "error.h"
#include "mesh.h"
#include "mtl_map.h"
#include "name_table.h"
#include "report.h"
#include "text.h"
#include "vec.h"

#include <stdint.h>

// The statements facet knows.  A material remembers which it has seen, and
// where.
typedef enum mtl_key {
  MTL_KA,
  MTL_KD,
  MTL_KS,
  MTL_KE,
  MTL_TF,  // colours, linear
  MTL_NS,
  MTL_NI,
  MTL_D,
  MTL_TR,
  MTL_PR,
  MTL_PM,
  MTL_ILLUM,  // numbers
  MTL_MAP_KA,
  MTL_MAP_KD,
  MTL_MAP_KS,
  MTL_MAP_KE,
  MTL_MAP_NS,
  MTL_MAP_D,
  MTL_MAP_PR,
  MTL_MAP_PM,
  MTL_MAP_BUMP,
  MTL_MAP_NORM,  // textures
  MTL_KEY_COUNT
} mtl_key;

enum { MTL_FIRST_MAP = MTL_MAP_KA };

// One material.  Values that the file does not give are the defaults below
// and line[key] is 0 there.
typedef struct mtl_material {
  const char *name;
  const char *file;    // path of the library as opened
  const char *folder;  // where its textures are looked for
  uint32_t line[MTL_KEY_COUNT];
  uint32_t newmtl_line;
  vec3 ka, kd, ks, ke, tf;  // 0, 0.8 (1 with map_Kd), 0, 0, 1
  float ns, ni, d, pr, pm;  // 0, 1, 1, 0.5, 0; d is 1 - Tr where only Tr is
  int illum;                // -1
  mtl_map map[MTL_KEY_COUNT - MTL_FIRST_MAP];
} mtl_material;

// Materials by order of appearance; a name that comes again replaces the
// first, with a warning.  Start with {0}; it lives in the arena that it is
// read into.
typedef struct mtl_library {
  mtl_material *materials;
  size_t count, room;
  name_table names;  // name number = material number
  size_t missing;    // mtllib lines of which something was not found
} mtl_library;

// A material of the given name with every default.
mtl_material mtl_default(const char *name);

// Append the materials of the library at path.  Unknown statements are noted;
// a malformed number is an error.
bool mtl_read(mtl_library *lib, const char *path, arena *mem, report *r,
              error *err);

// The same for the text of a library; path is for messages and for finding its
// textures.
bool mtl_read_text(mtl_library *lib, span text, const char *path, arena *mem,
                   report *r, error *err);

// Read every library that m names, looked for beside the OBJ at obj_path (its
// path, for messages too): the whole rest of a mtllib line as one name first,
// then each of its words.  One that is not there is a warning, and so is one
// outside of root (path_root, or NULL).
bool mtl_read_all(mtl_library *lib, const mesh *m, const char *obj_path,
                  const char *root, arena *mem, report *r, error *err);

// A material of that name in lib, appended when it is new; the pointer is good
// until the next one is added.
mtl_material *mtl_add(mtl_library *lib, span name, arena *mem);

// Apply one statement (keyword taken off) to m; used by mtl_read and by scene
// files.  place is "file:line".  *known is false for a keyword that is not
// MTL; the result is false only for a malformed statement.
bool mtl_statement(mtl_material *m, span key, span rest, uint32_t line,
                   const char *place, bool *known, arena *mem, report *r,
                   error *err);

// The keyword of a key as MTL spells it ("map_Kd").
const char *mtl_key_name(mtl_key key);

// The index of a material by name, -1 when there is none.
long mtl_find(const mtl_library *lib, const char *name);

#endif
