// cmd_bench_raster.c — facet bench raster: frames, one after another.

#include "cmd_raster.h"

#include "clock.h"

#include <stddef.h>

// What one frame costs by pass, in milliseconds of processors at work: the
// median of some frames, each finished before the next.
typedef struct pass_times {
  double shadow;   // to draw all shadow maps again
  double surface;  // the surfaces
  double sky;      // what the sky adds to that
  double resolve;  // the samples of each pixel, to one colour
  double read;     // the picture, back to where files are written from
} pass_times;

// One line of the table.
typedef struct bench_line {
  int width, height;
  double seconds, work;  // for all frames: by the clock, and of processors
  pass_times passes;
} bench_line;

typedef struct bench_raster {
  shot shot;
  raster_job job;
  long long frames;
  size_t repeat;
  double *samples;  // repeat of them
} bench_raster;

// The frames of the table: none waits for the one before it.
static bool draw_frames(bench_raster *b, bench_line *line, error *err) {
  double start = clock_seconds(), work = clock_work();
  for (long long k = 0; k < b->frames; k++)
    if (!raster_draw_next(b->job.r, &b->shot.view, err)) return false;
  raster_wait(b->job.r);
  line->seconds = clock_seconds() - start;
  line->work = clock_work() - work;
  return true;
}

// Draw `repeat` frames and store the median of their work.  With `again` the
// shadow maps are drawn for each frame.
static bool measure(double *ms, bench_raster *b, bool again, error *err) {
  for (size_t k = 0; k < b->repeat; k++) {
    if (again) {
      raster_hide(b->job.r, 0, true);
      raster_hide(b->job.r, 0, false);
    }
    double start = clock_work();
    if (!raster_draw(b->job.r, &b->shot.view, err)) return false;
    b->samples[k] = clock_work() - start;
  }
  *ms = 1000 * cmd_median(b->samples, b->repeat);
  return true;
}

// The median work of `repeat` times some call that is not a frame.
static double measure_call(bench_raster *b, void (*call)(raster *r)) {
  for (size_t k = 0; k < b->repeat; k++) {
    double start = clock_work();
    call(b->job.r);
    b->samples[k] = clock_work() - start;
  }
  return 1000 * cmd_median(b->samples, b->repeat);
}

static void resolve_frame(raster *r) {
  (void)raster_resolve_seconds(r);
}

static void read_frame(raster *r) {
  arena once = {0};
  raster_read(r, &once);
  arena_free(&once);
}

// The passes, by what a frame takes with and without them.
static bool measure_passes(bench_raster *b, pass_times *p, error *err) {
  raster_settings with_sky = b->job.settings;
  with_sky.sky = true;
  double all, with;
  if (!measure(&all, b, true, err)) return false;
  bool shadows = raster_last_times(b->job.r).shadow > 0;
  if (!measure(&p->surface, b, false, err) ||
      !raster_change(b->job.r, &with_sky, err) ||
      !measure(&with, b, false, err) || !measure(&with, b, false, err))
    return false;
  p->shadow = shadows ? all - p->surface : 0;
  p->sky = with - p->surface;
  p->resolve = measure_call(b, resolve_frame);
  p->surface -= p->resolve;
  p->read = measure_call(b, read_frame);
  return true;
}

// One size: everything is made anew.  The first frames bring code generation
// and are not counted.
static int measure_size(bench_raster *b, bench_line *line) {
  error err;
  int code = shot_resize(&b->shot, line->width, line->height);
  if (code != EXIT_DONE) return code;
  arena once = {0};
  double warm;
  b->job.settings = raster_job_settings(&b->shot);
  b->job.settings.sky = false;
  bool ok = raster_job_upload(&b->job, &b->shot, &once, &err) &&
            measure(&warm, b, false, &err) && draw_frames(b, line, &err) &&
            measure_passes(b, &line->passes, &err);
  raster_job_drop(&b->job);
  arena_free(&once);
  return ok ? EXIT_DONE : cmd_fail(b->shot.o, EXIT_RESOURCES, "%s", err.text);
}

// Milliseconds a frame.
static double ms_per_frame(const bench_raster *b, const bench_line *l) {
  return 1000 * l->seconds / (double)b->frames;
}

// The same of processors at work.
static double work_per_frame(const bench_raster *b, const bench_line *l) {
  return 1000 * l->work / (double)b->frames;
}

// A pass by name, and its place in pass_times.
typedef struct pass_name {
  const char *name, *key;
  size_t at;
} pass_name;

static const pass_name pass_names[] = {
    {"shadows", "shadow_ms", offsetof(pass_times, shadow)},
    {"surfaces", "surface_ms", offsetof(pass_times, surface)},
    {"sky", "sky_ms", offsetof(pass_times, sky)},
    {"resolve", "resolve_ms", offsetof(pass_times, resolve)},
    {"read", "read_ms", offsetof(pass_times, read)},
};
enum { PASSES = sizeof pass_names / sizeof *pass_names };

// The milliseconds of one of them.
static double pass_ms(const bench_line *l, int i) {
  return *(const double *)((const char *)&l->passes + pass_names[i].at);
}

