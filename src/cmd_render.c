// cmd_render.c — facet render: from a scene and a command line to a picture.

#include "cmd_output.h"
#include "cmd_raster.h"
#include "cmd_shot.h"
#include "cmd_signals.h"
#include "cmd_tree.h"

#include "adaptive.h"
#include "clock.h"
#include "doubling.h"
#include "halves.h"
#include "path.h"
#include "progress.h"
#include "vertex_many.h"

#include <math.h>
#include <string.h>
#include <sys/resource.h>

// The engines, in the order of the words of --engine.
typedef enum engine { ENGINE_RASTER, ENGINE_PATH, ENGINE_AUTO } engine;

// One run, stage by stage.
typedef struct render_job {
  const options *o;
  shot shot;
  output out;
  engine engine;
  raster_job raster;  // of one engine
  cmd_tree tree;      // of the other, with
  path_world world;   // what it traces
  light_set lights;   // and looks for
  path_tracer paths;  // by one of these
  path_naive naive;
  integrator by;
  integrator twice;  // by, for both halves
  halves_walk halves;
  render_guide guide;
  render_settings settings;  // and how
  render_result result;
  progress display;
  double write_seconds;
} render_job;

// Seconds that writing a picture takes, for each pixel: what --time keeps in
// reserve.  Noise compresses worst: the garden at one sample a pixel took 0.36
// microseconds a pixel as an 8-bit PNG.
#define WRITE_SECONDS 4e-7

// Samples a pixel where only time or error ends the run.
enum { SPP_WITHOUT_LIMIT = 1 << 24 };

// Whether an option was given on the command line.
static bool given(const render_job *j, option_id id) {
  return j->o->value[id].given;
}

// The AOVs that only many paths a pixel can tell.
enum { PATH_AOVS = RENDER_AOV_VARIANCE | RENDER_AOV_SAMPLES };

// What can be known of the engine before anything is read; an exit code.
static int plan_engine(render_job *j) {
  const option_value *v = j->o->value;
  j->engine = (engine)v[OPT_ENGINE].words;
  if ((v[OPT_AOV].words & PATH_AOVS) == 0) return EXIT_DONE;
  if (j->engine == ENGINE_AUTO) j->engine = ENGINE_PATH;
  if (j->engine == ENGINE_PATH) return EXIT_DONE;
  return cmd_fail(j->o, EXIT_USAGE,
                  "--aov variance and samples need --engine path");
}

// Warn of flags that only the other engine knows.
static void warn_of_engine(render_job *j) {
  static const option_id path_only[] = {OPT_SPP,       OPT_TIME, OPT_ERROR,
                                        OPT_MAX_DEPTH, OPT_SEED, OPT_INTEGRATOR,
                                        OPT_SAMPLER,   OPT_BVH,  OPTION_COUNT};
  static const option_id raster_only[] = {OPT_SHADOWS, OPT_IBL, OPT_MSAA,
                                          OPT_SHADE,   OPT_GL,  OPTION_COUNT};
  bool path = j->engine == ENGINE_PATH;
  const option_id *id = path ? raster_only : path_only;
  for (; *id != OPTION_COUNT; id++)
    if (given(j, *id))
      report_warn(&j->shot.remarks,
                  "--%s has no effect with --engine %s, only with --engine %s",
                  option_table[*id].name, path ? "path" : "raster",
                  path ? "raster" : "path");
}

// Settle the engine: raster opens its context, and auto falls back on path
// where there is none.  An exit code.
static int choose_engine(render_job *j) {
  error err;
  if (j->engine != ENGINE_PATH) {
    if (raster_job_open(&j->raster, j->o, j->shot.mem, &err)) {
      j->engine = ENGINE_RASTER;
    } else if (j->engine == ENGINE_RASTER) {
      return cmd_fail(j->o, EXIT_RESOURCES, "%s; --engine path needs no OpenGL",
                      err.text);
    } else {
      j->engine = ENGINE_PATH;
      report_note(&j->shot.remarks, "--engine auto takes path: %s", err.text);
    }
  }
  warn_of_engine(j);
  return EXIT_DONE;
}

// Write the picture; an exit code.
static int write_picture(render_job *j) {
  error err;
  arena once = {0};
  double start = clock_seconds();
  bool ok = output_write(&j->out, &j->result, &once, &err);
  j->write_seconds = clock_seconds() - start;
  arena_free(&once);
  return ok ? EXIT_DONE : cmd_fail(j->o, EXIT_OUTPUT, "%s", err.text);
}

