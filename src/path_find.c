// path_find.c

#include "path_find.h"

#include <dirent.h>
#include <stdbool.h>
#include <string.h>
#include <sys/stat.h>

char *path_folder(arena *mem, const char *path) {
  const char *slash = strrchr(path, '/');
  if (slash == NULL) return arena_text(mem, ".", 1);
  if (slash == path) return arena_text(mem, "/", 1);
  return arena_text(mem, path, (size_t)(slash - path));
}

// Whether something other than a folder lies at path.
static bool is_there(const char *path) {
  struct stat info;
  return stat(path, &info) == 0 && !S_ISDIR(info.st_mode);
}

// folder/name, or name alone when it is absolute.
static char *path_join(arena *mem, const char *folder, const char *name) {
  if (name[0] == '/' || strcmp(folder, ".") == 0)
    return arena_text(mem, name, strlen(name));
  return arena_format(mem, "%s/%s", folder, name);
}

// Equal but for the case of ASCII letters, in any locale.
static bool same_but_case(const char *a, const char *b) {
  for (; *a != '\0' && *b != '\0'; a++, b++) {
    char x = *a >= 'A' && *a <= 'Z' ? (char)(*a + 32) : *a;
    char y = *b >= 'A' && *b <= 'Z' ? (char)(*b + 32) : *b;
    if (x != y) return false;
  }
  return *a == *b;
}

// The entry of folder that is called name but for case, as folder/entry; the
// first in byte order when there are several, NULL when there is none.
static char *entry_any_case(arena *mem, const char *folder, const char *name) {
  DIR *d = opendir(*folder != '\0' ? folder : ".");
  if (d == NULL) return NULL;
  char *best = NULL;
  for (struct dirent *e; (e = readdir(d)) != NULL;)
    if (same_but_case(e->d_name, name) &&
        (best == NULL || strcmp(e->d_name, best) < 0))
      best = arena_text(mem, e->d_name, strlen(e->d_name));
  closedir(d);
  if (best == NULL) return NULL;
  if (*folder == '\0') return best;
  const char *slash = strcmp(folder, "/") == 0 ? "" : "/";
  return arena_format(mem, "%s%s%s", folder, slash, best);
}

// The file at path without regard to case, folder by folder; NULL when there
// is none.
static char *path_any_case(arena *mem, const char *path) {
  char *rest = arena_text(mem, path, strlen(path));
  char *found = arena_text(mem, "", 0);
  if (*rest == '/') found = arena_text(mem, "/", 1);
  while (*rest != '\0') {
    char *part = rest;
    size_t n = strcspn(part, "/");
    rest += n;
    if (*rest == '/') *rest++ = '\0';
    if (*part == '\0') continue;
    found = entry_any_case(mem, found, part);
    if (found == NULL) return NULL;
  }
  return is_there(found) ? found : NULL;
}

char *path_find(arena *mem, const char *folder, const char *name,
                const char *place, report *r, const char **tried) {
  char *clean = arena_text(mem, name, strlen(name));
  for (char *p = clean; *p != '\0'; p++)
    if (*p == '\\') *p = '/';
  const char *slash = strrchr(clean, '/');
  const char *last = slash != NULL ? slash + 1 : clean;
  char *wanted = path_join(mem, folder, clean);
  char *beside = path_join(mem, folder, last);
  *tried = wanted;
  if (*last == '\0') return NULL;
  char *found = wanted;
  if (!is_there(found)) found = beside;
  if (!is_there(found)) found = path_any_case(mem, wanted);
  if (found == NULL) found = path_any_case(mem, beside);
  if (found == NULL) return NULL;
  if (found != wanted || strcmp(clean, name) != 0)
    report_note(r, "%s: \"%s\" found as \"%s\"", place, name, found);
  return found;
}
