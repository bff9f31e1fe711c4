// obj_source.h — a big text file in pieces that begin and end between lines.

#ifndef OBJ_SOURCE_H
#define OBJ_SOURCE_H

#include "error.h"
#include "text.h"

// Readable bytes behind the end of every piece, all NUL.
enum { OBJ_PADDING = 16 };

// A file, or text in memory (file < 0), cut every `piece` bytes.
typedef struct obj_source {
  const char *name;
  int file;
  span text;
  uint64_t size;
  size_t piece;  // bytes, at least 1
} obj_source;

// Where a worker keeps the piece that it works on.  Start with {0}.
typedef struct obj_buffer {
  char *bytes;
  size_t room;
} obj_buffer;

// Open path; "-" is read whole into mem.
bool obj_source_open(obj_source *out, const char *path, size_t piece,
                     arena *mem, error *err);
void obj_source_close(obj_source *s);
size_t obj_source_pieces(const obj_source *s);

// The lines that begin in bytes [i piece, (i + 1) piece) of the source, whole;
// they stay valid until the buffer is used again.  Whatever the size of the
// pieces, one after the other they are the source.
bool obj_source_read(const obj_source *s, size_t i, obj_buffer *buffer,
                     span *out, error *err);

#endif
