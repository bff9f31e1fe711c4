// cmd_render_say.c — what facet render says when it is done.

#include "cmd_render_say.h"

#include "clock.h"

#include <math.h>
#include <string.h>
#include <sys/resource.h>

// The most memory that the process has had, in bytes.
static double peak_bytes(void) {
  struct rusage use;
  if (getrusage(RUSAGE_SELF, &use) != 0) return 0;
  return (double)use.ru_maxrss * 1024;
}

void render_job_say(const render_job *j) {
  const render_result *r = &j->result;
  char warnings[64] = "no warnings", samples[32];
  int n = j->shot.remarks.warnings;
  if (n > 0)
    snprintf(warnings, sizeof warnings, "%d warning%s", n, n == 1 ? "" : "s");
  if (j->engine == ENGINE_PATH)
    snprintf(samples, sizeof samples, "%d spp", r->spp);
  else
    snprintf(samples, sizeof samples, "raster");
  fprintf(stderr, "%s: %dx%d, %s, %.2f s, %zu triangles, %s%s\n",
          strcmp(j->out.path, "-") == 0 ? "standard output" : j->out.path,
          r->color.width, r->color.height, samples,
          clock_seconds() - j->o->started, j->shot.scene.mesh.triangle_count,
          warnings, r->stopped ? "; stopped early" : "");
}

// The seconds of every stage.
static void json_seconds(json *j, const render_job *job) {
  const raster_times *t = &job->raster.times;
  json_open(j, "seconds", '{');
  json_number(j, "total", clock_seconds() - job->o->started);
  json_number(j, "load", job->shot.scene.seconds_load);
  json_number(j, "textures", job->shot.scene.seconds_textures);
  if (job->engine == ENGINE_PATH) {
    json_number(j, "build", job->tree.seconds);
    json_number(j, "keep", job->tree.save_seconds);
  } else {
    json_number(j, "gl", job->raster.gl_seconds);
    json_number(j, "table", job->raster.table_seconds);
    json_number(j, "ibl", job->raster.env_seconds);
    json_number(j, "upload", t->upload);
    json_number(j, "compile", t->compile);
    json_number(j, "shadow", t->shadow);
    json_number(j, "draw", t->draw);
    json_number(j, "read", t->read);
  }
  json_number(j, "render", job->result.seconds);
  json_number(j, "write", job->write_seconds);
  json_close(j, '{');
}

// What was traced for the error alone.
static void json_jury(json *j, const jury *of) {
  json_open(j, "jury", '{');
  json_count(j, "pixels", of->pixels);
  json_count(j, "samples", of->samples);
  json_count(j, "rays", of->rays);
  json_close(j, '{');
}

// What only the path engine has to tell.
static void json_path(json *j, const render_job *job) {
  const render_result *r = &job->result;
  json_number(j, "error", r->error > 0 ? r->error : (double)NAN);
  if (job->jury.by != NULL) json_jury(j, &job->jury);
  json_count(j, "seed", job->settings.seed);
  json_flag(j, "stopped", r->stopped);
  cmd_keep_json(j, &job->keep);
  json_open(j, "bvh", '{');
  cmd_tree_json(j, &job->tree);
  json_close(j, '{');
}

void render_job_json(const render_job *job) {
  const render_result *r = &job->result;
  bool path = job->engine == ENGINE_PATH;
  json j = {.out = stdout};
  json_open(&j, NULL, '{');
  json_text(&j, "output", job->out.path);
  json_text(&j, "engine", path ? "path" : "raster");
  json_seconds(&j, job);
  json_count(&j, "rays", r->rays);
  json_count(&j, "samples", r->samples);
  json_count(&j, "spp", (unsigned long long)r->spp);
  json_count(&j, "triangles", job->shot.scene.mesh.triangle_count);
  json_count(&j, "materials", job->shot.scene.material_count);
  json_count(&j, "width", (unsigned long long)r->color.width);
  json_count(&j, "height", (unsigned long long)r->color.height);
  json_number(&j, "peak_bytes", peak_bytes());
  cmd_json_warnings(&j, &job->shot.remarks);
  json_count(&j, "non_finite", r->non_finite);
  json_count(&j, "threads",
             (unsigned long long)pool_threads(job->shot.threads));
  if (path)
    json_path(&j, job);
  else
    raster_job_json(&j, &job->raster);
  cmd_plan_json(&j, "plan", &job->plan);
  json_close(&j, '{');
  json_end(&j);
}
