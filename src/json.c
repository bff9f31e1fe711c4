// json.c

#include "json.h"

#include "number.h"

#include <math.h>
#include <stddef.h>

// The bytes of the UTF-8 sequence at s, 0 when it is not well formed.  Source:
// RFC 3629, section 4: no overlong forms, no surrogates, at most U+10FFFF.
static size_t utf8_length(const unsigned char *s) {
  if (s[0] < 0x80) return 1;
  size_t n = s[0] >= 0xf0 ? 4 : s[0] >= 0xe0 ? 3 : 2;
  if (s[0] < 0xc2 || s[0] > 0xf4) return 0;
  for (size_t i = 1; i < n; i++)
    if ((s[i] & 0xc0) != 0x80) return 0;
  if (s[0] == 0xe0 && s[1] < 0xa0) return 0;
  if (s[0] == 0xed && s[1] > 0x9f) return 0;
  if (s[0] == 0xf0 && s[1] < 0x90) return 0;
  if (s[0] == 0xf4 && s[1] > 0x8f) return 0;
  return n;
}

// A string with its quotes.  A control character or a byte that is not UTF-8
// is escaped as the Latin-1 character of that code.
static void json_string(json *j, const char *text) {
  fputc('"', j->out);
  for (const unsigned char *s = (const unsigned char *)text; *s != 0;) {
    size_t n = utf8_length(s);
    if (n == 0 || *s < 0x20 || *s == 0x7f) {
      fprintf(j->out, "\\u%04x", *s++);
      continue;
    }
    if (*s == '"' || *s == '\\') fputc('\\', j->out);
    fwrite(s, 1, n, j->out);
    s += n;
  }
  fputc('"', j->out);
}

// What stands before a value: the comma and the key.
static void json_lead(json *j, const char *key) {
  if (j->comma) fputs(", ", j->out);
  j->comma = true;
  if (key == NULL) return;
  json_string(j, key);
  fputs(": ", j->out);
}

void json_open(json *j, const char *key, char bracket) {
  json_lead(j, key);
  fputc(bracket, j->out);
  j->comma = false;
}

void json_close(json *j, char bracket) {
  fputc(bracket == '{' ? '}' : ']', j->out);
  j->comma = true;
}

void json_text(json *j, const char *key, const char *text) {
  json_lead(j, key);
  if (text == NULL) fputs("null", j->out);
  if (text != NULL) json_string(j, text);
}

void json_number(json *j, const char *key, double value) {
  json_lead(j, key);
  if (!isfinite(value)) fputs("null", j->out);
  // 12 digits: more than any measurement has.
  if (isfinite(value)) fprintf(j->out, "%.12g", value);
}

void json_float(json *j, const char *key, float value) {
  char text[32] = "null";
  float back = NAN;
  for (int digits = 6; isfinite(value) && back != value; digits++) {
    int n = snprintf(text, sizeof text, "%.*g", digits, (double)value);
    // Nine digits always do.
    if (number_float(text, text + n, &back) == NULL || digits >= 9) break;
  }
  json_lead(j, key);
  fputs(text, j->out);
}

void json_count(json *j, const char *key, unsigned long long value) {
  json_lead(j, key);
  fprintf(j->out, "%llu", value);
}

void json_flag(json *j, const char *key, bool value) {
  json_lead(j, key);
  fputs(value ? "true" : "false", j->out);
}

void json_end(json *j) {
  fputc('\n', j->out);
  j->comma = false;
}
