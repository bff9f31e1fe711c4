// path_find.c

// For realpath, which POSIX has only with XSI.
#define _XOPEN_SOURCE 700

#include "path_find.h"

#include <dirent.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

char *path_folder(arena *mem, const char *path) {
  const char *slash = strrchr(path, '/');
  if (slash == NULL) return arena_text(mem, ".", 1);
  if (slash == path) return arena_text(mem, "/", 1);
  return arena_text(mem, path, (size_t)(slash - path));
}

char *path_real(arena *mem, const char *path) {
  char real[PATH_MAX];
  if (realpath(path, real) != NULL) path = real;
  return arena_text(mem, path, strlen(path));
}

char *path_root(arena *mem, const char *path) {
  return path_real(mem, path_folder(mem, path));
}

bool path_is_inside(const char *root, const char *path) {
  char real[PATH_MAX];
  if (root == NULL) return true;
  if (realpath(path, real) == NULL) return false;
  size_t n = strlen(root);
  if (n > 0 && root[n - 1] == '/') n--;
  return strncmp(real, root, n) == 0 && (real[n] == '/' || real[n] == '\0');
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

// The file of that name without regard to case, folder by folder, in scratch;
// NULL when there is none.  No folder outside of the root is looked into.
static char *path_any_case(const path_search *s, const char *name,
                           arena *scratch) {
  char *rest = arena_text(scratch, name, strlen(name));
  bool here = strcmp(s->folder, ".") == 0;
  const char *from = *rest == '/' ? "/" : here ? "" : s->folder;
  char *found = arena_text(scratch, from, strlen(from));
  while (*rest != '\0') {
    char *part = rest;
    size_t n = strcspn(part, "/");
    rest += n;
    if (*rest == '/') *rest++ = '\0';
    if (*part == '\0' || strcmp(part, ".") == 0) continue;
    if (!path_is_inside(s->root, *found != '\0' ? found : ".")) return NULL;
    found = entry_any_case(scratch, found, part);
    if (found == NULL) return NULL;
  }
  return is_there(found) ? found : NULL;
}

// Whether f ends with this candidate; one outside is remembered.
static bool settle(path_found *f, const path_search *s, const char *path) {
  if (path == NULL || !is_there(path)) return false;
  bool inside = path_is_inside(s->root, path);
  if (inside) f->path = arena_text(s->mem, path, strlen(path));
  if (!inside) f->outside = true;
  return inside;
}

// The ways to find what is not where its name says.
static bool guess(path_found *f, const path_search *s, const char *name) {
  if (s->misses != NULL && *s->misses >= PATH_MAX_GUESSES) return false;
  arena scratch = {0};
  const char *slash = strrchr(name, '/');
  const char *last = slash != NULL ? slash + 1 : name;
  bool found = settle(f, s, path_join(&scratch, s->folder, last)) ||
               settle(f, s, path_any_case(s, name, &scratch)) ||
               settle(f, s, path_any_case(s, last, &scratch));
  if (!found && s->misses != NULL) ++*s->misses;
  arena_free(&scratch);
  return found;
}

path_found path_find(const path_search *s, const char *name) {
  char *clean = arena_text(s->mem, name, strlen(name));
  for (char *p = clean; *p != '\0'; p++)
    if (*p == '\\') *p = '/';
  size_t n = strlen(clean);
  path_found f = {.tried = path_join(s->mem, s->folder, clean)};
  if (n == 0 || n >= PATH_MAX || clean[n - 1] == '/') return f;
  if (!settle(&f, s, f.tried) && !guess(&f, s, clean)) return f;
  f.outside = false;
  if (strcmp(f.path, f.tried) != 0 || strcmp(clean, name) != 0)
    report_note(s->r, "%s: \"%s\" found as \"%s\"", s->place, name, f.path);
  return f;
}

char *path_missing(const path_found *f, const char *what, arena *mem) {
  if (!f->outside)
    return arena_format(mem, "%s not found, tried %s", what, f->tried);
  return arena_format(mem,
                      "%s %s is outside of the folder of the scene, "
                      "--allow-outside reads it",
                      what, f->tried);
}
