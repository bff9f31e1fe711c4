// obj_line.c

#include "obj_line.h"

#include "number.h"

#include <string.h>

// A vertex statement has at most this many numbers that mean something; the
// rest is read and counted.
enum { NUMBERS_KEPT = 8 };

// Words of the input that messages quote are cut at this many bytes.
enum { QUOTE_BYTES = 40 };

// Free-form curves and surfaces, all of them.
static const char *const FREE_FORM[] = {
    "vp",   "cstype", "deg",  "bmat", "step", "curv", "curv2",
    "surf", "parm",   "trim", "hole", "scrv", "sp",   "end",
    "con",  "cdc",    "cdp",  "bzp",  "bsp",  "res",  NULL,
};

// How to show things, for programs that are long gone.
static const char *const DISPLAY[] = {
    "bevel", "c_interp", "d_interp", "lod", "shadow_obj", "trace_obj", "ctech",
    "stech", "maplib",   "usemap",   "mg",  "call",       "csh",       NULL,
};

static void tally(obj_chunk *c, obj_tally_kind kind, uint64_t line) {
  if (c->tally[kind].count++ == 0) c->tally[kind].line = line;
}

// A word for a message: short and printable.
typedef struct quote {
  char text[QUOTE_BYTES + 1];
} quote;

static quote quote_of(span s) {
  quote q = {{0}};
  for (size_t i = 0; i < s.length && i < QUOTE_BYTES; i++)
    q.text[i] = s.at[i] < ' ' || s.at[i] == 127 ? '?' : s.at[i];
  return q;
}

// Note the first problem of a chunk; false.
static bool malformed(obj_chunk *c, uint64_t line, const char *what, span word,
                      const char *expected) {
  c->problem_line = line;
  if (word.length == 0)
    return fail(&c->problem, "%s, expected %s", what, expected);
  return fail(&c->problem, "%s \"%s\", expected %s", what, quote_of(word).text,
              expected);
}

// Read the numbers of a statement into x, which has room for NUMBERS_KEPT;
// *count is how many there are.
static bool take_numbers(obj_chunk *c, span *line, uint64_t number, float *x,
                         int *count) {
  *count = 0;
  bool finite = true;
  for (span word; (word = text_word(line)).length > 0;) {
    float value;
    if (!span_float(word, &value))
      return malformed(c, number, "malformed number", word,
                       "a decimal number such as -1.5e3");
    if (!isfinite(value)) finite = false;
    if (*count < NUMBERS_KEPT) x[*count] = value;
    if (*count < NUMBERS_KEPT) ++*count;
  }
  if (!finite) tally(c, OBJ_TALLY_NOT_FINITE, number);
  return true;
}

// The colour of the last position.  The first one that comes makes all before
// it white.
static void add_color(obj_chunk *c, vec3 color) {
  size_t n = c->position_count;
  if (n > c->color_room)
    c->colors = array_grow(c->colors, &c->color_room, n, sizeof color);
  for (size_t i = 0; !c->has_color && i + 1 < n; i++)
    c->colors[i] = vec3_all(1);
  c->colors[n - 1] = color;
  c->has_color = true;
}

// v x y z, with w (ignored: a weight of curves), or with red green blue.
static void line_position(obj_chunk *c, span line, uint64_t number) {
  float x[NUMBERS_KEPT];
  int n;
  if (!take_numbers(c, &line, number, x, &n)) return;
  if (n < 3) {
    malformed(c, number, "too few numbers", (span){0}, "v X Y Z");
    return;
  }
  if (n == 5 || n > 6) tally(c, OBJ_TALLY_EXTRA, number);
  vec3 p = {x[0], x[1], x[2]};
  if (vec3_finite(p) && vec3_peak(vec3_abs(p)) > OBJ_FAR)
    tally(c, OBJ_TALLY_FAR, number);
  obj_add_position(c, p);
  if (n >= 6) add_color(c, (vec3){x[3], x[4], x[5]});
  if (n < 6 && c->has_color) add_color(c, vec3_all(1));
}

static void line_normal(obj_chunk *c, span line, uint64_t number) {
  float x[NUMBERS_KEPT];
  int n;
  if (!take_numbers(c, &line, number, x, &n)) return;
  if (n < 3) {
    malformed(c, number, "too few numbers", (span){0}, "vn X Y Z");
    return;
  }
  if (n > 3) tally(c, OBJ_TALLY_EXTRA, number);
  obj_add_normal(c, (vec3){x[0], x[1], x[2]});
}

// vt u, vt u v, vt u v w.
static void line_texcoord(obj_chunk *c, span line, uint64_t number) {
  float x[NUMBERS_KEPT] = {0};
  int n;
  if (!take_numbers(c, &line, number, x, &n)) return;
  if (n < 1) {
    malformed(c, number, "too few numbers", (span){0}, "vt U V");
    return;
  }
  if (n > 3) tally(c, OBJ_TALLY_EXTRA, number);
  obj_add_texcoord(c, (vec2){x[0], x[1]});
}

// One index of a corner, which may be missing where another one may follow.
// *p moves behind it.
static bool take_index(const char **p, const char *end, size_t count,
                       uint32_t *out, const char **why) {
  long long written;
  *why = "malformed corner";
  const char *after = number_int(*p, end, &written);
  if (after == NULL) return *p == end || **p == '/';
  *p = after;
  *why = "index 0 in the corner";
  if (written == 0) return false;
  *why = "index out of range in the corner";
  return obj_index(written, count, out);
}

