// report.c

#include "report.h"

#include "error.h"

#include <stdarg.h>
#include <stdio.h>

// Keep one formatted remark, or just count it.
static void report_add(report *r, report_kind kind, const char *format,
                       va_list args) {
  if (kind == REPORT_WARNING) r->warnings++;
  if (kind == REPORT_NOTE) r->notes++;
  if (r->stored >= REPORT_MAX) return;
  char text[1024];
  vsnprintf(text, sizeof text, format, args);
  error_plain(text);
  report_line *line = ARENA_NEW(r->mem, report_line, 1);
  *line = (report_line){kind, arena_format(r->mem, "%s", text), NULL};
  if (r->last != NULL) r->last->next = line;
  if (r->last == NULL) r->first = line;
  r->last = line;
  r->stored++;
}

void report_warn(report *r, const char *format, ...) {
  if (r == NULL) return;
  va_list args;
  va_start(args, format);
  report_add(r, REPORT_WARNING, format, args);
  va_end(args);
}

void report_note(report *r, const char *format, ...) {
  if (r == NULL) return;
  va_list args;
  va_start(args, format);
  report_add(r, REPORT_NOTE, format, args);
  va_end(args);
}
