// progress.c

#include "progress.h"

#include "text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// A plain line is due after so much more work, or so many more seconds, and
// not before this many: short runs stay silent in a log.
#define LINE_SHARE 0.1
#define LINE_SECONDS 30.0
#define LINE_FIRST 1.0

// Seconds between two drawings of the bar.
#define BAR_SECONDS 0.1

bool progress_terminal(void) {
  const char *term = getenv("TERM");
  return isatty(STDERR_FILENO) && term != NULL && strcmp(term, "dumb") != 0;
}

progress progress_new(bool quiet) {
  progress p = {.quiet = quiet, .bar = progress_terminal(), .width = 80};
  const char *columns = getenv("COLUMNS");
  long long n;
  if (columns != NULL && span_int((span){columns, strlen(columns)}, &n) &&
      n >= 20 && n <= 1000)
    p.width = (int)n;
  return p;
}

// Seconds as people read them: 12 s, 3:05, 2:11:40.
static void write_seconds(char *text, size_t size, double seconds) {
  long s = (long)(seconds + 0.5);
  if (seconds < 9.95)
    snprintf(text, size, "%.1f s", seconds);
  else if (s < 60)
    snprintf(text, size, "%ld s", s);
  else if (s < 3600)
    snprintf(text, size, "%ld:%02ld", s / 60, s % 60);
  else
    snprintf(text, size, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
}

// Share, time gone, time left, speed, error.
static void write_state(char *text, size_t size, const render_progress *p) {
  char gone[32], left[32], noise[32] = "";
  write_seconds(gone, sizeof gone, p->seconds);
  double now = p->done - p->begun;
  bool known = now > 1e-6;
  if (known) write_seconds(left, sizeof left, p->seconds * (1 - p->done) / now);
  if (p->error > 0) snprintf(noise, sizeof noise, ", error %.2g", p->error);
  double rate = p->seconds > 0 ? (double)p->samples / p->seconds : 0;
  snprintf(text, size, "%3.0f %%  %s, %s left, %.2f M samples/s%s",
           100 * p->done, gone, known ? left : "?", rate * 1e-6, noise);
}

// Redraw the bar: as wide as the terminal leaves room for.
static void draw_bar(progress *display, const render_progress *p) {
  char state[160];
  write_state(state, sizeof state, p);
  int room = display->width - (int)strlen(state) - 4;
  if (room > 40) room = 40;
  fputs("\r", stderr);
  if (room >= 5) {
    int full = (int)(p->done * room);
    fputc('[', stderr);
    for (int i = 0; i < room; i++)
      fputc(i < full ? '#' : '.', stderr);
    fputs("] ", stderr);
  }
  fprintf(stderr, "%.*s\033[K", display->width - 1, state);
  fflush(stderr);
  display->drawn = true;
}

void progress_show(void *context, const render_progress *p) {
  progress *display = context;
  if (display->quiet) return;
  double since = p->seconds - display->line_seconds;
  if (display->bar) {
    if (display->drawn && since < BAR_SECONDS) return;
    draw_bar(display, p);
    display->line_seconds = p->seconds;
    return;
  }
  if (p->seconds < LINE_FIRST) return;
  if (p->done < display->line_done + LINE_SHARE && since < LINE_SECONDS) return;
  char state[160];
  write_state(state, sizeof state, p);
  fprintf(stderr, "%s\n", state);
  display->line_seconds = p->seconds;
  display->line_done = p->done;
}

void progress_clear(progress *display) {
  if (display->drawn) fputs("\r\033[K", stderr);
  if (display->drawn) fflush(stderr);
  display->drawn = false;
}
