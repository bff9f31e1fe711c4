// cmd_raster.h — a shot by the raster engine, for the commands that draw.

#ifndef CMD_RASTER_H
#define CMD_RASTER_H

#include "cmd_plan.h"
#include "dfg.h"
#include "raster.h"
#include "raster_env.h"
#include "raster_lean.h"
#include "render.h"

typedef struct raster_job {
  gl *g;  // NULL before raster_job_open
  raster *r;
  raster_settings settings;
  const dfg *table;    // of settings.model; NULL where nothing needs it
  raster_rough rough;  // that table, in the context
  raster_lean lean;    // and where lobes look, if they lean
  int samples;         // a pixel, as the driver allows
  raster_times times;
  double gl_seconds;     // to open the context
  double table_seconds;  // to make the table
  raster_env env;        // light from the environment, in the context
  double env_seconds;    // to prepare it
  int sums;              // of its light that were prepared
  bool sums_kept;        // by another run
  double sum_bytes;
  bool any_roughness;  // materials may change after the upload
  const plan *plan;    // NULL: everything is needed
} raster_job;

// Open the context that --gl asks for.  On failure (exit status 5) err names
// the package that is missing, and job is as before.
bool raster_job_open(raster_job *job, const options *o, arena *mem, error *err);

// What the options say to the engine, for the shot's film.
raster_settings raster_job_settings(const shot *s);

// Upload the shot's scene, to be drawn by job->settings, and what its
// materials need besides, which is put into the settings; exit status 5 on
// failure.
bool raster_job_upload(raster_job *job, const shot *s, arena *mem, error *err);

// Tell the plan what was uploaded and drawn, and with --no-skip do the rest.
void raster_job_note(const raster_job *job, plan *p, const shot *s);

// Draw the shot: the picture and those aovs (bits of render.h) that the
// engine has.  Pixels that are not finite are set to 0 and counted.
bool raster_job_draw(render_result *out, raster_job *job, const shot *s,
                     unsigned aovs, error *err);

// The members "gl", with the names of the context, and "msaa".
void raster_job_json(json *j, const raster_job *job);

// Take back what raster_job_upload did.
void raster_job_drop(raster_job *job);

// Release all of it; a job that is not open is fine.
void raster_job_close(raster_job *job);

#endif
