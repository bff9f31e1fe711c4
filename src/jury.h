// jury.h — the pixels on which the error hangs, asked for their radiance by
// samples that are for nothing else.

#ifndef JURY_H
#define JURY_H

#include "halves.h"

typedef struct jury {
  const integrator *by;  // that the halves walk by; it may be another way to
                         // the same radiance.  NULL: nobody is asked
  const camera_view *view;
  int width, height;               // of the full film
  int x0, y0;                      // of the window
  uint64_t pixels, samples, rays;  // what all questions took
} jury;

// The relative error of the halves, and how well that is known, as halves_error
// tells them; but where that is no more than `goal`, the jury is asked before:
// by a sixteenth of the halves' samples at most, and for the same halves the
// same.
halves_estimate jury_error(jury *j, const halves *h, double goal,
                           pool *threads);

#endif
