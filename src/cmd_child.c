// cmd_child.c

#include "cmd_child.h"

#include "clock.h"

#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

// This very program, whatever it was called by.
static const char SELF[] = "/proc/self/exe";

bool child_folder_make(child_folder *out, arena *mem, error *err) {
  const char *base = getenv("TMPDIR");
  if (base == NULL || *base == 0) base = "/tmp";
  char *path = arena_format(mem, "%s/facet-XXXXXX", base);
  if (mkdtemp(path) == NULL)
    return fail(err, "%s: no folder can be made here: %s", base,
                strerror(errno));
  *out = (child_folder){path, arena_format(mem, "%s/picture.pfm", path),
                        arena_format(mem, "%s/said.json", path)};
  return true;
}

void child_folder_remove(const child_folder *f) {
  unlink(f->picture);
  unlink(f->said);
  rmdir(f->path);
}

// Wait for its end; its exit code.
static int wait_for(pid_t child) {
  int status;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return EXIT_RESOURCES;
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

bool child_run_facet(child_run *out, char *const *arguments,
                     const child_folder *f, arena *mem, error *err) {
  posix_spawn_file_actions_t actions;
  if (posix_spawn_file_actions_init(&actions) != 0 ||
      posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, f->said,
                                       O_WRONLY | O_CREAT | O_TRUNC, 0600) != 0)
    return fail(err, "no second facet can be started");
  double start = clock_seconds();
  pid_t child;
  int failed = posix_spawn(&child, SELF, &actions, NULL, arguments, environ);
  if (failed == 0) out->code = wait_for(child);
  out->seconds = clock_seconds() - start;
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0)
    return fail(err, "%s: cannot be started: %s", SELF, strerror(failed));
  return text_read(&out->json, f->said, mem, err);
}

bool child_number(const child_run *r, const char *key, double *out) {
  // The text is followed by a NUL.
  const char *at = strstr(r->json.at, key);
  if (at == NULL) return false;
  at += strlen(key);
  at += strspn(at, "\": ");
  float number;
  span digits = {at, strspn(at, "+-.0123456789eE")};
  if (!span_float(digits, &number)) return false;
  *out = (double)number;
  return true;
}
