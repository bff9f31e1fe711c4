// file.h — files opened with care: only regular ones are read, and a new one
// takes the place of the old at once and whole, or not at all.

#ifndef FILE_H
#define FILE_H

#include "arena.h"
#include "error.h"

#include <stdint.h>
#include <stdio.h>

// Open a file for reading, or NULL.  Folders, devices and pipes are refused,
// without waiting for whoever might write into the pipe.
FILE *file_open(const char *path, error *err);

// The same as a descriptor, with its size in bytes; -1 when it is refused.
int file_descriptor(const char *path, uint64_t *size, error *err);

// Bytes from here to the end of f; 0 when f cannot seek.
uint64_t file_left(FILE *f);

// A file on its way: write to stream, then commit or discard.
typedef struct file_writer {
  FILE *stream;
  const char *path;  // as the caller named it, for messages
  char *target;      // with a symbolic link at its end resolved
  char *temporary;   // beside target; NULL when written directly
  bool passing;      // set it where the file may be lost with the system
} file_writer;

// Begin to write path.  A regular file, or one that does not exist yet, is
// written under a temporary name in the same folder; a device or pipe is
// written directly; "-" is standard output.  An existing file's permissions
// are kept.  The strings live in mem.
bool file_create(file_writer *w, const char *path, arena *mem, error *err);

// Flush to the disk (not where it is passing) and take the target's place. When
// any write failed, the temporary file is removed, the old file stays, and this
// says why.
bool file_commit(file_writer *w, error *err);

// Give up: close, and remove the temporary file.
void file_discard(file_writer *w);

// Remove temporary files of path that a killed process has left behind.
void file_sweep(const char *path, arena *mem);

#endif
