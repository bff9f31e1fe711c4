// mtl_map.h — texture statements of MTL: options, then a file name.

#ifndef MTL_MAP_H
#define MTL_MAP_H

#include "arena.h"
#include "error.h"
#include "report.h"
#include "text.h"
#include "vec.h"

// A texture statement: its file as written and its options.
typedef struct mtl_map {
  const char *path;    // as written; NULL when the statement is absent
  vec3 scale, offset;  // -s, -o: uv' = uv * scale + offset
  float bump;          // -bm
  bool clamp;          // -clamp on
  char channel;        // -imfchan r g b m l z, 0 when not given
} mtl_map;

// Where a statement stands ("file:line"), and who hears about it.
typedef struct mtl_site {
  const char *place;
  arena *mem;
  report *r;
  error *err;
} mtl_site;

// Parse what follows the keyword: options with their arguments, then the file
// name, which may hold blanks or stand in quotes.  Options that facet does not
// use are noted.  A statement without a file is a warning and leaves *out
// alone; a malformed argument is an error.
bool mtl_map_parse(mtl_map *out, span rest, const mtl_site *site);

#endif
