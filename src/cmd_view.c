// cmd_view.c — facet view: a scene to fly through, in a window or by a script.

#include "cmd_view_say.h"

#include "clock.h"
#include "cmd_raster.h"
#include "cmd_shot.h"
#include "picture.h"
#include "post.h"
#include "tonemap.h"
#include "view_paths.h"
#include "view_window.h"

#include <string.h>

// Seconds without a frame after which the camera does not make up for them: a
// machine that slept does not fling it out of the scene.
#define LONGEST_STEP 0.5

// Seconds to wait for events where nothing moves: while paths are traced, so
// that a pass that ends is soon seen, and at rest.
#define WAIT_FOR_PASS 0.01
#define WAIT_AT_REST 0.25

// Samples a pixel of a script's path-traced frames.
enum { SCRIPT_SPP = 16 };

// One run of the command.
typedef struct view_job {
  const options *o;
  shot shot;
  raster_job raster;  // r is NULL before the first frame
  material *base;     // as the rasteriser had them at first
  pool *tracers;      // workers for paths; opened with it
  view_paths *paths;  // NULL before it is first asked for
  view_window *window;
  view_state state;
  post_frost pane;
  float exposure;
  int spp;              // of a script's frames
  arena frame;          // holds
  image seen;           // the radiance last rendered
  view_look seen_look;  // and how it looked
  bool seen_frosted, seen_paths, tracing;
  srgb_table codes;
  unsigned char *rgb;
} view_job;

// Open the rasteriser, at its first frame.
static bool open_raster(view_job *j, error *err) {
  raster_job *r = &j->raster;
  arena *mem = j->shot.mem;
  if (j->window != NULL) r->g = view_window_gl(j->window);
  if (r->g == NULL && !raster_job_open(r, j->o, mem, err)) return false;
  r->settings = raster_job_settings(&j->shot);
  r->any_roughness = true;
  if (!raster_job_upload(r, &j->shot, mem, err)) return false;
  size_t n;
  const material *first = raster_materials(r->r, &n);
  j->base = ARENA_NEW(mem, material, n);
  memcpy(j->base, first, n * sizeof *first);
  return true;
}

// The scene as it looks now, by the rasteriser.
static bool draw_raster(view_job *j, image *out, arena *mem, error *err) {
  if (j->raster.r == NULL && !open_raster(j, err)) return false;
  const view_look *look = &j->state.look;
  raster *r = j->raster.r;
  size_t n;
  material *drawn = raster_materials(r, &n);
  view_materials(drawn, j->base, n, look);
  for (size_t i = 0; i < n; i++)
    raster_hide(r, i,
                look->only_rough && drawn[i].kind != MATERIAL_METAL_ROUGH);
  camera_view view;
  if (!camera_view_of(&view, &look->camera, j->shot.width, j->shot.height, err))
    return false;
  if (!raster_draw(r, &view, err)) return false;
  *out = raster_read(r, mem);
  return true;
}

// Let the path tracer begin with the present look.
static bool start_paths(view_job *j, error *err) {
  const option_value *v = j->o->value;
  arena *mem = j->shot.mem;
  if (j->paths == NULL) {
    const scene *seen = &j->shot.scene;
    pbr_model model = v[OPT_PBR_MODEL].words == 0 ? PBR_GGX : PBR_REPORT;
    // The caller is no worker here: one more, so that as many work as asked.
    j->tracers = pool_new(mem, cmd_threads(j->o) + 1);
    view_paths_settings set = {
        .width = j->shot.width,
        .height = j->shot.height,
        .seed = (uint64_t)v[OPT_SEED].whole[0],
        .world = {.scene = seen,
                  .dfg = matter_table(seen, model, mem, j->shot.threads),
                  .lights = v[OPT_LIGHTS].words == 0,
                  .max_depth = (int)v[OPT_MAX_DEPTH].whole[0]}};
    j->paths = view_paths_new(&set, j->tracers, mem);
  }
  return view_paths_restart(j->paths, &j->state.look, err);
}

// The picture as the eye gets it: behind the glass, where it is on, and, for
// pictures of 8 bits, exposed.
static image developed(const view_job *j, bool exposed, arena *mem) {
  const image *seen = &j->seen;
  image im = image_new(mem, seen->width, seen->height);
  size_t n = (size_t)im.width * (size_t)im.height;
  if (j->state.frosted)
    im = post_frosted(seen, j->pane, mem, j->shot.threads);
  else
    memcpy(im.pixels, seen->pixels, n * sizeof *im.pixels);
  if (exposed)
    tonemap_apply(&im, j->exposure,
                  (tonemap_curve)j->o->value[OPT_TONEMAP].words);
  return im;
}

