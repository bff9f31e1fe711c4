// obj.h — Wavefront OBJ files, read by all threads at once.

#ifndef OBJ_H
#define OBJ_H

#include "error.h"
#include "mesh.h"
#include "pool.h"
#include "report.h"
#include "text.h"

// Seconds by stage, and the size of the text.
typedef struct obj_times {
  double read_parse, merge, triangulate;
  size_t bytes;
} obj_times;

// Read the OBJ at path ("-": standard input) into out, which lives in mem.
// Malformed statements are errors with file:line and what was expected; what a
// renderer does not draw (points, lines, curves) and what it does not know is
// skipped and counted in r.  times may be NULL.  The same mesh, bit for bit,
// for any number of threads.
bool obj_read(mesh *out, const char *path, arena *mem, pool *threads, report *r,
              obj_times *times, error *err);

// What obj_read asks for, and two things that tests do.
typedef struct obj_request {
  const char *path;
  span text;           // read this when text.at is not NULL; path names it
  size_t piece_bytes;  // a thread's helping of text, 0 for the default
  pool *threads;
  obj_times *times;
} obj_request;

bool obj_read_request(mesh *out, const obj_request *request, arena *mem,
                      report *r, error *err);

#endif
