// view_script.c

#include "view_script.h"

#include <math.h>

// The words that start a line, in the order of view_event_kind.
static const char *const STATEMENTS[] = {
    "key", "mouse", "wait", "spp", "frame", NULL,
};

// The longest wait and the most samples: beyond them is a typing error.
#define MAX_WAIT 3600.0f
enum { MAX_SPP = 1 << 20 };

// The place of a word in a NULL-ended list; the list's length when absent.
static int place_of(span word, const char *const *list) {
  int i = 0;
  while (list[i] != NULL && !span_is(word, list[i]))
    i++;
  return i;
}

// Say which word was wrong, and the nearest right one.
static bool wrong_word(span word, const char *what, const char *const *list,
                       error *err) {
  const char *near = text_nearest(word, list);
  return fail(err, "unknown %s '%.*s'%s%s", what, (int)word.length, word.at,
              near ? "; the nearest is " : "", near ? near : "");
}

// key NAME [down|up]
static bool read_key(view_event *e, span *rest, bool *tap, error *err) {
  const char *names[VIEW_KEY_COUNT + 1] = {NULL};
  for (int i = 0; i < VIEW_KEY_COUNT; i++)
    names[i] = VIEW_KEYS[i].name;
  span word = text_word(rest), way = text_word(rest);
  int place = place_of(word, names);
  if (place == VIEW_KEY_COUNT) return wrong_word(word, "key", names, err);
  e->key = (view_key)place;
  *tap = way.length == 0;
  e->down = *tap || span_is(way, "down");
  if (!e->down && !span_is(way, "up"))
    return fail(err, "expected key NAME, key NAME down or key NAME up");
  return true;
}

// mouse DX DY
static bool read_mouse(view_event *e, span *rest, error *err) {
  if (span_float(text_word(rest), &e->dx) &&
      span_float(text_word(rest), &e->dy) && isfinite(e->dx) && isfinite(e->dy))
    return true;
  return fail(err, "expected mouse DX DY, two numbers of pixels");
}

// The numbers of wait and spp, the path of frame.
static bool read_rest(view_event *e, span *rest, arena *mem, error *err) {
  span word = text_word(rest);
  long long n;
  switch (e->kind) {
  case VIEW_EVENT_WAIT:
    if (span_float(word, &e->seconds) && e->seconds >= 0 &&
        e->seconds <= MAX_WAIT)
      return true;
    return fail(err, "expected wait SECONDS, from 0 to %g", (double)MAX_WAIT);
  case VIEW_EVENT_SPP:
    if (span_int(word, &n) && n >= 1 && n <= MAX_SPP) {
      e->spp = (int)n;
      return true;
    }
    return fail(err, "expected spp N, from 1 to %d", MAX_SPP);
  default:
    if (word.length == 0) return fail(err, "expected frame FILE");
    e->path = span_copy(mem, word);
    return true;
  }
}

// One statement.
static bool read_statement(view_event *e, span line, bool *tap, arena *mem,
                           error *err) {
  span word = text_word(&line);
  *tap = false;
  int place = place_of(word, STATEMENTS);
  e->kind = (view_event_kind)place;
  if (STATEMENTS[place] == NULL)
    return wrong_word(word, "statement", STATEMENTS, err);
  bool good = e->kind == VIEW_EVENT_KEY     ? read_key(e, &line, tap, err)
              : e->kind == VIEW_EVENT_MOUSE ? read_mouse(e, &line, err)
                                            : read_rest(e, &line, mem, err);
  if (!good) return false;
  span more = text_word(&line);
  return more.length == 0 || fail(err, "'%.*s' is too much on this line",
                                  (int)more.length, more.at);
}

// Every line, at most two events each; *events has room for them.
static bool read_lines(view_script *out, text_lines *lines, const char *name,
                       arena *mem, error *err) {
  span line;
  while (text_next_line(lines, &line)) {
    line = text_trim(text_uncomment(line));
    if (line.length == 0) continue;
    view_event e = {.line = (unsigned long)lines->line};
    bool tap;
    error why;
    if (!read_statement(&e, line, &tap, mem, &why))
      return fail(err, "%s:%lu: %.560s", name, e.line, why.text);
    out->events[out->count++] = e;
    if (!tap) continue;
    e.down = false;
    out->events[out->count++] = e;
  }
  return true;
}

bool view_script_read(view_script *out, span text, const char *name, arena *mem,
                      error *err) {
  size_t room = 2;
  for (size_t i = 0; i < text.length; i++)
    if (text.at[i] == '\n' || text.at[i] == '\r') room += 2;
  view_script s = {.events = ARENA_NEW(mem, view_event, room)};
  text_lines lines = text_lines_of(text, 1);
  bool good = read_lines(&s, &lines, name, mem, err);
  text_lines_free(&lines);
  if (good) *out = s;
  return good;
}

void view_happen(view_state *s, const view_event *e) {
  switch (e->kind) {
  case VIEW_EVENT_KEY: view_press(s, e->key, e->down); return;
  case VIEW_EVENT_MOUSE: view_turn(s, e->dx, e->dy); return;
  case VIEW_EVENT_WAIT: view_fly(s, (double)e->seconds); return;
  default: return;
  }
}