// Write what is seen; an exit code.
static int write_frame(const view_job *j, const char *path) {
  arena mem = {0};
  error err;
  picture_format format = picture_format_of(path);
  image im = developed(j, format == PICTURE_PNG, &mem);
  bool ok = picture_write(&im, path, format, 8, &err);
  arena_free(&mem);
  if (!ok) return cmd_fail(j->o, EXIT_OUTPUT, "%s", err.text);
  if (!j->o->value[OPT_QUIET].given) view_say_written(path);
  return EXIT_DONE;
}

// Work of the pool: the sRGB codes of one row.
typedef struct coding {
  const image *im;
  const srgb_table *codes;
  unsigned char *rgb;
} coding;

static void code_row(void *context, size_t row, int worker) {
  (void)worker;
  const coding *c = context;
  size_t width = (size_t)c->im->width;
  const vec3 *in = c->im->pixels + row * width;
  unsigned char *out = c->rgb + 3 * row * width;
  for (size_t x = 0; x < width; x++) {
    out[3 * x] = srgb_code(c->codes, in[x].x);
    out[3 * x + 1] = srgb_code(c->codes, in[x].y);
    out[3 * x + 2] = srgb_code(c->codes, in[x].z);
  }
}

// Put what is seen into the window.
static void show(view_job *j) {
  arena mem = {0};
  image im = developed(j, true, &mem);
  coding c = {&im, &j->codes, j->rgb};
  pool_run(j->shot.threads, (size_t)im.height, code_row, &c);
  view_window_show(j->window, j->rgb);
  int spp = j->seen_paths ? view_paths_spp(j->paths) : 0;
  view_window_title(j->window, view_title(j->o->operands[0], spp, &mem));
  j->seen_frosted = j->state.frosted;
  arena_free(&mem);
}

// Render the present look for a script, whatever time it takes.
static bool render_frame(view_job *j, error *err) {
  arena_free(&j->frame);
  j->seen_paths = j->state.paths;
  if (!j->state.paths) return draw_raster(j, &j->seen, &j->frame, err);
  if (!start_paths(j, err)) return false;
  j->seen = view_paths_finish(j->paths, j->spp, &j->frame);
  return true;
}

// Answer the keys that ask for something; an exit code.
static int answer(view_job *j) {
  view_state *s = &j->state;
  if (s->print)
    view_print_command(j->o, s, j->shot.width, j->shot.height, j->shot.mem);
  if (s->help) view_print_keys();
  bool save = s->save;
  s->print = s->help = s->save = false;
  if (!save) return EXIT_DONE;
  arena mem = {0};
  int code = write_frame(j, view_free_name(j->o->operands[0], &mem));
  arena_free(&mem);
  return code;
}

// Bring what is seen up to date without waiting for anything.  *busy: there
// will be more to see soon.
static bool refresh(view_job *j, bool *busy, error *err) {
  const view_state *s = &j->state;
  bool moved =
      j->seen.pixels == NULL || !view_same_look(&j->seen_look, &s->look);
  if (moved || (j->seen_paths && !s->paths)) {
    if (j->paths != NULL) view_paths_stop(j->paths);
    j->tracing = j->seen_paths = false;
    arena_free(&j->frame);
    if (!draw_raster(j, &j->seen, &j->frame, err)) return false;
    j->seen_look = s->look;
    show(j);
  } else if (s->paths && !j->tracing) {
    if (!start_paths(j, err)) return false;
    j->tracing = true;
  } else if (!s->paths && j->tracing) {
    view_paths_stop(j->paths);
    j->tracing = false;
  }
  arena next = {0};
  image passed;
  if (j->tracing && view_paths_poll(j->paths, &passed, &next)) {
    arena_free(&j->frame);
    j->frame = next;
    j->seen = passed;
    j->seen_paths = true;
    show(j);
  } else if (j->seen_frosted != s->frosted) {
    show(j);
  }
  *busy = moved;
  return true;
}

// Until Escape; an exit code.
static int run_window(view_job *j) {
  error err;
  bool busy = true;
  double then = clock_seconds();
  while (!j->state.leaving) {
    view_event events[VIEW_WINDOW_EVENTS];
    double wait = busy ? 0 : j->state.paths ? WAIT_FOR_PASS : WAIT_AT_REST;
    size_t n = view_window_poll(j->window, wait, events);
    // First the time that has gone, with the keys as they were in it.
    double now = clock_seconds();
    view_fly(&j->state, fmin(now - then, LONGEST_STEP));
    then = now;
    for (size_t i = 0; i < n; i++)
      view_happen(&j->state, &events[i]);
    if (!refresh(j, &busy, &err))
      return cmd_fail(j->o, EXIT_RESOURCES, "%s", err.text);
    int code = answer(j);
    if (code != EXIT_DONE) return code;
  }
  return EXIT_DONE;
}

