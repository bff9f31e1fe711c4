// cmd_shared.c

#include "cmd_shared.h"

#include "pool.h"
#include "progress.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

// Whether stderr shows colours: a terminal, and nobody objects.  Source:
// no-color.org: any value of NO_COLOR but the empty one.
static bool wants_color(const options *o) {
  const char *no = getenv("NO_COLOR");
  return progress_terminal() && !o->value[OPT_NO_COLOR].given &&
         (no == NULL || *no == 0);
}

// A word in bold and the given ANSI colour, if colours are wanted.
static void print_label(const options *o, int color, const char *word) {
  if (wants_color(o))
    fprintf(stderr, "\033[1;%dm%s\033[0m", color, word);
  else
    fputs(word, stderr);
}

int cmd_fail(const options *o, int code, const char *format, ...) {
  fputs("facet: ", stderr);
  print_label(o, 31, "error:");
  fputc(' ', stderr);
  va_list args;
  va_start(args, format);
  vfprintf(stderr, format, args);
  va_end(args);
  fputc('\n', stderr);
  return code;
}

void cmd_remarks(const options *o, const report *r) {
  int stored = 0;
  for (const report_line *l = r->first; l != NULL; l = l->next) {
    bool warning = l->kind == REPORT_WARNING;
    stored += warning;
    if (warning ? o->value[OPT_QUIET].given : !o->value[OPT_VERBOSE].given)
      continue;
    print_label(o, warning ? 33 : 36, warning ? "warning:" : "note:");
    fprintf(stderr, " %s\n", l->text);
  }
  if (r->warnings > stored && !o->value[OPT_QUIET].given)
    fprintf(stderr, "... and %d warnings more\n", r->warnings - stored);
}

void cmd_json_warnings(json *j, const report *r) {
  json_open(j, "warnings", '[');
  for (const report_line *l = r->first; l != NULL; l = l->next)
    if (l->kind == REPORT_WARNING) json_text(j, NULL, l->text);
  json_close(j, '[');
}

int cmd_threads(const options *o) {
  const option_value *v = &o->value[OPT_THREADS];
  return v->given ? (int)v->whole[0] : pool_default_threads();
}

// Where the suffix of a path starts: its last dot, or its end.
static const char *suffix_of(const char *path) {
  const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
  bool hidden = dot != NULL && (dot == path || dot - 1 == slash);
  if (dot == NULL || (slash != NULL && dot < slash) || hidden)
    return path + strlen(path);
  return dot;
}

char *cmd_stem(arena *mem, const char *path) {
  const char *slash = strrchr(path, '/');
  const char *name = slash == NULL ? path : slash + 1;
  return arena_text(mem, name, (size_t)(suffix_of(path) - name));
}

bool cmd_has_suffix(const char *path, const char *suffix) {
  return strcasecmp(suffix_of(path), suffix) == 0;
}

char *cmd_beside(arena *mem, const char *path, const char *suffix) {
  return arena_format(mem, "%.*s%s", (int)(suffix_of(path) - path), path,
                      suffix);
}

// Ascending order, for qsort.
static int by_number(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

double cmd_median(double *values, size_t n) {
  qsort(values, n, sizeof *values, by_number);
  return (values[(n - 1) / 2] + values[n / 2]) / 2;
}
