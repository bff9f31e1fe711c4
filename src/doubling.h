// doubling.h — the error of an even sequence of samples, from how the mean
// changed when their number was doubled.

#ifndef DOUBLING_H
#define DOUBLING_H

#include "film.h"
#include "render_guide.h"

typedef struct doubling doubling;

// For samples of numbers 0, 1, 2, ... of every pixel, in this order.
doubling *doubling_new(arena *mem, int width, int height);

// Watches only, the film that the samples are added to.
render_guide doubling_guide(doubling *d);

// Sums of pixels as doubling looks back at them: of the first 2^k samples, 2^k
// the last power of two that was passed, and of the 2^(k-1) before.
typedef struct doubling_marks {
  vec3 *whole, *half;
} doubling_marks;

doubling_marks doubling_look(const doubling *d);

// Go on from these, which are copied, and a film that has their samples.
void doubling_go_on(doubling *d, const doubling_marks *marks);

#endif