// Every event in turn; an exit code.
static int run_script(view_job *j, const view_script *script) {
  error err;
  for (size_t i = 0; i < script->count && !j->state.leaving; i++) {
    const view_event *e = &script->events[i];
    view_happen(&j->state, e);
    if (e->kind == VIEW_EVENT_SPP) j->spp = e->spp;
    bool render = e->kind == VIEW_EVENT_FRAME || j->state.save;
    if (render && !render_frame(j, &err))
      return cmd_fail(j->o, EXIT_RESOURCES, "%s; the path tracer needs none",
                      err.text);
    int code = answer(j);
    if (code == EXIT_DONE && e->kind == VIEW_EVENT_FRAME)
      code = write_frame(j, e->path);
    if (code != EXIT_DONE) return code;
  }
  return EXIT_DONE;
}

// Read the script; an exit code.
static int read_script(view_job *j, view_script *out, const char *path) {
  error err;
  span text;
  if (!text_read(&text, path, j->shot.mem, &err) ||
      !view_script_read(out, text, path, j->shot.mem, &err))
    return cmd_fail(j->o, EXIT_INPUT, "%s", err.text);
  for (size_t i = 0; i < out->count; i++) {
    const view_event *e = &out->events[i];
    if (e->kind != VIEW_EVENT_FRAME) continue;
    picture_format f = picture_format_of(e->path);
    if (f == PICTURE_PNG || f == PICTURE_PFM || f == PICTURE_HDR) continue;
    return cmd_fail(j->o, EXIT_INPUT,
                    "%s:%lu: %s: cannot tell the format from this suffix, "
                    "expected .png, .pfm or .hdr",
                    path, e->line, e->path);
  }
  return EXIT_DONE;
}

// What the options say before anything moves.
static void prepare(view_job *j) {
  const option_value *v = j->o->value;
  const scene *s = &j->shot.scene;
  bool rough = false;
  for (size_t i = 0; i < s->material_count; i++)
    rough |= s->materials[i].kind == MATERIAL_METAL_ROUGH;
  j->state = view_start(&j->shot.camera, s->lo, s->hi, rough);
  j->state.frosted = v[OPT_POST].given;
  j->state.paths = v[OPT_ENGINE].words == 1;
  j->exposure = v[OPT_EXPOSURE].given ? v[OPT_EXPOSURE].number[0] : s->exposure;
  j->spp = SCRIPT_SPP;
}

// With a window; an exit code.
static int open_and_run(view_job *j) {
  error err;
  int width = j->shot.width, height = j->shot.height;
  const char *title = view_title(j->o->operands[0], 0, j->shot.mem);
  if (!view_window_open(&j->window, width, height, title, j->shot.mem, &err))
    return cmd_fail(j->o, EXIT_RESOURCES, "%s", err.text);
  j->codes = srgb_table_new();
  j->rgb =
      ARENA_NEW(j->shot.mem, unsigned char, 3 * (size_t)width * (size_t)height);
  int code = run_window(j);
  if (j->paths != NULL) view_paths_stop(j->paths);
  raster_job_close(&j->raster);
  view_window_close(j->window);
  return code;
}

// All stages; an exit code.
static int run_view(view_job *j) {
  const char *script = j->o->value[OPT_SCRIPT].text;
  view_script events = {0};
  error err;
  const char *pane = j->o->value[OPT_POST].text;
  if (!post_parse(&j->pane, pane != NULL ? pane : "frosted", &err))
    return cmd_fail(j->o, EXIT_USAGE, "%s", err.text);
  int code = script == NULL ? EXIT_DONE : read_script(j, &events, script);
  if (code != EXIT_DONE || (code = shot_read(&j->shot)) != EXIT_DONE ||
      (code = shot_remark(&j->shot)) != EXIT_DONE ||
      (code = shot_frame(&j->shot)) != EXIT_DONE)
    return code;
  prepare(j);
  if (script == NULL) return open_and_run(j);
  code = run_script(j, &events);
  raster_job_close(&j->raster);
  return code;
}

int cmd_view(const options *o) {
  arena mem = {0};
  view_job j = {.o = o};
  j.shot = (shot){.o = o, .mem = &mem, .remarks = {.mem = &mem}};
  j.shot.threads = pool_new(&mem, cmd_threads(o));
  int code = run_view(&j);
  if (j.paths != NULL) view_paths_free(j.paths);
  pool_free(j.tracers);
  pool_free(j.shot.threads);
  arena_free(&j.frame);
  arena_free(&mem);
  return code;
}
