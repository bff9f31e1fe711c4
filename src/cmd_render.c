// cmd_render.c — facet render: from a scene and a command line to a picture.

#include "aim_learn.h"
#include "cmd_render_plan.h"
#include "cmd_signals.h"
#include "share_learn.h"

#include "adaptive.h"
#include "clock.h"
#include "doubling.h"
#include "plan_use.h"
#include "ready.h"

#include <string.h>

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
  const char *what = NULL;
  if (v[OPT_AOV].words & PATH_AOVS) what = "--aov variance and samples need";
  if (j->out.part) what = "a .part is made of samples and needs";
  if (v[OPT_CHECKPOINT].given) what = "--checkpoint needs";
  if (v[OPT_SHARD].given) what = "--shard needs";
  if (what == NULL) return EXIT_DONE;
  if (j->engine == ENGINE_AUTO) j->engine = ENGINE_PATH;
  if (j->engine == ENGINE_PATH) return EXIT_DONE;
  return cmd_fail(j->o, EXIT_USAGE, "%s --engine path", what);
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

// Write the picture, or what can be made one.
static bool write_result(render_job *j, const render_result *r, arena *mem,
                         error *err) {
  if (j->out.part) return part_write(&j->keep.part, j->out.path, err);
  return output_write(&j->out, r, mem, err);
}

// Write the picture; an exit code.
static int write_picture(render_job *j) {
  error err;
  arena once = {0};
  double start = clock_seconds();
  bool ok = write_result(j, &j->result, &once, &err);
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
  else if (!write_result(j, so_far, &once, &err))
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
      .aovs = render_plan_films(j),
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
  if (given(j, OPT_QUIET)) j->settings.progress = NULL;
}

// What paths walk through, as far as the plan wants it.
static void ready_world(render_job *j) {
  const shot *sh = &j->shot;
  pbr_model model = (pbr_model)j->o->value[OPT_PBR_MODEL].words;
  double start = clock_seconds();
  j->world = (path_world){.scene = &sh->scene};
  plan_settle_paths(&j->plan, &j->world);
  if (plan_needs(&j->plan, PLAN_TABLE))
    j->world.dfg = matter_table_as_is(&sh->scene, model, sh->mem, sh->threads);
  plan_note(&j->plan, PLAN_TABLE, j->world.dfg != NULL, clock_seconds() - start,
            0);
}

// Let the walker learn which lights are seen from where.
static void learn_lights(render_job *j) {
  const shot *s = &j->shot;
  if (j->settings.shading != RENDER_RADIANCE) return;
  double start = clock_seconds();
  j->film = (path_film){&s->view, s->width, s->height};
  path_learn(&j->lights, &j->paths, &j->film, s->mem, s->threads);
  if (plan_needs(&j->plan, PLAN_AIM))
    j->paths.aim = aim_learn(&j->paths, &j->film, s->mem, s->threads);
  if (plan_needs(&j->plan, PLAN_SHARE) &&
      share_learn(&j->paths, &j->film, s->threads))
    j->paths.film = &j->film;
  j->learn_seconds = clock_seconds() - start;
}

// Who walks: path_naive by --integrator naive, with random numbers; by auto
// one that remembers.
static void choose_integrator(render_job *j) {
  const option_value *v = j->o->value;
  uint64_t seed = j->settings.seed;
  if (v[OPT_INTEGRATOR].words == 1) {
    j->naive = (path_naive){&j->world, seed};
    j->by = path_naive_integrator(&j->naive);
  } else {
    light_set_build(&j->lights, &j->shot.scene, j->world.lights,
                    plan_needs(&j->plan, PLAN_ENV_TABLE), j->shot.mem,
                    j->shot.threads);
    j->paths = (path_tracer){.world = &j->world,
                             .lights = &j->lights,
                             .ready = ready_best(),
                             .starts = ready_starts_best(),
                             .sky = ready_sky_best(),
                             .sampler = (sampler_kind)v[OPT_SAMPLER].words,
                             .seed = seed};
    j->by = path_integrator(&j->paths);
    if (v[OPT_INTEGRATOR].words == 0) learn_lights(j);
  }
  if (!plan_needs(&j->plan, PLAN_PATHS)) {
    j->dark = j->by;
    j->by = plan_dark(&j->dark);
  }
  j->settings.by = &j->by;
}

