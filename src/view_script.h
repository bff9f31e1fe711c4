// view_script.h — what somebody does with the viewer, written down: keys, the
// mouse, time.
//
//   key NAME [down|up]  a key of VIEW_KEYS; without a word it is pressed and
//                       let go
//   mouse DX DY         the mouse moves, in pixels to the right and down
//   wait SECONDS        time goes by
//   spp N               samples a pixel of path-traced frames from here on
//   frame FILE          the picture of this moment goes to this file
//
// One statement a line; a # that starts a word starts a comment.

#ifndef VIEW_SCRIPT_H
#define VIEW_SCRIPT_H

#include "text.h"
#include "view_state.h"

typedef enum view_event_kind {
  VIEW_EVENT_KEY,
  VIEW_EVENT_MOUSE,
  VIEW_EVENT_WAIT,
  VIEW_EVENT_SPP,
  VIEW_EVENT_FRAME
} view_event_kind;

// Something that happens to the viewer.
typedef struct view_event {
  view_event_kind kind;
  view_key key;
  bool down;           // of the key
  float dx, dy;        // of the mouse
  float seconds;       // of wait, >= 0
  int spp;             // >= 1
  const char *path;    // of frame
  unsigned long line;  // of the script
} view_event;

typedef struct view_script {
  view_event *events;
  size_t count;
} view_script;

// Read the text of a script; name is for messages.
bool view_script_read(view_script *out, span text, const char *name, arena *mem,
                      error *err);

// Let a key, mouse or wait event happen; others change nothing.
void view_happen(view_state *s, const view_event *e);

#endif
