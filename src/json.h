// json.h — JSON written as it is said: no tree, no memory.

#ifndef JSON_H
#define JSON_H

#include <stdbool.h>
#include <stdio.h>

// A writer.  Start with {.out = stdout}.  Members of an object need a key,
// elements of a list have NULL for it.
typedef struct json {
  FILE *out;
  bool comma;  // something stands before on this level
} json;

// Open and close an object '{' or a list '['.
void json_open(json *j, const char *key, char bracket);
void json_close(json *j, char bracket);

// One value.  Text may be any bytes: what is not UTF-8 is taken for Latin-1.
// NULL text and numbers that are not finite become null.  json_float writes
// the shortest decimal that reads as the same float: 0.1f is 0.1.
void json_text(json *j, const char *key, const char *text);
void json_number(json *j, const char *key, double value);
void json_float(json *j, const char *key, float value);
void json_count(json *j, const char *key, unsigned long long value);
void json_flag(json *j, const char *key, bool value);

// End the document with a newline; more may follow (JSON lines).
void json_end(json *j);

#endif
