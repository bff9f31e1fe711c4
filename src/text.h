// text.h — text files as bytes, lines and words.

#ifndef TEXT_H
#define TEXT_H

#include "arena.h"
#include "error.h"

#include <stdint.h>

// A run of bytes inside some buffer; no NUL at its end.
typedef struct span {
  const char *at;
  size_t length;
} span;

// Read a whole regular file, or standard input when path is "-".  Refuses
// folders, devices, FIFOs and sockets.  The bytes are followed by one NUL that
// is not counted.
bool text_read(span *out, const char *path, arena *mem, error *err);

// A walk over the logical lines of a span: ends are LF, CR LF or a lone CR;
// a backslash before an end joins the next line; a NUL counts as a blank.
typedef struct text_lines {
  const char *at, *end;
  uint64_t line;  // number of the line last returned, 1 is the first
  uint64_t next;  // number of the line that comes
  char *joined;   // where continued lines are put together
  size_t room;
} text_lines;

// Lines of s, whose first line has the given number.  A byte-order mark at
// the start is skipped.
text_lines text_lines_of(span s, uint64_t first_line);

// The next line without its end; false at the end of the text.  A continued
// line lies in a buffer that the next call reuses.
bool text_next_line(text_lines *t, span *line);
void text_lines_free(text_lines *t);

// Take the next word (blanks are space, tab, NUL, vertical tab, form feed) off
// the front of *line; length 0 when none is left.  A word that begins with "
// runs to the next " and is returned without them.
span text_word(span *line);

// Cut blanks off both ends.
span text_trim(span s);

// Cut an MTL or scene comment: from the first # that starts a word.
span text_uncomment(span s);

bool span_is(span s, const char *word);

// s as a string.  A NUL in it becomes a blank, which it counts as.
char *span_copy(arena *mem, span s);

// Parse all of s as a decimal float, correctly rounded (bit for bit strtof in
// the C locale, but never hexadecimal), or as a whole number.
bool span_float(span s, float *out);
bool span_int(span s, long long *out);

// The member of words (NULL-ended) nearest to s by edit distance, or NULL when
// none is near.
const char *text_nearest(span s, const char *const *words);

#endif
