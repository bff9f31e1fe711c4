// obj_source.c

#include "obj_source.h"

#include "file.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

// Read this much beyond a piece at first: nearly always the end of its last
// line is there.
enum { OBJ_SLACK = 4096 };

// A line start depends on the three bytes before it: "\", CR, LF.
enum { OBJ_BEFORE = 3 };

bool obj_source_open(obj_source *out, const char *path, size_t piece,
                     arena *mem, error *err) {
  obj_source s = {.name = path, .file = -1, .piece = piece};
  if (strcmp(path, "-") == 0) {
    s.name = "standard input";
    if (!text_read(&s.text, path, mem, err)) return false;
    s.size = s.text.length;
    *out = s;
    return true;
  }
  s.file = file_descriptor(path, &s.size, err);
  if (s.file < 0) return false;
  *out = s;
  return true;
}

void obj_source_close(obj_source *s) {
  if (s->file >= 0) close(s->file);
  s->file = -1;
}

size_t obj_source_pieces(const obj_source *s) {
  return (size_t)((s->size + s->piece - 1) / s->piece);
}

// Copy n bytes from offset at to the given place.
static bool source_copy(const obj_source *s, char *to, uint64_t at, size_t n,
                        error *err) {
  if (s->file < 0) {
    memcpy(to, s->text.at + at, n);
    return true;
  }
  while (n > 0) {
    ssize_t got = pread(s->file, to, n, (off_t)at);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return fail(err, "%s: %s", s->name, strerror(errno));
    if (got == 0) return fail(err, "%s: became shorter while read", s->name);
    to += got;
    at += (uint64_t)got;
    n -= (size_t)got;
  }
  return true;
}

// Whether a piece may begin at b[x]: behind the end of a line that does not
// end in a backslash.  b[x] exists.
static bool is_line_start(const char *b, size_t x) {
  if (x == 0) return true;
  if (b[x - 1] != '\n' && (b[x - 1] != '\r' || b[x] == '\n')) return false;
  size_t last = x - 1;
  if (b[last] == '\n' && last > 0 && b[last - 1] == '\r') last--;
  return last == 0 || b[last - 1] != '\\';
}

// A stretch of the source in a buffer.
typedef struct obj_window {
  const obj_source *source;
  obj_buffer *buffer;
  uint64_t from;  // offset of its first byte
  size_t length;
} obj_window;

// Make the window at least n bytes long, or as long as the source allows.
static bool window_reach(obj_window *w, size_t n, error *err) {
  uint64_t most = w->source->size - w->from;
  if (n > most) n = (size_t)most;
  if (n <= w->length) return true;
  obj_buffer *b = w->buffer;
  b->bytes = array_grow(b->bytes, &b->room, n + OBJ_PADDING, 1);
  if (!source_copy(w->source, b->bytes + w->length, w->from + w->length,
                   n - w->length, err))
    return false;
  w->length = n;
  return true;
}

// The first line start at x or behind it, or the end of the source.
static bool window_line_start(obj_window *w, size_t *x, error *err) {
  for (;; ++*x) {
    if (*x >= w->length) {
      if (!window_reach(w, *x + *x / 2 + 1, err)) return false;
      if (*x >= w->length) return true;
    }
    if (is_line_start(w->buffer->bytes, *x)) return true;
  }
}

bool obj_source_read(const obj_source *s, size_t i, obj_buffer *buffer,
                     span *out, error *err) {
  uint64_t begin = (uint64_t)i * s->piece;
  uint64_t before = begin < OBJ_BEFORE ? begin : OBJ_BEFORE;
  obj_window w = {.source = s, .buffer = buffer, .from = begin - before};
  size_t first = (size_t)before, limit = first + s->piece;
  if (!window_reach(&w, limit + OBJ_SLACK, err)) return false;
  if (limit > w.length) limit = w.length;
  // Look for the start in this piece only: a line of many pieces is then read
  // once, by the piece in which it begins.
  while (first < limit && !is_line_start(buffer->bytes, first))
    first++;
  size_t last = limit;
  if (first < limit && !window_line_start(&w, &last, err)) return false;
  memset(buffer->bytes + last, 0, OBJ_PADDING);
  *out = (span){buffer->bytes + first, first < limit ? last - first : 0};
  return true;
}
