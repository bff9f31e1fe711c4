// path_log.h — what a walk writes down of its questions to lights that have a
// memory.

#ifndef PATH_LOG_H
#define PATH_LOG_H

#include "light.h"
#include "path_ready.h"

typedef struct path_log {
  light_record *items;
  size_t room, count;  // for array_free
} path_log;

#define PATH_NO_RECORD SIZE_MAX

// Write down who was asked for v, and what that would bring: s, and what it
// meets, all 0 where there is nothing.  The number of that line; PATH_NO_RECORD
// where log is NULL or there is nothing to remember.
size_t path_log_note(path_log *log, const light_set *l, const vertex *v,
                     const light_sample *s, const meeting *m);

// Take that line, the last one, out again: nobody will see what becomes of it.
// PATH_NO_RECORD.
size_t path_log_forget(path_log *log, size_t record);

#endif
