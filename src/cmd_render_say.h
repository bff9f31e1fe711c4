// cmd_render_say.h — one run of facet render, and what it says when it is done.

#ifndef CMD_RENDER_SAY_H
#define CMD_RENDER_SAY_H

#include "cmd_keep.h"
#include "cmd_output.h"
#include "cmd_raster.h"
#include "cmd_shot.h"
#include "cmd_tree.h"

#include "jury.h"
#include "path.h"
#include "progress.h"

// The engines, in the order of the words of --engine.
typedef enum engine { ENGINE_RASTER, ENGINE_PATH, ENGINE_AUTO } engine;

// One run, stage by stage.
typedef struct render_job {
  const options *o;
  shot shot;
  output out;
  plan plan;
  cmd_keep keep;
  engine engine;
  raster_job raster;  // of one engine
  cmd_tree tree;      // of the other, with
  path_world world;   // what it traces
  light_set lights;   // and looks for
  path_film film;
  path_tracer paths;  // by one of these
  path_naive naive;
  integrator by, dark;
  integrator twice;  // by, for both halves
  halves_walk halves;
  jury jury;  // of their error, which walks
  path_tracer alone;
  integrator once;  // by that, or as they do
  render_guide guide;
  render_settings settings;  // and how
  render_result result;
  progress display;
  double learn_seconds, write_seconds;
} render_job;

// The line that ends a run, for people.
void render_job_say(const render_job *j);

// The object of --json.  The raster engine has no rays and no samples.
void render_job_json(const render_job *job);

#endif
