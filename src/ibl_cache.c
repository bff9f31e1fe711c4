// ibl_cache.c

#include "ibl_cache.h"

#include "file.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// Another number when the sums or the format change: old files are then
// ignored.
enum { CACHE_VERSION = 1 };

// The start of a file; `sum` is the key of the texels that follow.
typedef struct cache_head {
  char magic[8];
  ibl_cache_key key, sum;
  uint64_t bytes;
} cache_head;

static const char CACHE_MAGIC[8] = {'F', 'C', 'T', 'I', 'B', 'L', '0', '1'};

// Two sums over 64-bit words with different multipliers; a last word is
// filled up with zeros, and the length counts.  Source: the mixing step is
// that of Steele, Lea and Flood 2014.
static void hash_bytes(ibl_cache_key *h, const void *data, size_t n) {
  const unsigned char *p = data;
  for (size_t i = 0; i < n; i += 8) {
    uint64_t word = 0;
    memcpy(&word, p + i, n - i < 8 ? n - i : 8);
    h->a = (h->a ^ word) * UINT64_C(0x9e3779b97f4a7c15);
    h->a ^= h->a >> 29;
    h->b = (h->b + word) * UINT64_C(0xbf58476d1ce4e5b9);
    h->b ^= h->b >> 32;
  }
  h->a = (h->a ^ n) * UINT64_C(0x94d049bb133111eb);
  h->a ^= h->a >> 31;
}

// Bytes of a level's texels.
static size_t level_bytes(const ibl_level *l) {
  return ibl_level_texels(l) * sizeof *l->texels;
}

ibl_cache_key ibl_cache_key_of(const ibl_cache_set *s) {
  const image *map = s->map;
  ibl_cache_key h = {1, 2};
  int head[4] = {CACHE_VERSION, (int)s->model, map->width, map->height};
  hash_bytes(&h, head, sizeof head);
  for (int i = 0; i < s->count; i++) {
    float facts[2] = {s->levels[i].roughness, (float)s->levels[i].width};
    hash_bytes(&h, facts, sizeof facts);
  }
  size_t texels = (size_t)map->width * (size_t)map->height;
  hash_bytes(&h, map->pixels, texels * sizeof *map->pixels);
  return h;
}

// The key of all texels.
static ibl_cache_key sum_of_levels(const ibl_cache_set *s, uint64_t *bytes) {
  ibl_cache_key h = {3, 4};
  *bytes = 0;
  for (int i = 0; i < s->count; i++) {
    hash_bytes(&h, s->levels[i].texels, level_bytes(&s->levels[i]));
    *bytes += level_bytes(&s->levels[i]);
  }
  return h;
}

static bool same_key(ibl_cache_key x, ibl_cache_key y) {
  return x.a == y.a && x.b == y.b;
}

// The folder, made when it is not there; NULL when nobody says where.  Source:
// XDG Base Directory Specification: a relative path is to be ignored.
static char *cache_folder(arena *mem) {
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

char *ibl_cache_path(ibl_cache_key key, arena *mem) {
  const char *folder = cache_folder(mem);
  if (folder == NULL) return NULL;
  return arena_format(mem, "%s/ibl-%016llx%016llx.bin", folder,
                      (unsigned long long)key.a, (unsigned long long)key.b);
}

// The texels of an open file, if it is whole and of that key.
static bool read_levels(const ibl_cache_set *s, ibl_cache_key key, FILE *f) {
  cache_head head;
  uint64_t bytes;
  if (fread(&head, sizeof head, 1, f) != 1) return false;
  if (memcmp(head.magic, CACHE_MAGIC, sizeof head.magic) != 0) return false;
  if (!same_key(head.key, key) || file_left(f) != head.bytes) return false;
  for (int i = 0; i < s->count; i++) {
    size_t n = level_bytes(&s->levels[i]);
    if (fread(s->levels[i].texels, 1, n, f) != n) return false;
  }
  ibl_cache_key sum = sum_of_levels(s, &bytes);
  return bytes == head.bytes && same_key(sum, head.sum);
}

bool ibl_cache_load(const ibl_cache_set *s, ibl_cache_key key) {
  arena mem = {0};
  error err;
  const char *path = ibl_cache_path(key, &mem);
  FILE *f = path == NULL ? NULL : file_open(path, &err);
  bool ok = f != NULL && read_levels(s, key, f);
  if (ok) (void)utimensat(AT_FDCWD, path, NULL, 0);  // used just now
  if (f != NULL) fclose(f);
  arena_free(&mem);
  return ok;
}

// Of the files of the folder: what they take together, and which was not used
// for longest.
typedef struct cache_survey {
  uint64_t bytes;
  char oldest[64];
  struct timespec used;
} cache_survey;

static bool used_before(struct timespec a, struct timespec b) {
  return a.tv_sec != b.tv_sec ? a.tv_sec < b.tv_sec : a.tv_nsec < b.tv_nsec;
}

static cache_survey survey(DIR *folder) {
  cache_survey s = {.bytes = 0};
  rewinddir(folder);
  for (struct dirent *d; (d = readdir(folder)) != NULL;) {
    struct stat st;
    if (strncmp(d->d_name, "ibl-", 4) != 0) continue;
    if (strlen(d->d_name) >= sizeof s.oldest) continue;
    if (fstatat(dirfd(folder), d->d_name, &st, AT_SYMLINK_NOFOLLOW) != 0)
      continue;
    s.bytes += (uint64_t)st.st_size;
    if (s.oldest[0] != '\0' && !used_before(st.st_mtim, s.used)) continue;
    strcpy(s.oldest, d->d_name);
    s.used = st.st_mtim;
  }
  return s;
}

// Another process may remove the same files: then fewer are left than had to
// be, which does no harm.
static void prune(uint64_t most, arena *mem) {
  const char *path = cache_folder(mem);
  DIR *folder = path == NULL ? NULL : opendir(path);
  if (folder == NULL) return;
  cache_survey s = survey(folder);
  while (s.bytes > most && s.oldest[0] != '\0') {
    if (unlinkat(dirfd(folder), s.oldest, 0) != 0) break;
    s = survey(folder);
  }
  closedir(folder);
}

void ibl_cache_save(const ibl_cache_set *s, ibl_cache_key key, uint64_t most) {
  arena mem = {0};
  error err;
  file_writer w;
  const char *path = ibl_cache_path(key, &mem);
  if (path != NULL && file_create(&w, path, &mem, &err)) {
    cache_head head = {.key = key};
    memcpy(head.magic, CACHE_MAGIC, sizeof head.magic);
    head.sum = sum_of_levels(s, &head.bytes);
    fwrite(&head, sizeof head, 1, w.stream);
    for (int i = 0; i < s->count; i++)
      fwrite(s->levels[i].texels, 1, level_bytes(&s->levels[i]), w.stream);
    if (file_commit(&w, &err)) prune(most, &mem);
  }
  arena_free(&mem);
}
