// cmd_child.h — facet started by facet, to be timed as a whole.

#ifndef CMD_CHILD_H
#define CMD_CHILD_H

#include "cmd_shared.h"
#include "text.h"

// A folder of its own for what children write.
typedef struct child_folder {
  char *path;
  char *picture;  // in it: what a child renders
  char *said;     // what it prints
} child_folder;

bool child_folder_make(child_folder *out, arena *mem, error *err);

// Remove the two files and the folder.
void child_folder_remove(const child_folder *f);

// What one run of facet took and said.
typedef struct child_run {
  double seconds;  // from before it was started until it had ended
  int code;        // its exit code, 128 + n after signal n
  span json;       // what it printed, in mem
} child_run;

// Run this program with the given arguments (NULL-ended, the first is
// "facet"); its standard output goes to f->said, its errors to ours.
bool child_run_facet(child_run *out, char *const *arguments,
                     const child_folder *f, arena *mem, error *err);

// The first number behind "key": in what it printed; false where there is
// none.
bool child_number(const child_run *r, const char *key, double *out);

#endif