// The picture so far, on SIGUSR1.  That it cannot be written is said, and does
// not end the run.
static void write_snapshot(void *context, const render_result *so_far) {
  render_job *j = context;
  arena once = {0};
  error err;
  progress_clear(&j->display);
  if (strcmp(j->out.path, "-") == 0)
    cmd_fail(j->o, EXIT_OUTPUT, "no picture so far on standard output");
  else if (!output_write(&j->out, so_far, &once, &err))
    cmd_fail(j->o, EXIT_OUTPUT, "%s", err.text);
  else if (!given(j, OPT_QUIET))
    fprintf(stderr, "%s: %d spp so far\n", j->out.path, so_far->spp);
  arena_free(&once);
}

// What the rest of the flags say to the path engine.
static void choose_settings(render_job *j) {
  const option_value *v = j->o->value;
  const shot *sh = &j->shot;
  static const render_shading shadings[] = {RENDER_RADIANCE, RENDER_RADIANCE,
                                            RENDER_RADIANCE, RENDER_NORMAL,
                                            RENDER_DEPTH,    RENDER_ALBEDO};
  j->settings = (render_settings){
      .width = sh->width,
      .height = sh->height,
      .x0 = sh->x0,
      .y0 = sh->y0,
      .x1 = sh->x1,
      .y1 = sh->y1,
      .spp = (int)v[OPT_SPP].whole[0],
      .seed = (uint64_t)v[OPT_SEED].whole[0],
      .shading = shadings[v[OPT_SHADING].words],
      .aovs = v[OPT_AOV].words,
      .error = v[OPT_ERROR].given ? (double)v[OPT_ERROR].number[0] : 0,
      .stop = &signal_stop,
      .progress = progress_show,
      .progress_context = &j->display,
      .snapshot = &signal_snapshot,
      .on_snapshot = write_snapshot,
      .snapshot_context = j,
  };
  if (!v[OPT_SPP].given && (v[OPT_TIME].given || v[OPT_ERROR].given))
    j->settings.spp = SPP_WITHOUT_LIMIT;
  if (v[OPT_TIME].given)
    j->settings.deadline = j->o->started + (double)v[OPT_TIME].number[0] -
                           WRITE_SECONDS * sh->width * sh->height;
  j->world = (path_world){.scene = &sh->scene,
                          .lights = v[OPT_LIGHTS].words == 0,
                          .max_depth = (int)v[OPT_MAX_DEPTH].whole[0]};
  j->world.dfg = matter_table_as_is(
      &sh->scene, (pbr_model)v[OPT_PBR_MODEL].words, sh->mem, sh->threads);
}

// The most memory that the process has had, in bytes.
static double peak_bytes(void) {
  struct rusage use;
  if (getrusage(RUSAGE_SELF, &use) != 0) return 0;
  return (double)use.ru_maxrss * 1024;
}

