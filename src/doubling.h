// doubling.h — the error of an even sequence of samples, from how the mean
// changed when their number was doubled.

#ifndef DOUBLING_H
#define DOUBLING_H

#include "film.h"
#include "render_guide.h"

typedef struct doubling doubling;

// For samples of numbers 0, 1, 2, ... of every pixel, in this order.
doubling *doubling_new(arena *mem, int width, int height);

// Watches only.
render_guide doubling_guide(doubling *d);

#endif