// For people.
static void print_frames_table(const bench_raster *b, const bench_line *lines,
                               size_t n) {
  printf("%s: %zu triangles, %s, %s, msaa %d, %lld frames\n",
         b->shot.o->operands[0], b->shot.scene.mesh.triangle_count,
         gl_backend_name(b->job.g), gl_renderer(b->job.g), b->job.settings.msaa,
         b->frames);
  printf("%-10s %9s %9s %9s %9s  ", "", "seconds", "ms/frame", "frames/s",
         "work ms");
  for (int i = 0; i < PASSES; i++)
    printf(" %8s", pass_names[i].name);
  puts(" (ms of work)");
  for (size_t i = 0; i < n; i++) {
    const bench_line *l = &lines[i];
    double ms = ms_per_frame(b, l);
    char size[32];
    snprintf(size, sizeof size, "%dx%d", l->width, l->height);
    printf("%-10s %9.3f %9.3f %9.1f %9.3f  ", size, l->seconds, ms, 1000 / ms,
           work_per_frame(b, l));
    for (int k = 0; k < PASSES; k++)
      printf(" %8.3f", pass_ms(l, k));
    putchar('\n');
  }
}

// For spreadsheets.
static void print_frames_csv(const bench_raster *b, const bench_line *lines,
                             size_t n) {
  fputs("width,height,frames,seconds,ms_per_frame,work_ms", stdout);
  for (int i = 0; i < PASSES; i++)
    printf(",%s", pass_names[i].key);
  putchar('\n');
  for (size_t i = 0; i < n; i++) {
    const bench_line *l = &lines[i];
    printf("%d,%d,%lld,%.9g,%.9g,%.9g", l->width, l->height, b->frames,
           l->seconds, ms_per_frame(b, l), work_per_frame(b, l));
    for (int k = 0; k < PASSES; k++)
      printf(",%.9g", pass_ms(l, k));
    putchar('\n');
  }
}

// For programs.
static void print_frames_json(const bench_raster *b, const bench_line *lines,
                              size_t n) {
  json j = {.out = stdout};
  json_open(&j, NULL, '{');
  json_text(&j, "file", b->shot.o->operands[0]);
  json_count(&j, "triangles", b->shot.scene.mesh.triangle_count);
  json_count(&j, "frames", (unsigned long long)b->frames);
  json_count(&j, "threads", (unsigned long long)pool_threads(b->shot.threads));
  raster_job_json(&j, &b->job);
  json_open(&j, "sizes", '[');
  for (size_t i = 0; i < n; i++) {
    const bench_line *l = &lines[i];
    json_open(&j, NULL, '{');
    json_count(&j, "width", (unsigned long long)l->width);
    json_count(&j, "height", (unsigned long long)l->height);
    json_number(&j, "seconds", l->seconds);
    json_number(&j, "ms_per_frame", ms_per_frame(b, l));
    json_number(&j, "work_ms", work_per_frame(b, l));
    for (int k = 0; k < PASSES; k++)
      json_number(&j, pass_names[k].key, pass_ms(l, k));
    json_close(&j, '{');
  }
  json_close(&j, '[');
  json_close(&j, '{');
  json_end(&j);
}

// Everything once the pool is there.
static int run_bench_raster(bench_raster *b) {
  const options *o = b->shot.o;
  error err;
  int code = shot_read(&b->shot);
  if (code == EXIT_DONE) code = shot_remark(&b->shot);
  if (code != EXIT_DONE) return code;
  if (!raster_job_open(&b->job, o, b->shot.mem, &err))
    return cmd_fail(o, EXIT_RESOURCES, "%s", err.text);
  b->frames = o->value[OPT_FRAMES].whole[0];
  b->repeat = (size_t)o->value[OPT_REPEAT].whole[0];
  b->samples = ARENA_NEW(b->shot.mem, double, b->repeat);
  const option_value *sizes = &o->value[OPT_RESOLUTIONS];
  bench_line line = {0};
  size_t n = 0;
  while (option_size(sizes, (unsigned)n, &line.width, &line.height))
    n++;
  bench_line *lines = ARENA_NEW(b->shot.mem, bench_line, n);
  for (size_t i = 0; i < n && code == EXIT_DONE; i++) {
    option_size(sizes, (unsigned)i, &lines[i].width, &lines[i].height);
    code = measure_size(b, &lines[i]);
  }
  if (code != EXIT_DONE) return code;
  if (o->value[OPT_JSON].given)
    print_frames_json(b, lines, n);
  else if (o->value[OPT_CSV].given)
    print_frames_csv(b, lines, n);
  else
    print_frames_table(b, lines, n);
  return EXIT_DONE;
}

int cmd_bench_raster(const options *o) {
  arena mem = {0};
  bench_raster b = {0};
  b.shot = (shot){.o = o, .mem = &mem, .remarks = {.mem = &mem}};
  b.shot.threads = pool_new(&mem, cmd_threads(o));
  int code = run_bench_raster(&b);
  raster_job_close(&b.job);
  pool_free(b.shot.threads);
  arena_free(&mem);
  return code;
}
