// path_find.h — files named inside other files: found the way people's
// exporters mean it.

#ifndef PATH_FIND_H
#define PATH_FIND_H

#include "arena.h"
#include "report.h"

// The folder of a path ("." when it has none).
char *path_folder(arena *mem, const char *path);

// Find the file that `name` means, written in a file that lies in `folder`:
// as it stands (back-slashes become slashes), relative to folder or absolute;
// then its last component in folder; then the same without regard to case.
// Anything but the first way is noted with place.  NULL when there is none:
// *tried is then the path that was expected.
char *path_find(arena *mem, const char *folder, const char *name,
                const char *place, report *r, const char **tried);

#endif
