// adaptive.h — more samples where they help more, the picture's error known,
// and no bias from looking.

#ifndef ADAPTIVE_H
#define ADAPTIVE_H

#include "arena.h"
#include "render_guide.h"

typedef struct adaptive adaptive;

typedef struct adaptive_settings {
  int width, height;  // of the window
  double error;       // enough; 0: never
  double most;        // samples a pixel, on average
} adaptive_settings;

// The samples of its pixels are to come from a halves_integrator.  A tile's
// numbers of samples are a function of its samples and of the round; rounds
// depend on the whole picture, and only where there is a deadline on time.
adaptive *adaptive_new(const adaptive_settings *s, arena *mem);

render_guide adaptive_guide(adaptive *a);

#endif
