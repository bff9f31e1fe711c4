// render_keep.h — whoever keeps what a picture has so far, so that another run
// can go on from there.

#ifndef RENDER_KEEP_H
#define RENDER_KEEP_H

#include "render_sums.h"

typedef struct render_keep {
  void *self;
  // Before the first pass: put the sums in their place that are to be gone on
  // from, with the films that the settings ask for and squares of colour;
  // false when there are none.
  bool (*load)(void *self, render_sums *sums);
  // After each pass, and once more, with `last`, when there is no other.  No
  // other call is under way.
  void (*save)(void *self, const render_sums *sums, bool last);
  double pass_seconds;  // no pass should take longer
} render_keep;

#endif
