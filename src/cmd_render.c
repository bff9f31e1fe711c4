// cmd_render.c — facet render: from a scene and a command line to a picture.

#include "cmd_output.h"
#include "cmd_shared.h"
#include "cmd_signals.h"

#include "bvh.h"
#include "clock.h"
#include "progress.h"
#include "text.h"

#include <math.h>
#include <string.h>
#include <sys/resource.h>

// One run, stage by stage.
typedef struct render_job {
  const options *o;
  arena *mem;
  pool *threads;
  report remarks;
  output out;
  scene scene;
  camera camera;
  camera_view view;
  bvh tree;
  path_world world;
  render_settings settings;
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

// The three numbers of an option.
static vec3 triple(const render_job *j, option_id id) {
  const float *n = j->o->value[id].number;
  return (vec3){n[0], n[1], n[2]};
}

// Read the scene, print what was noticed; an exit code.
static int load_scene(render_job *j) {
  const options *o = j->o;
  scene_options so = {
      .normals = (normals_mode)o->value[OPT_NORMALS].words,
      .crease_deg = o->value[OPT_CREASE].number[0],
      .no_name_rules = given(j, OPT_NO_NAME_RULES),
      .up_z = o->value[OPT_UP_AXIS].words == 1,
      .env = o->value[OPT_ENV].text,
  };
  if (given(j, OPT_ENV_ROTATE))
    so.env_rotate_deg = o->value[OPT_ENV_ROTATE].number;
  if (given(j, OPT_ENV_SCALE)) so.env_scale = o->value[OPT_ENV_SCALE].number;
  error err;
  bool ok = scene_load(&j->scene, o->operands[0], &so, j->mem, j->threads,
                       &j->remarks, &err);
  if (ok) output_warn(&j->out, &j->remarks);
  cmd_remarks(o, &j->remarks);
  if (!ok) return cmd_fail(o, EXIT_INPUT, "%s", err.text);
  if (j->scene.mesh.triangle_count == 0 &&
      !cmd_has_suffix(o->operands[0], ".scene"))
    return cmd_fail(o, EXIT_INPUT, "%s: nothing to render, it has no faces",
                    o->operands[0]);
  if (given(j, OPT_STRICT) && j->remarks.warnings > 0)
    return cmd_fail(o, EXIT_NO, "%d warnings, and --strict",
                    j->remarks.warnings);
  return output_protect_inputs(&j->out, &j->scene, j->mem);
}

// Specular exponent to roughness: the exponent whose lobe is as wide as that
// of a microfacet distribution with alpha = roughness^2.  Source: Walter et
// al., "Microfacet Models for Refraction", 2007: Ns = 2 / alpha^2 - 2.
static float roughness_of_exponent(float ns) {
  return sqrtf(sqrtf(2 / (fmaxf(ns, 0) + 2)));
}

// --shading blinn-phong or pbr: every material by that one model.
static void force_model(render_job *j) {
  unsigned shading = j->o->value[OPT_SHADING].words;
  if (shading != 1 && shading != 2) return;
  for (size_t i = 0; i < j->scene.material_count; i++) {
    material *m = &j->scene.materials[i];
    bool rough = m->kind == MATERIAL_METAL_ROUGH;
    if (shading == 2 && !rough) {
      bool mirror = m->kind == MATERIAL_MIRROR;
      m->roughness = mirror ? 0 : roughness_of_exponent(m->ns);
      m->metallic = mirror ? 1 : 0;
      if (mirror) m->kd = m->ks;
    }
    m->kind = shading == 1 ? MATERIAL_BLINN_PHONG : MATERIAL_METAL_ROUGH;
  }
}

// Width and height: the flag, the scene's film line, the default.
static void choose_size(render_job *j) {
  const option_value *v = &j->o->value[OPT_RESOLUTION];
  j->settings.width = (int)v->whole[0];
  j->settings.height = (int)v->whole[1];
  if (v->given || j->scene.film_width <= 0) return;
  j->settings.width = j->scene.film_width;
  j->settings.height = j->scene.film_height;
}

// --crop, checked against the size; an exit code.
static int choose_crop(render_job *j) {
  render_settings *s = &j->settings;
  if (!given(j, OPT_CROP)) return EXIT_DONE;
  const long long *box = j->o->value[OPT_CROP].whole;
  if (box[0] >= box[2] || box[1] >= box[3] || box[2] > s->width ||
      box[3] > s->height)
    return cmd_fail(j->o, EXIT_USAGE,
                    "--crop %s: needs X0 < X1 <= %d and Y0 < Y1 <= %d",
                    j->o->value[OPT_CROP].text, s->width, s->height);
  s->x0 = (int)box[0], s->y0 = (int)box[1];
  s->x1 = (int)box[2], s->y1 = (int)box[3];
  return EXIT_DONE;
}

// There is no camera of that name: name the nearest.
static int unknown_camera(const render_job *j, const char *name) {
  const scene *s = &j->scene;
  const char **list = ARENA_NEW(j->mem, const char *, s->camera_count + 1);
  size_t n = 0;
  for (size_t i = 0; i < s->camera_count; i++)
    if (s->cameras[i].name != NULL) list[n++] = s->cameras[i].name;
  const char *near = text_nearest((span){name, strlen(name)}, list);
  return cmd_fail(j->o, EXIT_USAGE,
                  "--camera %s: the scene has none of that "
                  "name%s%s",
                  name, near ? "; the nearest is " : "", near ? near : "");
}

// The camera: named, first or framed, then changed by the flags.
static int choose_camera(render_job *j) {
  const scene *s = &j->scene;
  const char *name = j->o->value[OPT_CAMERA].text;
  const camera *found = scene_camera(s, name);
  if (name != NULL && found == NULL) return unknown_camera(j, name);
  float aspect = (float)j->settings.width / (float)j->settings.height;
  j->camera = found ? *found : camera_framing(s->lo, s->hi, aspect);
  if (given(j, OPT_EYE)) j->camera.eye = triple(j, OPT_EYE);
  if (given(j, OPT_TARGET)) j->camera.target = triple(j, OPT_TARGET);
  if (given(j, OPT_UP)) j->camera.up = triple(j, OPT_UP);
  if (given(j, OPT_FOV)) j->camera.fov_deg = j->o->value[OPT_FOV].number[0];
  error err;
  if (camera_view_of(&j->view, &j->camera, j->settings.width,
                     j->settings.height, &err))
    return EXIT_DONE;
  bool by_flag = given(j, OPT_EYE) || given(j, OPT_TARGET) ||
                 given(j, OPT_UP) || given(j, OPT_FOV);
  return cmd_fail(j->o, by_flag ? EXIT_USAGE : EXIT_INPUT, "%s", err.text);
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

// What the rest of the flags say to the renderer.
static void choose_settings(render_job *j) {
  const option_value *v = j->o->value;
  render_settings *s = &j->settings;
  static const render_shading shadings[] = {RENDER_RADIANCE, RENDER_RADIANCE,
                                            RENDER_RADIANCE, RENDER_NORMAL,
                                            RENDER_DEPTH,    RENDER_ALBEDO};
  s->shading = shadings[v[OPT_SHADING].words];
  s->spp = (int)v[OPT_SPP].whole[0];
  if (!v[OPT_SPP].given && (v[OPT_TIME].given || v[OPT_ERROR].given))
    s->spp = SPP_WITHOUT_LIMIT;
  s->seed = (uint64_t)v[OPT_SEED].whole[0];
  s->aovs = v[OPT_AOV].words;
  s->error = v[OPT_ERROR].given ? (double)v[OPT_ERROR].number[0] : 0;
  if (v[OPT_TIME].given)
    s->deadline = j->o->started + (double)v[OPT_TIME].number[0] -
                  WRITE_SECONDS * s->width * s->height;
  s->stop = &signal_stop;
  s->progress = progress_show;
  s->progress_context = &j->display;
  s->snapshot = &signal_snapshot;
  s->on_snapshot = write_snapshot;
  s->snapshot_context = j;
  j->out.exposure =
      v[OPT_EXPOSURE].given ? v[OPT_EXPOSURE].number[0] : j->scene.exposure;
  j->world = (path_world){.scene = &j->scene,
                          .lights = v[OPT_LIGHTS].words == 0,
                          .max_depth = (int)v[OPT_MAX_DEPTH].whole[0]};
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
  char warnings[64] = "no warnings";
  if (j->remarks.warnings > 0)
    snprintf(warnings, sizeof warnings, "%d warning%s", j->remarks.warnings,
             j->remarks.warnings == 1 ? "" : "s");
  fprintf(stderr, "%s: %dx%d, %d spp, %.2f s, %zu triangles, %s%s\n",
          strcmp(j->out.path, "-") == 0 ? "standard output" : j->out.path,
          r->color.width, r->color.height, r->spp,
          clock_seconds() - j->o->started, j->scene.mesh.triangle_count,
          warnings, r->stopped ? "; stopped early" : "");
}

// The seconds of every stage.
static void json_seconds(json *j, const render_job *job) {
  json_open(j, "seconds", '{');
  json_number(j, "total", clock_seconds() - job->o->started);
  json_number(j, "load", job->scene.seconds_load);
  json_number(j, "textures", job->scene.seconds_textures);
  json_number(j, "build", job->tree.seconds);
  json_number(j, "render", job->result.seconds);
  json_number(j, "write", job->write_seconds);
  json_close(j, '{');
}

// The object of --json.
static void print_json_render(const render_job *job) {
  const render_result *r = &job->result;
  const bvh *b = &job->tree;
  json j = {.out = stdout};
  json_open(&j, NULL, '{');
  json_text(&j, "output", job->out.path);
  json_seconds(&j, job);
  json_count(&j, "rays", r->rays);
  json_count(&j, "samples", r->samples);
  json_count(&j, "spp", (unsigned long long)r->spp);
  json_count(&j, "triangles", job->scene.mesh.triangle_count);
  json_count(&j, "materials", job->scene.material_count);
  json_count(&j, "width", (unsigned long long)r->color.width);
  json_count(&j, "height", (unsigned long long)r->color.height);
  json_number(&j, "peak_bytes", peak_bytes());
  cmd_json_warnings(&j, &job->remarks);
  json_count(&j, "non_finite", r->non_finite);
  json_number(&j, "error", r->error > 0 ? r->error : (double)NAN);
  json_count(&j, "seed", job->settings.seed);
  json_count(&j, "threads", (unsigned long long)pool_threads(job->threads));
  json_flag(&j, "stopped", r->stopped);
  json_open(&j, "bvh", '{');
  json_count(&j, "nodes", b->node_count);
  json_number(&j, "cost", b->cost);
  json_count(&j, "depth", (unsigned long long)b->depth);
  json_count(&j, "dropped", b->dropped);
  json_count(&j, "bytes",
             b->node_count * sizeof(bvh_node) + b->kept * sizeof(uint32_t));
  json_close(&j, '{');
  json_close(&j, '{');
  json_end(&j);
}

// Build the tree and render.
static void run_renderer(render_job *j) {
  const mesh *m = &j->scene.mesh;
  bvh_build(&j->tree, m->positions, m->position_index,
            (uint32_t)m->triangle_count, BVH_SAH, j->mem, j->threads);
  bool brute = j->o->value[OPT_BVH].words == 2;
  j->world.tracer = brute ? brute_tracer(&j->tree) : bvh_tracer(&j->tree);
  j->display = progress_new(given(j, OPT_QUIET));
  signals_catch_stop();
  render_run(&j->result, &j->world, &j->view, &j->settings, j->mem, j->threads);
  progress_clear(&j->display);
}

// Dropped samples are a defect of ours; say where, so that it can be found.
static int check_samples(render_job *j) {
  const render_result *r = &j->result;
  if (r->non_finite == 0) return EXIT_DONE;
  report later = {.mem = j->mem};
  report_warn(&later,
              "%llu samples were not finite and are left out; first: "
              "--crop %d,%d,%d,%d --seed %llu, sample %d",
              (unsigned long long)r->non_finite, r->bad_x, r->bad_y,
              r->bad_x + 1, r->bad_y + 1, (unsigned long long)j->settings.seed,
              r->bad_sample);
  cmd_remarks(j->o, &later);
  report_warn(&j->remarks, "%s", later.first->text);
  return given(j, OPT_STRICT)
             ? cmd_fail(j->o, EXIT_NO, "a warning, and --strict")
             : EXIT_DONE;
}

// All stages; an exit code.
static int run_job(render_job *j) {
  int code = output_plan(&j->out, j->o, j->mem);
  if (code != EXIT_DONE) return code;
  signals_catch_snapshot();
  if ((code = load_scene(j)) != EXIT_DONE) return code;
  force_model(j);
  choose_size(j);
  if ((code = choose_crop(j)) != EXIT_DONE) return code;
  if ((code = choose_camera(j)) != EXIT_DONE) return code;
  choose_settings(j);
  run_renderer(j);
  if ((code = check_samples(j)) != EXIT_DONE) return code;
  if ((code = write_picture(j)) != EXIT_DONE) return code;
  if (!given(j, OPT_QUIET)) print_summary(j);
  if (given(j, OPT_JSON)) print_json_render(j);
  return j->result.stopped ? EXIT_EARLY : EXIT_DONE;
}

int cmd_render(const options *o) {
  arena mem = {0};
  render_job j = {.o = o, .mem = &mem, .remarks = {.mem = &mem}};
  j.threads = pool_new(&mem, cmd_threads(o));
  int code = run_job(&j);
  pool_free(j.threads);
  arena_free(&mem);
  return code;
}
