// file.c

#include "file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// Why a file that is not regular cannot be read.
static const char *kind_of_file(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

int file_descriptor(const char *path, uint64_t *size, error *err) {
  struct stat st;
  // A pipe without a writer would block an ordinary open for ever.
  int fd = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  if (fd < 0 || fstat(fd, &st) != 0) {
    fail(err, "%s: cannot be read: %s", path, strerror(errno));
  } else if (!S_ISREG(st.st_mode)) {
    fail(err, "%s: is %s, expected a regular file", path,
         kind_of_file(st.st_mode));
  } else {
    *size = (uint64_t)st.st_size;
    return fd;
  }
  if (fd >= 0) close(fd);
  return -1;
}

FILE *file_open(const char *path, error *err) {
  uint64_t size;
  int fd = file_descriptor(path, &size, err);
  FILE *f = fd < 0 ? NULL : fdopen(fd, "rb");
  if (f != NULL || fd < 0) return f;
  fail(err, "%s: cannot be read: %s", path, strerror(errno));
  close(fd);
  return NULL;
}

uint64_t file_left(FILE *f) {
  off_t here = ftello(f);
  if (here < 0 || fseeko(f, 0, SEEK_END) != 0) return 0;
  off_t end = ftello(f);
  if (fseeko(f, here, SEEK_SET) != 0 || end < here) return 0;
  return (uint64_t)(end - here);
}

// Where a chain of symbolic links at the end of path leads, so that the link
// stays a link when its target is replaced.  NULL, with errno, when it is
// longer than the system's own limit.
static char *follow_links(const char *path, arena *mem) {
  enum { MAX_LINKS = 40, MAX_TEXT = 4096 };
  char *at = arena_format(mem, "%s", path);
  for (int i = 0; i < MAX_LINKS; i++) {
    char text[MAX_TEXT];
    ssize_t n = readlink(at, text, sizeof text);
    if (n < 0) return at;  // not a link, or nothing there
    if (n == MAX_TEXT) break;
    const char *slash = text[0] == '/' ? NULL : strrchr(at, '/');
    int folder = slash == NULL ? 0 : (int)(slash - at) + 1;
    at = arena_format(mem, "%.*s%.*s", folder, at, (int)n, text);
  }
  errno = ELOOP;
  return NULL;
}

// The name of a temporary file after its dot: the target's, the process, a
// number.
#define TEMPORARY "%.200s.%ld-%d.tmp"

// Create a new file beside target under a name that nobody uses; -1 and errno
// when that cannot be done.
static int create_beside(file_writer *w, arena *mem) {
  const char *slash = strrchr(w->target, '/');
  int folder = slash == NULL ? 0 : (int)(slash - w->target) + 1;
  const char *base = w->target + folder;
  for (int i = 0; i < 1000; i++) {
    // Long names are cut, so that a name of legal length stays legal.
    w->temporary = arena_format(mem, "%.*s." TEMPORARY, folder, w->target, base,
                                (long)getpid(), i);
    int fd = open(w->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd >= 0 || errno != EEXIST) return fd;
  }
  return -1;
}

// Open the descriptor that w writes to; -1 and errno on failure.
static int open_target(file_writer *w, arena *mem) {
  if (strcmp(w->path, "-") == 0) return dup(STDOUT_FILENO);
  struct stat st;
  bool exists = stat(w->path, &st) == 0;
  if (exists && S_ISDIR(st.st_mode)) {
    errno = EISDIR;
    return -1;
  }
  if (exists && !S_ISREG(st.st_mode))
    return open(w->path, O_WRONLY | O_CLOEXEC | O_NOCTTY);
  // Renaming over a file needs no right to write to it; asking is polite.
  if (exists && access(w->path, W_OK) != 0) return -1;
  w->target = follow_links(w->path, mem);
  if (w->target == NULL) return -1;
  int fd = create_beside(w, mem);
  if (fd < 0) w->temporary = NULL;
  if (fd >= 0 && exists) (void)fchmod(fd, st.st_mode & 07777);
  return fd;
}

bool file_create(file_writer *w, const char *path, arena *mem, error *err) {
  *w = (file_writer){.path = path};
  int fd = open_target(w, mem);
  if (fd >= 0) w->stream = fdopen(fd, "wb");
  if (w->stream != NULL) return true;
  fail(err, "%s: cannot be written: %s", path, strerror(errno));
  if (fd >= 0) close(fd);
  if (w->temporary != NULL) unlink(w->temporary);
  return false;
}

bool file_commit(file_writer *w, error *err) {
  // fsync is not for pipes and terminals; there it fails with EINVAL.
  bool ok =
      !ferror(w->stream) && fflush(w->stream) == 0 &&
      (w->temporary == NULL || w->passing || fsync(fileno(w->stream)) == 0);
  int reason = errno;
  if (fclose(w->stream) != 0 && ok) ok = false, reason = errno;
  w->stream = NULL;
  if (ok && w->temporary != NULL && rename(w->temporary, w->target) != 0)
    ok = false, reason = errno;
  if (!ok && w->temporary != NULL) unlink(w->temporary);
  if (ok) return true;
  return fail(err, "%s: cannot be written: %s", w->path, strerror(reason));
}

void file_discard(file_writer *w) {
  if (w->stream != NULL) fclose(w->stream);
  w->stream = NULL;
  if (w->temporary != NULL) unlink(w->temporary);
}

// Whether a name is that of a temporary file of base, and of no process that
// lives.
static bool is_left_behind(const char *name, const char *base) {
  char prefix[256], *end;
  int n = snprintf(prefix, sizeof prefix, ".%.200s.", base);
  if (strncmp(name, prefix, (size_t)n) != 0) return false;
  long process = strtol(name + n, &end, 10);
  if (process <= 0 || *end != '-' || end[1] < '0' || end[1] > '9') return false;
  strtol(end + 1, &end, 10);
  return strcmp(end, ".tmp") == 0 && kill((pid_t)process, 0) != 0 &&
         errno == ESRCH;
}

void file_sweep(const char *path, arena *mem) {
  char *target = follow_links(path, mem);
  if (target == NULL) return;
  char *slash = strrchr(target, '/');
  const char *base = slash == NULL ? target : slash + 1;
  size_t n = (size_t)(base - target);
  DIR *folder = opendir(n == 0 ? "." : arena_text(mem, target, n));
  if (folder == NULL) return;
  for (struct dirent *d; (d = readdir(folder)) != NULL;)
    if (is_left_behind(d->d_name, base)) unlinkat(dirfd(folder), d->d_name, 0);
  closedir(folder);
}
