// cmd_error_run.c — the trick: every picture is made by a facet of its own,
// started as a user would start it, so that whatever an option does, and all
// that comes before the first pixel, is in the time.

#include "cmd_error_run.h"

#include "metric.h"
#include "picture.h"

#include <math.h>

// Places in the list of methods.
enum { METHOD_PATH = 1, METHOD_ADAPTIVE = 8 };

const error_method error_methods[] = {
    {"raster", .flags = {"--engine=raster"}},
    {"path", .path = true, .flags = {"--engine=path"}},
    {"flat", .flags = {"--engine=raster", "--shading=albedo"}},
    {"phong", .flags = {"--engine=raster", "--shading=blinn-phong"}},
    {"pbr", .flags = {"--engine=raster", "--shading=pbr"}},
    {"naive", .path = true,
     .flags = {"--engine=path", "--integrator=naive", "--bvh=binary"}},
    {"mis", .path = true,
     .flags = {"--engine=path", "--integrator=mis", "--sampler=random",
               "--bvh=binary"}},
    {"sobol", .path = true,
     .flags = {"--engine=path", "--integrator=mis", "--sampler=sobol",
               "--bvh=binary"}},
    {"adaptive", .path = true, .adaptive = true, .flags = {"--engine=path"}},
};

// The reference has this many times the samples of the best picture, so that
// what it lacks itself adds about 3 % to the squared error of that one.
enum { REFERENCE_FACTOR = 32 };

// Added to the seed of the reference: its noise is its own.
#define REFERENCE_SEED UINT64_C(1000003)

enum { MAX_ARGUMENTS = OPTION_COUNT + 24 };

// A command line under construction.
typedef struct words {
  arena *mem;
  char *word[MAX_ARGUMENTS];
  int count;
} words;

static void say(words *w, const char *flag, const char *value) {
  w->word[w->count++] =
      arena_format(w->mem, value ? "%s=%s" : "%s", flag, value);
}

// What bench error and render both know is for the children to know.
static void pass_options(words *w, const options *o) {
  for (int i = 0; i < OPTION_COUNT; i++) {
    const option *k = &option_table[i];
    bool ours = i == OPT_OUTPUT || i == OPT_JSON || i == OPT_QUIET ||
                i == OPT_SEED || i == OPT_HELP;
    if (ours || !o->value[i].given || (k->commands & CMD_RENDER) == 0) continue;
    say(w, arena_format(w->mem, "--%s", k->name),
        k->kind == OPTION_SWITCH ? NULL : o->value[i].text);
  }
}

// What one picture is to be.
typedef struct error_order {
  const error_method *method;
  int spp;       // 0: does not apply
  double error;  // of --error; 0: without
  uint64_t seed;
} error_order;

static words words_of(const error_run *r, const error_order *k, arena *mem) {
  words w = {.mem = mem};
  say(&w, "facet", NULL);
  say(&w, "render", NULL);
  pass_options(&w, r->o);
  for (const char *const *f = k->method->flags; *f != NULL; f++)
    say(&w, *f, NULL);
  if (k->method->path) {
    say(&w, "--seed", arena_format(mem, "%llu", (unsigned long long)k->seed));
    if (k->error > 0)
      say(&w, "--error", arena_format(mem, "%.9g", k->error));
    else
      say(&w, "--spp", arena_format(mem, "%d", k->spp));
  }
  say(&w, "--json", NULL);
  say(&w, "--quiet", NULL);
  say(&w, "--output", r->folder.picture);
  say(&w, "--", NULL);
  say(&w, r->o->operands[0], NULL);
  return w;
}

// Make one picture in mem; an exit code.
static int make_picture(child_run *run, image *out, const error_run *r,
                        const error_order *k, arena *mem) {
  error err;
  words w = words_of(r, k, mem);
  if (!child_run_facet(run, w.word, &r->folder, mem, &err))
    return cmd_fail(r->o, EXIT_RESOURCES, "%s", err.text);
  // It has said itself what went wrong.
  if (run->code != EXIT_DONE) return run->code;
  if (!picture_read_linear(out, r->folder.picture, mem, NULL, &err))
    return cmd_fail(r->o, EXIT_RESOURCES, "%s", err.text);
  return EXIT_DONE;
}

static double number_of(const child_run *run, const char *key) {
  double x;
  return child_number(run, key, &x) ? x : (double)NAN;
}

