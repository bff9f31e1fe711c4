// mtl.h — MTL material libraries: what each newmtl says, as it says it.

#ifndef MTL_H
#define MTL_H

#include "arena.h"
#include "error.h"
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

// A texture statement: its file as written and its options.
typedef struct mtl_map {
  const char *path;    // as written; NULL when the statement is absent
  vec3 scale, offset;  // -s, -o: uv' = uv * scale + offset
  float bump;          // -bm
  bool clamp;          // -clamp on
  char channel;        // -imfchan r g b m l z, 0 when not given
} mtl_map;

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
// first, with a warning.
typedef struct mtl_library {
  mtl_material *materials;
  size_t count, room;
} mtl_library;

// A material of the given name with every default.
mtl_material mtl_default(const char *name);

// Append the materials of the library at path.  Unknown statements are noted;
// a malformed number is an error.
bool mtl_read(mtl_library *lib, const char *path, arena *mem, report *r,
              error *err);

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
