// report.h — what a reader of files noticed on its way, kept for whoever
// prints: warnings (the picture may not be what the author meant) and notes
// (worth knowing, nothing lost).

#ifndef REPORT_H
#define REPORT_H

#include "arena.h"

typedef enum report_kind { REPORT_NOTE, REPORT_WARNING } report_kind;

// One remark: "file:line: text", without a newline.
typedef struct report_line {
  report_kind kind;
  const char *text;
  struct report_line *next;
} report_line;

// Remarks in the order they came, at most REPORT_MAX of them; the rest are
// counted only.  Start with {.mem = arena}.
typedef struct report {
  arena *mem;
  report_line *first, *last;
  int stored;
  int warnings, notes;  // all that came, stored or not
} report;

enum { REPORT_MAX = 200 };

// Add a printf-style remark.  report may be NULL: nobody listens.
void report_warn(report *r, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void report_note(report *r, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

#endif
