// path_find.h — files named inside other files: found the way people's
// exporters mean it, and not outside of the folder of the scene.

#ifndef PATH_FIND_H
#define PATH_FIND_H

#include "arena.h"
#include "report.h"

#include <stdbool.h>

// So many names without a file are looked for in all ways, the rest only as
// they stand: each guess reads a folder.
enum { PATH_MAX_GUESSES = 1000 };

// Where names are looked for, and who hears about it.
typedef struct path_search {
  const char *root;    // of path_root; NULL: names may lead anywhere
  const char *folder;  // of the file that the name stands in
  const char *place;   // "file:line"
  arena *mem;
  report *r;
  int *misses;  // counts names without a file, or NULL
} path_search;

// What a name led to.
typedef struct path_found {
  char *path;         // NULL when there is no such file
  const char *tried;  // the path that was expected
  bool outside;       // path is NULL, and there is one outside of the root
} path_found;

// The folder of a path ("." when it has none).
char *path_folder(arena *mem, const char *path);

// A path without links and dots, which is the same for all names of a file;
// the path itself where nothing is.
char *path_real(arena *mem, const char *path);

// The real path of the folder of the file that somebody asked for: what files
// from there may name lies in it or below.
char *path_root(arena *mem, const char *path);

// Whether path, all links followed, lies below root; always when root is NULL.
bool path_is_inside(const char *root, const char *path);

// Find the file that `name` means: as it stands (back-slashes become slashes),
// relative to the folder or absolute; then its last component in the folder;
// then the same without regard to case.  Anything but the first way is noted.
// A name as long as PATH_MAX is no file's.
path_found path_find(const path_search *s, const char *name);

// Why there is no path, for a message: "WHAT not found, tried PATH", or that
// it is outside.
char *path_missing(const path_found *f, const char *what, arena *mem);

#endif
