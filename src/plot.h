// plot.h — numbers against numbers, on squared paper.

#ifndef PLOT_H
#define PLOT_H

#include "sketch.h"

// What stands at each point of a series.
typedef enum plot_mark {
  PLOT_NO_MARK,
  PLOT_DISC,
  PLOT_RING,
  PLOT_SQUARE,
  PLOT_DIAMOND,
  PLOT_TRIANGLE,
  PLOT_CROSS
} plot_mark;

typedef enum plot_line { PLOT_SOLID, PLOT_DASHED, PLOT_NO_LINE } plot_line;

// n points in the order in which they are joined.  Points that are not finite,
// or not positive on a logarithmic axis, are left out.  low and high, where
// not NULL, are the ends of an error bar along y.
typedef struct plot_series {
  const char *name;  // in the legend; NULL: not listed
  vec3 color;        // linear
  plot_mark mark;
  plot_line line;
  size_t n;
  const double *x, *y;
  const double *low, *high;
} plot_series;

typedef struct plot_axis {
  const char *label;  // may be NULL
  bool log;
  double from, to;  // both 0: as the points ask
} plot_axis;

typedef struct plot {
  int width, height;  // of the paper, in pixels
  const char *title;  // may be NULL
  plot_axis x, y;
  const plot_series *series;
  size_t count;
} plot;

// Paper with axes, series and, where any has a name, a legend on the right.
sketch plot_sketch(const plot *p, arena *mem);

// Eight colours for series that people tell apart whose eyes lack one of the
// three cones.  Source: Okabe and Ito, "Color Universal Design", 2008.
vec3 plot_color(size_t i);

#endif