// A jury (chapter 15).  It asks those who walk for the picture, but alone,
// where the picture's pixels share what they find: its pixels have no
// neighbours.
static void choose_jury(render_job *j) {
  const render_settings *s = &j->settings;
  j->jury = (jury){&j->by, &j->shot.view, s->width, s->height, 0, 0, 0, 0, 0};
  if (s->x1 > 0) j->jury.x0 = s->x0, j->jury.y0 = s->y0;
  if (j->paths.film == NULL) return;
  j->alone = j->paths;
  j->alone.film = NULL;
  j->once = path_integrator(&j->alone);
  j->jury.by = &j->once;
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
    // Not where time decides: nobody has said when to stop asking.
    bool judged = !(s->deadline > 0);
    adaptive_settings a = {w, h, s->error, s->spp, judged ? &j->jury : NULL};
    choose_jury(j);
    j->keep.adaptive = adaptive_new(&a, sh->mem);
    j->guide = adaptive_guide(j->keep.adaptive);
    j->halves = (halves_walk){&j->by, (uint64_t)s->width * (uint64_t)s->height};
    j->twice = halves_integrator(&j->halves);
    s->by = &j->twice;
  } else if (cmd_keep_wanted(&j->keep) ? j->keep.part.films >> PART_MARKS & 1
                                       : plan_needs(&j->plan, PLAN_ESTIMATE)) {
    j->keep.doubling = doubling_new(sh->mem, w, h);
    j->guide = doubling_guide(j->keep.doubling);
  } else {
    return;
  }
  s->guide = &j->guide;
  cmd_keep_watch(&j->keep);
}

// Build the tree and trace paths; an exit code.
static int run_path(render_job *j) {
  shot *s = &j->shot;
  const mesh *m = &s->scene.mesh;
  choose_settings(j);
  ready_world(j);
  int code = cmd_keep_open(&j->keep, s, &j->settings);
  if (code != EXIT_DONE) return code;
  bool open = j->settings.spp == SPP_WITHOUT_LIMIT;
  double rays = cmd_tree_rays(s->width, s->height, open ? 0 : j->settings.spp);
  j->tree.paths = true;
  j->tree.rays = rays / (j->settings.shards > 0 ? j->settings.shards : 1);
  const char *slash = strrchr(s->scene.path, '/');
  if (!given(j, OPT_NO_CACHE))
    j->tree.name = slash == NULL ? s->scene.path : slash + 1;
  cmd_tree_build(&j->tree, j->o, m, s->mem, s->threads);
  j->world.tracer = j->tree.tracer;
  choose_integrator(j);
  choose_guide(j);
  j->display = progress_new(given(j, OPT_QUIET));
  signals_catch_stop();
  render_run(&j->result, &j->world, &s->view, &j->settings, s->mem, s->threads);
  j->result.seconds += j->learn_seconds;
  progress_clear(&j->display);
  render_plan_note_paths(j);
  return EXIT_DONE;
}

// Draw.  The frame is the one pass: a first signal lets it end.
static int run_raster(render_job *j) {
  error err;
  signals_catch_stop();
  j->raster.settings = raster_job_settings(&j->shot);
  j->raster.plan = &j->plan;
  plan_settle(&j->plan, &j->raster.settings);
  if (!raster_job_upload(&j->raster, &j->shot, j->shot.mem, &err) ||
      !raster_job_draw(&j->result, &j->raster, &j->shot, render_plan_films(j),
                       &err))
    return cmd_fail(j->o, EXIT_RESOURCES, "%s", err.text);
  raster_job_note(&j->raster, &j->plan, &j->shot);
  return EXIT_DONE;
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
  int code = cmd_keep_plan(&j->keep, j->o, j->shot.mem);
  if (code == EXIT_DONE) code = output_plan(&j->out, j->o, j->shot.mem);
  if (code == EXIT_DONE) code = plan_engine(j);
  if (code == EXIT_DONE) code = cmd_keep_aim(&j->keep, j->out.part);
  if (code != EXIT_DONE) return code;
  signals_catch_snapshot();
  if ((code = shot_open(&j->shot)) != EXIT_DONE) return code;
  if ((code = choose_engine(j)) != EXIT_DONE) return code;
  output_warn(&j->out, &j->shot.remarks);
  code = output_protect_inputs(&j->out, &j->shot.scene, j->shot.mem);
  if (code != EXIT_DONE) return code;
  if ((code = shot_frame(&j->shot)) != EXIT_DONE) return code;
  if ((code = render_plan_make(j)) != EXIT_DONE) return code;
  j->out.exposure = given(j, OPT_EXPOSURE) ? j->o->value[OPT_EXPOSURE].number[0]
                                           : j->shot.scene.exposure;
  j->out.pane.x0 = j->shot.x0, j->out.pane.y0 = j->shot.y0;
  return shot_remark(&j->shot);
}

// All stages; an exit code.
static int run_job(render_job *j) {
  int code = prepare(j);
  if (code != EXIT_DONE) return code;
  code = j->engine == ENGINE_PATH ? run_path(j) : run_raster(j);
  if (code == EXIT_DONE) code = cmd_keep_close(&j->keep, &j->result);
  if (code == EXIT_DONE) code = check_samples(j);
  if (code == EXIT_DONE) code = write_picture(j);
  if (code != EXIT_DONE) return code;
  render_plan_note_output(j);
  if (given(j, OPT_EXPLAIN)) cmd_plan_print(&j->plan, stderr);
  if (!given(j, OPT_QUIET)) render_job_say(j);
  if (given(j, OPT_JSON)) render_job_json(j);
  if (j->result.stopped) return EXIT_EARLY;
  return j->keep.lost ? EXIT_OUTPUT : EXIT_DONE;
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
