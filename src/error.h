// error.h — what went wrong, in words for the person at the terminal.

#ifndef ERROR_H
#define ERROR_H

#include <stdbool.h>

// One message of one line, without control characters: place, what is wrong,
// what was expected.
typedef struct error {
  char text[640];
} error;

// Write a printf-style message to err and return false, so that a failing
// function can say: return fail(err, "%s: not a PNG file", path);
bool fail(error *err, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

// Put a question mark for every byte of text that a terminal would obey rather
// than show: names in strangers' files may hold them.
void error_plain(char *text);

#endif
