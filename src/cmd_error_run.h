// cmd_error_run.h — the measurements of facet bench error.

#ifndef CMD_ERROR_RUN_H
#define CMD_ERROR_RUN_H

#include "cmd_child.h"

#include "image.h"

// One way to make a picture: words of a command line, the last of which wins.
typedef struct error_method {
  const char *name;
  bool path;      // by the path engine, with a number of samples
  bool adaptive;  // by --error, down to what path estimates for that number
  const char *flags[8];  // NULL-ended
} error_method;

// In the order of the words of --methods.
extern const error_method error_methods[];

// One picture.
typedef struct error_sample {
  uint64_t seed;
  double whole, render;  // seconds: the process from outside, the rendering
  double mse, relmse;
  double estimate;  // of the relative error, by facet itself; NAN: none
} error_sample;

// One method at one number of samples.
typedef struct error_point {
  const error_method *method;
  int spp;               // 0 where there are none to choose
  error_sample *sample;  // one for each run
} error_point;

// The whole measurement.
typedef struct error_run {
  const options *o;
  arena *mem;
  child_folder folder;
  image reference;
  int reference_spp;          // 0: read from a file
  double reference_estimate;  // its own error by its own estimate, or NAN
  error_point *points;
  size_t count, runs;
} error_run;

// Measure everything; an exit code.
int error_run_all(error_run *r);

// Over the runs of a point: the medians of the times, the means of the squared
// errors, the root of the mean squared estimate, the root of relmse and the
// smallest and largest of its runs.
typedef struct error_mean {
  double whole, render, mse, relmse, estimate;
  double error, low, high;
} error_mean;

error_mean error_point_mean(const error_run *r, const error_point *p);

#endif
