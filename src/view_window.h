// view_window.h — a window on the screen: keys and the mouse come out of it,
// pictures go in.  GLFW is loaded when the window is opened.

#ifndef VIEW_WINDOW_H
#define VIEW_WINDOW_H

#include "gl.h"
#include "view_script.h"

typedef struct view_window view_window;

// Open a window of width x height with an OpenGL 3.3 core context, which is
// current from here on.  Fails (exit status 5) without the library, naming its
// package, or without a display.
bool view_window_open(view_window **out, int width, int height,
                      const char *title, arena *mem, error *err);

// The context, adopted; it goes with the window.
gl *view_window_gl(const view_window *w);

// The most events that one call can bring: each key, and the mouse.
enum { VIEW_WINDOW_EVENTS = VIEW_KEY_COUNT + 1 };

// What has happened since the last call: the number of events in `events`.
// Waits for something to happen, at most so many seconds.  Closing the window
// is the Escape key.
size_t view_window_poll(view_window *w, double seconds,
                        view_event events[VIEW_WINDOW_EVENTS]);

// Show width x height pixels of sRGB bytes, RGB, row 0 on top: as large as fits
// into the window, which may have been made another size.
void view_window_show(view_window *w, const unsigned char *rgb);

void view_window_title(view_window *w, const char *title);

// NULL is fine.
void view_window_close(view_window *w);

#endif
