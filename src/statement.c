// statement.c — one line of a scene file, its words taken off one by one.

#include "statement.h"

bool statement_refuse(statement *s, const char *expected) {
  span word = text_word(&s->rest);
  if (word.length == 0)
    return fail(s->err, "%s: %s: expected %s at the end", s->place, s->key,
                expected);
  return fail(s->err, "%s: %s: expected %s, found \"%.*s\"", s->place, s->key,
              expected, (int)word.length, word.at);
}

bool statement_done(statement *s, const char *expected) {
  return text_trim(s->rest).length == 0 || statement_refuse(s, expected);
}

bool statement_takes(statement *s, const char *word) {
  span after = s->rest;
  if (!span_is(text_word(&after), word)) return false;
  s->rest = after;
  return true;
}

bool statement_numbers(statement *s, int n, float least, float *out) {
  for (int i = 0; i < n; i++) {
    span after = s->rest;
    if (!span_float(text_word(&after), &out[i]) || !isfinite(out[i]))
      return statement_refuse(s, "a finite number");
    if (out[i] < least)
      return fail(s->err, "%s: %s: %g is below %g", s->place, s->key,
                  (double)out[i], (double)least);
    s->rest = after;
  }
  return true;
}

bool statement_vec3(statement *s, float least, vec3 *out) {
  float v[3];
  if (!statement_numbers(s, 3, least, v)) return false;
  *out = (vec3){v[0], v[1], v[2]};
  return true;
}

bool statement_positive(statement *s, float *out) {
  if (!statement_numbers(s, 1, 0, out)) return false;
  return *out > 0 || fail(s->err, "%s: %s: 0 is not above 0", s->place, s->key);
}

bool statement_int(statement *s, int least, int most, int *out) {
  span after = s->rest;
  long long value;
  if (!span_int(text_word(&after), &value))
    return statement_refuse(s, "a whole number");
  if (value < least || value > most)
    return fail(s->err, "%s: %s: %lld is not in %d..%d", s->place, s->key,
                value, least, most);
  s->rest = after;
  *out = (int)value;
  return true;
}

// Whether word is one of the stops.
static bool is_stop(span word, const char *const *stops) {
  for (; *stops != NULL; stops++)
    if (span_is(word, *stops)) return true;
  return false;
}

bool statement_name(statement *s, const char *const *stops, const char **out) {
  s->rest = text_trim(s->rest);
  span name = {s->rest.at, 0};
  if (s->rest.length > 0 && s->rest.at[0] == '"') {
    name = text_word(&s->rest);
  } else {
    for (span next = s->rest, word; (word = text_word(&next)).length > 0;) {
      if (name.length > 0 && is_stop(word, stops)) break;
      name.length = (size_t)(next.at - name.at);
      s->rest = next;
    }
  }
  if (name.length == 0) return statement_refuse(s, "a name");
  *out = span_copy(s->mem, name);
  return true;
}
