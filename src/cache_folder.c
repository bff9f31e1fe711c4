// cache_folder.c

#include "cache_folder.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// Without FACET_CACHE_MIB: twenty environments with all levels, or a hundred
// with a few, or the tree over five million triangles.
enum { USUAL_MIB = 256, MOST_MIB = 1 << 24 };

// Source: XDG Base Directory Specification: a relative path is to be ignored.
char *cache_folder(arena *mem) {
  const char *cache = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
  char *base = NULL;
  if (cache != NULL && cache[0] == '/')
    base = arena_format(mem, "%s", cache);
  else if (home != NULL && home[0] == '/')
    base = arena_format(mem, "%s/.cache", home);
  if (base == NULL) return NULL;
  char *folder = arena_format(mem, "%s/facet", base);
  (void)mkdir(base, 0700);
  (void)mkdir(folder, 0700);
  return folder;
}

uint64_t cache_limit(void) {
  const char *text = getenv("FACET_CACHE_MIB");
  uint64_t mib = 0;
  if (text == NULL || text[0] == '\0') return (uint64_t)USUAL_MIB << 20;
  for (; *text >= '0' && *text <= '9'; text++)
    if (mib < MOST_MIB) mib = 10 * mib + (uint64_t)(*text - '0');
  return *text == '\0' ? mib << 20 : (uint64_t)USUAL_MIB << 20;
}

static bool has_end(const char *name, const char *end) {
  size_t n = strlen(name), k = strlen(end);
  return n >= k && strcmp(name + n - k, end) == 0;
}

// Whether a file is ours: ibl-*.bin and tree-*.bin, and as file_create begins
// them, .ibl-*.bin.*.tmp.
static bool is_ours(const char *name) {
  bool begun = name[0] == '.';
  const char *kind = begun ? name + 1 : name;
  if (strncmp(kind, "ibl-", 4) != 0 && strncmp(kind, "tree-", 5) != 0)
    return false;
  return has_end(name, begun ? ".tmp" : ".bin") &&
         strlen(name) < sizeof((cache_entry *)NULL)->name;
}

static int by_use(const void *a, const void *b) {
  const cache_entry *x = a, *y = b;
  if (x->used.tv_sec != y->used.tv_sec)
    return x->used.tv_sec < y->used.tv_sec ? -1 : 1;
  if (x->used.tv_nsec != y->used.tv_nsec)
    return x->used.tv_nsec < y->used.tv_nsec ? -1 : 1;
  return strcmp(x->name, y->name);
}

// The files of an open folder, in an array that grows; how many.
static size_t list_folder(cache_entry **list, DIR *folder) {
  size_t n = 0, room = 0;
  for (struct dirent *d; (d = readdir(folder)) != NULL;) {
    struct stat st;
    if (!is_ours(d->d_name)) continue;
    if (fstatat(dirfd(folder), d->d_name, &st, AT_SYMLINK_NOFOLLOW) != 0)
      continue;
    *list = array_grow(*list, &room, n + 1, sizeof **list);
    cache_entry *e = &(*list)[n++];
    *e = (cache_entry){.bytes = (uint64_t)st.st_size, .used = st.st_mtim};
    strcpy(e->name, d->d_name);
  }
  return n;
}

size_t cache_entries(cache_entry **out, arena *mem) {
  const char *path = cache_folder(mem);
  DIR *folder = path == NULL ? NULL : opendir(path);
  cache_entry *list = NULL;
  size_t n = 0;
  if (folder != NULL) {
    n = list_folder(&list, folder);
    closedir(folder);
  }
  *out = ARENA_NEW(mem, cache_entry, n);
  if (n > 0) memcpy(*out, list, n * sizeof *list);
  array_free(list);
  qsort(*out, n, sizeof **out, by_use);
  return n;
}

size_t cache_prune(uint64_t most) {
  arena mem = {0};
  cache_entry *list;
  size_t n = cache_entries(&list, &mem), gone = 0;
  uint64_t bytes = 0;
  for (size_t i = 0; i < n; i++)
    bytes += list[i].bytes;
  for (size_t i = 0; i < n && (bytes > most || most == 0); i++) {
    const char *path =
        arena_format(&mem, "%s/%s", cache_folder(&mem), list[i].name);
    gone += unlink(path) == 0;
    bytes -= list[i].bytes;
  }
  arena_free(&mem);
  return gone;
}