// The line that ends a run, for people.
static void print_summary(const render_job *j) {
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

// What only the path engine has to tell.
static void json_path(json *j, const render_job *job) {
  const render_result *r = &job->result;
  json_number(j, "error", r->error > 0 ? r->error : (double)NAN);
  json_count(j, "seed", job->settings.seed);
  json_flag(j, "stopped", r->stopped);
  json_open(j, "bvh", '{');
  cmd_tree_json(j, &job->tree);
  json_close(j, '{');
}

// The object of --json.  The raster engine has no rays and no samples.
static void print_json_render(const render_job *job) {
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
  json_close(&j, '{');
  json_end(&j);
}

// Who walks: path_naive by --integrator naive, with random numbers.
static void choose_integrator(render_job *j) {
  const option_value *v = j->o->value;
  uint64_t seed = j->settings.seed;
  if (v[OPT_INTEGRATOR].words == 1) {
    j->naive = (path_naive){&j->world, seed};
    j->by = path_naive_integrator(&j->naive);
  } else {
    light_set_build(&j->lights, &j->shot.scene, j->world.lights, true,
                    j->shot.mem, j->shot.threads);
    j->paths = (path_tracer){.world = &j->world,
                             .lights = &j->lights,
                             .vertices = vertex_many_best(),
                             .sampler = (sampler_kind)v[OPT_SAMPLER].words,
                             .seed = seed};
    j->by = path_integrator(&j->paths);
  }
  j->settings.by = &j->by;
}

// Who watches the error.  Where it decides when to stop, samples go where they
// help and all pixels have two halves; else it is only looked at, if somebody
// will hear of it.
static void choose_guide(render_job *j) {
  render_settings *s = &j->settings;
  const shot *sh = &j->shot;
  bool crop = s->x1 > 0;
  int w = crop ? s->x1 - s->x0 : s->width, h = crop ? s->y1 - s->y0 : s->height;
  if (s->error > 0 || s->deadline > 0) {
    adaptive_settings a = {w, h, s->error, s->spp};
    j->guide = adaptive_guide(adaptive_new(&a, sh->mem));
    j->halves = (halves_walk){&j->by, (uint64_t)s->width * (uint64_t)s->height};
    j->twice = halves_integrator(&j->halves);
    s->by = &j->twice;
  } else if (given(j, OPT_JSON) || !given(j, OPT_QUIET)) {
    j->guide = doubling_guide(doubling_new(sh->mem, w, h));
  } else {
    return;
  }
  s->guide = &j->guide;
}

// Build the tree and trace paths.
static void run_path(render_job *j) {
  shot *s = &j->shot;
  const mesh *m = &s->scene.mesh;
  choose_settings(j);
  bool open = j->settings.spp == SPP_WITHOUT_LIMIT;
  j->tree.rays = cmd_tree_rays(s->width, s->height, open ? 0 : j->settings.spp);
  cmd_tree_build(&j->tree, j->o, m, s->mem, s->threads);
  j->world.tracer = j->tree.tracer;
  choose_integrator(j);
  choose_guide(j);
  j->display = progress_new(given(j, OPT_QUIET));
  signals_catch_stop();
  render_run(&j->result, &j->world, &s->view, &j->settings, s->mem, s->threads);
  progress_clear(&j->display);
}

// Draw.  The frame is the one pass: a first signal lets it end.
static int run_raster(render_job *j) {
  error err;
  signals_catch_stop();
  j->raster.settings = raster_job_settings(&j->shot);
  if (raster_job_upload(&j->raster, &j->shot, j->shot.mem, &err) &&
      raster_job_draw(&j->result, &j->raster, &j->shot,
                      j->o->value[OPT_AOV].words, &err))
    return EXIT_DONE;
  return cmd_fail(j->o, EXIT_RESOURCES, "%s", err.text);
}

// Dropped samples are a defect of ours; say where, so that it can be found.
static int check_samples(render_job *j) {
  const render_result *r = &j->result;
  if (r->non_finite == 0) return EXIT_DONE;
  report later = {.mem = j->shot.mem};
  report_warn(&later,
              "%llu %s were not finite and are left out; first: "
              "--crop %d,%d,%d,%d --seed %llu, sample %d",
              (unsigned long long)r->non_finite,
              j->engine == ENGINE_PATH ? "samples" : "pixels", r->bad_x,
              r->bad_y, r->bad_x + 1, r->bad_y + 1,
              (unsigned long long)j->settings.seed, r->bad_sample);
  cmd_remarks(j->o, &later);
  report_warn(&j->shot.remarks, "%s", later.first->text);
  return given(j, OPT_STRICT)
             ? cmd_fail(j->o, EXIT_NO, "a warning, and --strict")
             : EXIT_DONE;
}

// Everything before the first pixel; an exit code.
static int prepare(render_job *j) {
  int code = output_plan(&j->out, j->o, j->shot.mem);
  if (code == EXIT_DONE) code = plan_engine(j);
  if (code != EXIT_DONE) return code;
  signals_catch_snapshot();
  if ((code = shot_read(&j->shot)) != EXIT_DONE) return code;
  if ((code = choose_engine(j)) != EXIT_DONE) return code;
  output_warn(&j->out, &j->shot.remarks);
  if ((code = shot_remark(&j->shot)) != EXIT_DONE) return code;
  code = output_protect_inputs(&j->out, &j->shot.scene, j->shot.mem);
  if (code != EXIT_DONE) return code;
  j->out.exposure = given(j, OPT_EXPOSURE) ? j->o->value[OPT_EXPOSURE].number[0]
                                           : j->shot.scene.exposure;
  code = shot_frame(&j->shot);
  j->out.pane.x0 = j->shot.x0, j->out.pane.y0 = j->shot.y0;
  return code;
}

// All stages; an exit code.
static int run_job(render_job *j) {
  int code = prepare(j);
  if (code != EXIT_DONE) return code;
  if (j->engine == ENGINE_PATH)
    run_path(j);
  else if ((code = run_raster(j)) != EXIT_DONE)
    return code;
  if ((code = check_samples(j)) != EXIT_DONE) return code;
  if ((code = write_picture(j)) != EXIT_DONE) return code;
  if (!given(j, OPT_QUIET)) print_summary(j);
  if (given(j, OPT_JSON)) print_json_render(j);
  return j->result.stopped ? EXIT_EARLY : EXIT_DONE;
}

int cmd_render(const options *o) {
  arena mem = {0};
  render_job j = {.o = o};
  j.shot = (shot){.o = o, .mem = &mem, .remarks = {.mem = &mem}};
  j.shot.threads = pool_new(&mem, cmd_threads(o));
  int code = run_job(&j);
  raster_job_close(&j.raster);
  pool_free(j.shot.threads);
  arena_free(&mem);
  return code;
}