// Measure a picture against the reference; an exit code.
static int measure_order(error_sample *out, const error_run *r,
                         const error_order *k) {
  arena once = {0};
  child_run run;
  image im;
  int code = make_picture(&run, &im, r, k, &once);
  const image *ref = &r->reference;
  if (code == EXIT_DONE && (im.width != ref->width || im.height != ref->height))
    code = cmd_fail(r->o, EXIT_USAGE,
                    "the pictures are %dx%d, the reference is %dx%d", im.width,
                    im.height, ref->width, ref->height);
  if (code == EXIT_DONE) {
    metric m = metric_compare(&im, ref, &once);
    *out = (error_sample){.seed = k->seed,
                          .whole = run.seconds,
                          .render = number_of(&run, "\"render\""),
                          .mse = m.mse,
                          .relmse = m.relmse,
                          .estimate = number_of(&run, "\"error\"")};
  }
  arena_free(&once);
  return code;
}

// Read the reference, or render one; an exit code.
static int get_reference(error_run *r, int most_spp, uint64_t seed) {
  const option_value *v = &r->o->value[OPT_REFERENCE];
  error err;
  r->reference_estimate = (double)NAN;
  if (v->given) {
    if (picture_read_linear(&r->reference, v->text, r->mem, NULL, &err))
      return EXIT_DONE;
    return cmd_fail(r->o, EXIT_INPUT, "%s", err.text);
  }
  r->reference_spp = most_spp * REFERENCE_FACTOR;
  error_order k = {&error_methods[METHOD_PATH], r->reference_spp, 0,
                   seed + REFERENCE_SEED};
  child_run run;
  int code = make_picture(&run, &r->reference, r, &k, r->mem);
  if (code == EXIT_DONE) r->reference_estimate = number_of(&run, "\"error\"");
  return code;
}

// The points to measure: methods by the list, each at every number of samples
// that it can have.  Returns the largest such number.
static int plan_points(error_run *r) {
  const option_value *spps = &r->o->value[OPT_SPPS];
  unsigned chosen = r->o->value[OPT_METHODS].words, n = 0;
  int spp, most = 1;
  while (option_whole(spps, n, &spp)) {
    if (spp > most) most = spp;
    n++;
  }
  r->points = ARENA_NEW(r->mem, error_point, 32 * (size_t)n);
  for (unsigned m = 0; m < 32; m++) {
    if ((chosen >> m & 1) == 0) continue;
    const error_method *method = &error_methods[m];
    for (unsigned i = 0; i < (method->path ? n : 1); i++) {
      error_point *p = &r->points[r->count++];
      p->method = method;
      if (method->path) option_whole(spps, i, &p->spp);
      p->sample = ARENA_NEW(r->mem, error_sample, r->runs);
    }
  }
  return most;
}

// The error that path estimates for that number of samples; 0: not measured.
static double path_estimate(const error_run *r, int spp) {
  for (size_t i = 0; i < r->count; i++) {
    const error_point *p = &r->points[i];
    if (p->method == &error_methods[METHOD_PATH] && p->spp == spp)
      return error_point_mean(r, p).estimate;
  }
  return 0;
}

int error_run_all(error_run *r) {
  r->runs = (size_t)r->o->value[OPT_RUNS].whole[0];
  uint64_t seed = (uint64_t)r->o->value[OPT_SEED].whole[0];
  int most = plan_points(r);
  unsigned chosen = r->o->value[OPT_METHODS].words;
  if ((chosen >> METHOD_ADAPTIVE & 1) != 0 && (chosen >> METHOD_PATH & 1) == 0)
    return cmd_fail(r->o, EXIT_USAGE,
                    "--methods adaptive needs path beside it, whose errors it "
                    "is to reach");
  int code = get_reference(r, most, seed);
  for (size_t i = 0; i < r->count; i++) {
    error_point *p = &r->points[i];
    error_order k = {.method = p->method, .spp = p->spp};
    if (p->method->adaptive) k.error = path_estimate(r, p->spp);
    for (size_t n = 0; n < r->runs && code == EXIT_DONE; n++) {
      k.seed = seed + n;
      code = measure_order(&p->sample[n], r, &k);
    }
  }
  return code;
}

error_mean error_point_mean(const error_run *r, const error_point *p) {
  arena scratch = {0};
  double *whole = ARENA_NEW(&scratch, double, r->runs);
  double *render = ARENA_NEW(&scratch, double, r->runs);
  error_mean m = {.low = (double)INFINITY};
  for (size_t i = 0; i < r->runs; i++) {
    const error_sample *s = &p->sample[i];
    whole[i] = s->whole, render[i] = s->render;
    m.mse += s->mse, m.relmse += s->relmse;
    m.estimate += s->estimate * s->estimate;
    m.low = fmin(m.low, sqrt(s->relmse));
    m.high = fmax(m.high, sqrt(s->relmse));
  }
  double n = (double)r->runs;
  m.whole = cmd_median(whole, r->runs), m.render = cmd_median(render, r->runs);
  m.mse /= n, m.relmse /= n;
  m.estimate = sqrt(m.estimate / n);
  m.error = sqrt(m.relmse);
  arena_free(&scratch);
  return m;
}
