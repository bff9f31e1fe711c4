// progress.h — how far a long run is, for those who wait.

#ifndef PROGRESS_H
#define PROGRESS_H

#include "render.h"

// Where and what was last shown.
typedef struct progress {
  bool quiet;  // show nothing
  bool bar;    // a bar that is redrawn; else plain lines
  int width;   // columns of the terminal
  bool drawn;  // a bar stands on the line
  double line_seconds, line_done;
} progress;

// A display for stderr as it is: a bar on a terminal that can redraw a line,
// plain lines elsewhere.
progress progress_new(bool quiet);

// Show p on the progress that display points to.  The bar is redrawn at most
// ten times a second.  A plain line comes every 10 % or 30 s, the first not
// before one second has gone.
void progress_show(void *display, const render_progress *p);

// Take the bar away, so that something else can be printed.
void progress_clear(progress *display);

// Whether stderr is a terminal that wants no bare text: TERM is set and not
// "dumb".
bool progress_terminal(void);

#endif
