// statement.h — one line of a scene file, its words taken off one by one.

#ifndef STATEMENT_H
#define STATEMENT_H

#include "text.h"
#include "vec.h"

// What is left of a line, and what messages about it say.
typedef struct statement {
  span rest;
  const char *key;    // its keyword
  const char *place;  // "file:line"
  arena *mem;
  error *err;
} statement;

// Take the next word if it is this one.
bool statement_takes(statement *s, const char *word);

// Take n finite numbers of at least `least` each.
bool statement_numbers(statement *s, int n, float least, float *out);
bool statement_vec3(statement *s, float least, vec3 *out);

// Take one finite number above 0.
bool statement_positive(statement *s, float *out);

// Take a whole number in least..most.
bool statement_int(statement *s, int least, int most, int *out);

// Take a name or path: one in quotes, or all words up to one of the stops
// (NULL-ended), at least one.
bool statement_name(statement *s, const char *const *stops, const char **out);

// True when nothing is left, else fail with what was expected instead.
bool statement_done(statement *s, const char *expected);

// Fail: the next word is not what was expected.
bool statement_refuse(statement *s, const char *expected);

#endif
