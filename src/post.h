// post.h — what is done to a finished picture: a pane of frosted glass.

#ifndef POST_H
#define POST_H

#include "error.h"
#include "image.h"
#include "pool.h"

// A pane of ground glass in front of the picture.  Every pixel has a grain of
// its own, tilted at random, and shows what is up to `radius` pixels away.
typedef struct post_frost {
  float radius;  // in pixels, 0 is clear glass
  int x0, y0;    // the film's pixel at the picture's upper left, so that a
                 // crop has the grains of the whole picture
} post_frost;

// The largest radius.
enum { POST_MAX_RADIUS = 1000 };

// The picture seen through the pane, linear in and linear out; what lies
// beyond the edge is the pixel at the edge.  The same bytes for any threads.
image post_frosted(const image *im, post_frost pane, arena *mem, pool *threads);

// The pane that "frosted" or "frosted=RADIUS" asks for.  *out keeps x0 and y0.
bool post_parse(post_frost *out, const char *text, error *err);

#endif
