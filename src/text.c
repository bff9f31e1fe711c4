// text.c

#include "text.h"

#include "file.h"
#include "number.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

// Standard input and files that do not know their size grow by this much.
enum { TEXT_PIECE = 1 << 20 };

// Longest word that text_nearest compares.
enum { NEAREST_MAX = 63 };

// Append all that f still gives to *bytes, an array of *room; the length is
// returned.
static size_t slurp(FILE *f, char **bytes, size_t *room) {
  size_t length = 0, got;
  do {
    *bytes = array_grow(*bytes, room, length + TEXT_PIECE, 1);
    got = fread(*bytes + length, 1, *room - length, f);
    length += got;
  } while (got > 0);
  return length;
}

// Standard input, which nobody knows the length of.
static bool read_stdin(span *out, arena *mem, error *err) {
  char *bytes = NULL;
  size_t room = 0;
  size_t length = slurp(stdin, &bytes, &room);
  bool ok = !ferror(stdin);
  if (ok) *out = (span){arena_text(mem, bytes, length), length};
  array_free(bytes);
  return ok || fail(err, "standard input: %s", strerror(errno));
}

bool text_read(span *out, const char *path, arena *mem, error *err) {
  if (strcmp(path, "-") == 0) return read_stdin(out, mem, err);
  FILE *f = file_open(path, err);
  if (f == NULL) return false;
  size_t size = (size_t)file_left(f);
  char *bytes = arena_alloc(mem, size + 1, 1);
  size_t length = fread(bytes, 1, size, f);
  bool ok = !ferror(f);
  fclose(f);
  if (!ok) return fail(err, "%s: cannot be read", path);
  *out = (span){bytes, length};
  return true;
}

static bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\0' || c == '\v' || c == '\f';
}

text_lines text_lines_of(span s, uint64_t first_line) {
  text_lines t = {.at = s.at, .end = s.at + s.length, .next = first_line};
  if (s.length >= 3 && memcmp(s.at, "\xef\xbb\xbf", 3) == 0) t.at += 3;
  return t;
}

// One line as the file has it, without its end; t moves behind the end.
static span physical_line(text_lines *t) {
  const char *p = t->at;
  while (p < t->end && *p != '\n' && *p != '\r')
    p++;
  span line = {t->at, (size_t)(p - t->at)};
  if (p + 1 < t->end && p[0] == '\r' && p[1] == '\n') p++;
  t->at = p < t->end ? p + 1 : p;
  t->next++;
  return line;
}

// Whether the line goes on in the next.  A comment does not: "# C:\dir\" must
// not swallow a vertex.
static bool is_continued(span line) {
  if (line.length == 0 || line.at[line.length - 1] != '\\') return false;
  size_t i = 0;
  while (is_blank(line.at[i]))
    i++;
  return line.at[i] != '#';
}

bool text_next_line(text_lines *t, span *line) {
  if (t->at == t->end) return false;
  t->line = t->next;
  span s = physical_line(t);
  size_t length = 0;
  while (is_continued(s)) {
    // The backslash becomes a blank.
    t->joined = array_grow(t->joined, &t->room, length + s.length, 1);
    memcpy(t->joined + length, s.at, s.length);
    length += s.length;
    t->joined[length - 1] = ' ';
    s = t->at < t->end ? physical_line(t) : (span){t->end, 0};
  }
  if (length > 0) {
    t->joined = array_grow(t->joined, &t->room, length + s.length, 1);
    memcpy(t->joined + length, s.at, s.length);
    s = (span){t->joined, length + s.length};
  }
  *line = s;
  return true;
}

void text_lines_free(text_lines *t) {
  array_free(t->joined);
  t->joined = NULL;
  t->room = 0;
}

// s without its first n bytes.
static span span_skip(span s, size_t n) {
  return (span){s.at + n, s.length - n};
}

span text_word(span *line) {
  size_t i = 0, n = line->length;
  while (i < n && is_blank(line->at[i]))
    i++;
  span rest = span_skip(*line, i);
  if (rest.length > 0 && rest.at[0] == '"') {
    const char *close = memchr(rest.at + 1, '"', rest.length - 1);
    if (close != NULL) {
      span word = {rest.at + 1, (size_t)(close - rest.at) - 1};
      *line = span_skip(rest, word.length + 2);
      return word;
    }
  }
  for (i = 0; i < rest.length && !is_blank(rest.at[i]);)
    i++;
  *line = span_skip(rest, i);
  return (span){rest.at, i};
}

span text_trim(span s) {
  while (s.length > 0 && is_blank(s.at[0]))
    s = span_skip(s, 1);
  while (s.length > 0 && is_blank(s.at[s.length - 1]))
    s.length--;
  return s;
}

span text_uncomment(span s) {
  bool quoted = false, before = true;
  for (size_t i = 0; i < s.length; i++) {
    char c = s.at[i];
    if (quoted) {
      quoted = c != '"';
    } else if (before && c == '#') {
      return (span){s.at, i};
    } else if (before && c == '"') {
      quoted = memchr(s.at + i + 1, '"', s.length - i - 1) != NULL;
    }
    before = is_blank(c);
  }
  return s;
}

bool span_is(span s, const char *word) {
  size_t n = strlen(word);
  return n == s.length && (n == 0 || memcmp(s.at, word, n) == 0);
}

char *span_copy(arena *mem, span s) {
  char *copy = arena_text(mem, s.at, s.length);
  for (size_t i = 0; i < s.length; i++)
    if (copy[i] == '\0') copy[i] = ' ';
  return copy;
}

bool span_float(span s, float *out) {
  float value;
  const char *end = s.at + s.length;
  if (number_float(s.at, end, &value) != end || s.length == 0) return false;
  *out = value;
  return true;
}

bool span_int(span s, long long *out) {
  long long value;
  const char *end = s.at + s.length;
  if (number_int(s.at, end, &value) != end || s.length == 0) return false;
  *out = value;
  return true;
}

// Insertions, deletions and replacements that turn a into b, without regard to
// case.  Both at most NEAREST_MAX long.  Source: Wagner and Fischer 1974.
static int edit_distance(span a, span b) {
  int row[NEAREST_MAX + 1];
  for (size_t j = 0; j <= b.length; j++)
    row[j] = (int)j;
  for (size_t i = 0; i < a.length; i++) {
    int corner = row[0];
    row[0] = (int)i + 1;
    for (size_t j = 0; j < b.length; j++) {
      bool same = (a.at[i] | 0x20) == (b.at[j] | 0x20);
      int best = corner + !same;
      corner = row[j + 1];
      if (corner + 1 < best) best = corner + 1;
      if (row[j] + 1 < best) best = row[j] + 1;
      row[j + 1] = best;
    }
  }
  return row[b.length];
}

const char *text_nearest(span s, const char *const *words) {
  if (s.length == 0 || s.length > NEAREST_MAX) return NULL;
  const char *nearest = NULL;
  int least = (int)s.length / 3 + 2;  // one less is near enough
  for (; *words != NULL; words++) {
    span word = {*words, strlen(*words)};
    if (word.length > NEAREST_MAX) continue;
    int distance = edit_distance(s, word);
    // Nothing in common is not near, however short the words.
    if (distance < least && distance < (int)word.length) {
      least = distance;
      nearest = *words;
    }
  }
  return nearest;
}
