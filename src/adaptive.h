// adaptive.h — more samples where they help more, the picture's error known,
// and no bias from looking.

#ifndef ADAPTIVE_H
#define ADAPTIVE_H

#include "arena.h"
#include "halves.h"
#include "jury.h"
#include "render_guide.h"

typedef struct adaptive adaptive;

typedef struct adaptive_settings {
  int width, height;  // of the window
  double error;       // enough; 0: never
  double most;        // samples a pixel, on average
  jury *jury;         // asked before the error is enough; NULL: nobody is
} adaptive_settings;

// The samples of its pixels are to come from a halves_integrator.  A tile's
// numbers of samples are a function of the round and of its samples when the
// first tile got more than others; rounds depend on the whole picture, and only
// where there is a deadline on time.
adaptive *adaptive_new(const adaptive_settings *s, arena *mem);

render_guide adaptive_guide(adaptive *a);

// How far a tile is.
typedef struct adaptive_tile {
  // Samples of a black and a white pixel: now, and at the round's end.
  uint32_t taken[2], round[2];
  uint64_t rays;
  double need[2];  // of both; 0 where nobody was asked yet
} adaptive_tile;

// Between two passes: what there is of each tile, row by row, and the sums.
void adaptive_tiles(const adaptive *a, adaptive_tile *out);
const halves *adaptive_sums(const adaptive *a);

// Go on from there, before the first pass.  The sums are copied.
void adaptive_go_on(adaptive *a, const adaptive_tile *tiles, const halves *h);

#endif
