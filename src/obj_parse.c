// obj_parse.c

#include "obj_parse.h"

#include "number.h"
#include "obj_line.h"

// The fast path reads lines in the form that nearly all of them have, straight
// from the buffer, and takes back what it did when a line turns out to be
// different: then obj_line.c reads it again.  Each function gets the byte
// behind the keyword and returns the start of the next line, or NULL.

// Behind the end of a line at p, after blanks; NULL when something else comes.
static const char *end_of_line(const char *p) {
  while (*p == ' ' || *p == '\t')
    p++;
  if (*p == '\n') return p + 1;
  return p[0] == '\r' && p[1] == '\n' ? p + 2 : NULL;
}

// A finite number at p behind blanks.  The bytes behind end are NUL, which
// ends a number.
static const char *fast_number(const char *p, const char *end, float *x) {
  while (*p == ' ' || *p == '\t')
    p++;
  p = number_float(p, end, x);
  return p != NULL && isfinite(*x) ? p : NULL;
}

// Exactly three numbers.
static const char *fast_three(const char *p, const char *end, vec3 *out) {
  if ((p = fast_number(p, end, &out->x)) == NULL) return NULL;
  if ((p = fast_number(p, end, &out->y)) == NULL) return NULL;
  if ((p = fast_number(p, end, &out->z)) == NULL) return NULL;
  return end_of_line(p);
}

static const char *fast_position(obj_chunk *c, const char *p, const char *end) {
  vec3 v;
  if (c->has_color) return NULL;
  p = fast_three(p, end, &v);
  if (p == NULL || vec3_peak(vec3_abs(v)) > OBJ_FAR) return NULL;
  obj_add_position(c, v);
  return p;
}

static const char *fast_normal(obj_chunk *c, const char *p, const char *end) {
  vec3 v;
  p = fast_three(p, end, &v);
  if (p != NULL) obj_add_normal(c, v);
  return p;
}

static const char *fast_texcoord(obj_chunk *c, const char *p, const char *end) {
  vec2 t;
  if ((p = fast_number(p, end, &t.x)) == NULL) return NULL;
  if ((p = fast_number(p, end, &t.y)) == NULL) return NULL;
  p = end_of_line(p);
  if (p != NULL) obj_add_texcoord(c, t);
  return p;
}

// An index that is not 0 and has at most nine digits.
static inline const char *fast_index(const char *p, size_t count,
                                     uint32_t *out) {
  bool minus = *p == '-';
  p += minus;
  const char *digits = p;
  uint32_t value = 0;
  for (unsigned d; (d = (unsigned)*p - '0') < 10; p++)
    value = value * 10 + d;
  if (value == 0 || p - digits > 9) return NULL;
  *out = value - 1;
  if (minus) obj_index(-(long long)value, count, out);
  return p;
}

// V, V/VT, V//VN or V/VT/VN at p.
static const char *fast_corner(obj_chunk *c, const char *p, obj_corner *out) {
  *out = (obj_corner){OBJ_NONE, OBJ_NONE, OBJ_NONE};
  p = fast_index(p, c->position_count, &out->position);
  if (p == NULL || *p != '/') return p;
  p++;
  if (*p != '/') {
    p = fast_index(p, c->texcoord_count, &out->texcoord);
    if (p == NULL) return NULL;
    c->has_texcoord = true;
    if (*p != '/') return p;
  }
  c->has_normal = true;
  return fast_index(p + 1, c->normal_count, &out->normal);
}

static const char *fast_face(obj_chunk *c, const char *p, uint64_t line) {
  size_t first = c->corner_count;
  const char *next;
  obj_corner corner;
  while ((next = end_of_line(p)) == NULL) {
    if (*p != ' ' && *p != '\t') break;
    while (*p == ' ' || *p == '\t')
      p++;
    p = fast_corner(c, p, &corner);
    if (p == NULL) break;
    obj_add_corner(c, corner);
  }
  if (next == NULL || c->corner_count - first < 3) {
    c->corner_count = first;
    return NULL;
  }
  obj_add_face(c, first, line);
  return next;
}

// The statement at p, when it has a usual form; p is not at the end.
static const char *fast_line(obj_chunk *c, const char *p, const char *end,
                             uint64_t line) {
  if (p[0] == 'v') {
    if (p[1] == ' ') return fast_position(c, p + 1, end);
    if (p[1] == 'n' && p[2] == ' ') return fast_normal(c, p + 2, end);
    if (p[1] == 't' && p[2] == ' ') return fast_texcoord(c, p + 2, end);
  } else if (p[0] == 'f' && p[1] == ' ') {
    return fast_face(c, p + 1, line);
  }
  return NULL;
}

void obj_parse(obj_chunk *c, span text) {
  text_lines lines = text_lines_of(text, 1);
  while (lines.at < lines.end && c->problem_line == 0) {
    const char *next = fast_line(c, lines.at, lines.end, lines.next);
    if (next != NULL) {
      lines.at = next;
      lines.next++;
      continue;
    }
    span line;
    if (text_next_line(&lines, &line)) obj_line_parse(c, line, lines.line);
  }
  c->line_count = lines.next - 1;
  text_lines_free(&lines);
}