// V, V/VT, V//VN, V/VT/VN; V/ and V// are seen in the wild.
static bool take_corner(obj_chunk *c, span word, uint64_t number) {
  obj_corner corner = {OBJ_NONE, OBJ_NONE, OBJ_NONE};
  const char *p = word.at, *end = word.at + word.length, *why;
  bool ok = take_index(&p, end, c->position_count, &corner.position, &why);
  if (ok && p < end && *p == '/') {
    p++;
    ok = take_index(&p, end, c->texcoord_count, &corner.texcoord, &why);
  }
  if (ok && p < end && *p == '/') {
    p++;
    ok = take_index(&p, end, c->normal_count, &corner.normal, &why);
  }
  if (ok && (p < end || corner.position == OBJ_NONE)) {
    why = "malformed corner";
    ok = false;
  }
  if (!ok)
    return malformed(c, number, why, word,
                     "V, V/VT, V//VN or V/VT/VN, counted from 1 or from -1");
  if (corner.texcoord != OBJ_NONE) c->has_texcoord = true;
  if (corner.normal != OBJ_NONE) c->has_normal = true;
  obj_add_corner(c, corner);
  return true;
}

// A face; one with fewer than three corners draws nothing and is counted.
static void line_face(obj_chunk *c, span line, uint64_t number) {
  size_t first = c->corner_count;
  for (span word; (word = text_word(&line)).length > 0;)
    if (!take_corner(c, word, number)) return;
  if (c->corner_count - first < 3) {
    c->corner_count = first;
    tally(c, OBJ_TALLY_SHORT_FACE, number);
    return;
  }
  obj_add_face(c, first, number);
}

// Keep an event, and its name with blanks for the NUL bytes in it.
static void add_event(obj_chunk *c, obj_event_kind kind, span name,
                      int64_t value) {
  size_t n = c->event_count++, at = c->name_bytes;
  c->events = array_grow(c->events, &c->event_room, n + 1, sizeof *c->events);
  c->names = array_grow(c->names, &c->name_room, at + name.length + 1, 1);
  for (size_t i = 0; i < name.length; i++)
    c->names[at + i] = name.at[i] == '\0' ? ' ' : name.at[i];
  c->name_bytes += name.length;
  c->events[n] =
      (obj_event){kind, (uint32_t)c->triangle_count, at, name.length, value};
}

// s N, s off, s on.
static void line_smooth(obj_chunk *c, span line, uint64_t number) {
  span word = text_word(&line);
  long long group = 0;
  if (span_is(word, "on")) {
    group = 1;
  } else if (!span_is(word, "off") && (!span_int(word, &group) || group < 0)) {
    group = 0;
    tally(c, OBJ_TALLY_BAD_SMOOTH, number);
  }
  add_event(c, OBJ_EVENT_SMOOTH, (span){"", 0}, group);
}

static bool is_one_of(span word, const char *const *list) {
  for (; *list != NULL; list++)
    if (span_is(word, *list)) return true;
  return false;
}

// Statements that draw nothing.  Of those that nobody knows the first few
// keywords are kept.
static void line_other(obj_chunk *c, span keyword, uint64_t number) {
  if (span_is(keyword, "p")) {
    tally(c, OBJ_TALLY_POINT, number);
  } else if (span_is(keyword, "l")) {
    tally(c, OBJ_TALLY_LINE, number);
  } else if (is_one_of(keyword, FREE_FORM)) {
    tally(c, OBJ_TALLY_FREE_FORM, number);
  } else if (is_one_of(keyword, DISPLAY)) {
    tally(c, OBJ_TALLY_DISPLAY, number);
  } else {
    tally(c, OBJ_TALLY_UNKNOWN, number);
    obj_unknown u = {.line = number};
    memcpy(u.keyword, quote_of(keyword).text, sizeof u.keyword - 1);
    for (size_t i = 0; i < c->unknown_count; i++)
      if (strcmp(c->unknown[i].keyword, u.keyword) == 0) return;
    if (c->unknown_count == OBJ_UNKNOWN_MAX) return;
    size_t n = c->unknown_count++;
    c->unknown = array_grow(c->unknown, &c->unknown_room, n + 1, sizeof u);
    c->unknown[n] = u;
  }
}

void obj_line_parse(obj_chunk *c, span line, uint64_t number) {
  span rest = line;
  span keyword = text_word(&rest);
  if (keyword.length == 0 || keyword.at[0] == '#') return;
  span data = text_uncomment(rest), name = text_trim(rest);
  if (span_is(keyword, "v")) {
    line_position(c, data, number);
  } else if (span_is(keyword, "vn")) {
    line_normal(c, data, number);
  } else if (span_is(keyword, "vt")) {
    line_texcoord(c, data, number);
  } else if (span_is(keyword, "f") || span_is(keyword, "fo")) {
    line_face(c, data, number);
  } else if (span_is(keyword, "usemtl")) {
    add_event(c, OBJ_EVENT_MATERIAL, name, (int64_t)number);
  } else if (span_is(keyword, "g")) {
    add_event(c, OBJ_EVENT_GROUP, name, 0);
  } else if (span_is(keyword, "o")) {
    add_event(c, OBJ_EVENT_OBJECT, name, 0);
  } else if (span_is(keyword, "s")) {
    line_smooth(c, data, number);
  } else if (span_is(keyword, "mtllib")) {
    add_event(c, OBJ_EVENT_LIBRARY, name, (int64_t)number);
  } else {
    line_other(c, keyword, number);
  }
}
