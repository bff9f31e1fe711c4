// cmd_bench_error.c — facet bench error: run time against error.

#include "cmd_error_run.h"

#include "file.h"
#include "picture.h"
#include "plot.h"

#include <math.h>

// The number that stands for the samples of a method without any.
static const char *spp_text(arena *mem, const error_point *p) {
  return p->spp > 0 ? arena_format(mem, "%d", p->spp) : "-";
}

// For people.
static void print_error_table(const error_run *r) {
  const options *o = r->o;
  printf("%s: %dx%d, mean of %zu\n", o->operands[0], r->reference.width,
         r->reference.height, r->runs);
  if (r->reference_spp > 0)
    printf("reference: path, %d spp, estimated error %.3g\n", r->reference_spp,
           r->reference_estimate);
  else
    printf("reference: %s\n", o->value[OPT_REFERENCE].text);
  printf("%-12s %6s %9s %9s %10s %10s %9s %9s\n", "method", "spp", "process s",
         "render s", "MSE", "relMSE", "error", "estimate");
  for (size_t i = 0; i < r->count; i++) {
    const error_point *p = &r->points[i];
    error_mean m = error_point_mean(r, p);
    printf("%-12s %6s %9.3f %9.3f %10.3g %10.3g %9.4g ", p->method->name,
           spp_text(r->mem, p), m.whole, m.render, m.mse, m.relmse, m.error);
    if (isfinite(m.estimate))
      printf("%9.4g\n", m.estimate);
    else
      printf("%9s\n", "-");
  }
}

// For spreadsheets: a line for each picture.
static void print_error_csv(const error_run *r) {
  puts("method,spp,seed,seconds_total,seconds_render,mse,relmse,error,"
       "estimated_error");
  for (size_t i = 0; i < r->count; i++)
    for (size_t n = 0; n < r->runs; n++) {
      const error_point *p = &r->points[i];
      const error_sample *s = &p->sample[n];
      printf("%s,%d,%llu,%.9g,%.9g,%.9g,%.9g,%.9g,", p->method->name, p->spp,
             (unsigned long long)s->seed, s->whole, s->render, s->mse,
             s->relmse, sqrt(s->relmse));
      if (isfinite(s->estimate)) printf("%.9g", s->estimate);
      putchar('\n');
    }
}

static void json_sample(json *j, const error_sample *s) {
  json_open(j, NULL, '{');
  json_count(j, "seed", s->seed);
  json_open(j, "seconds", '{');
  json_number(j, "total", s->whole);
  json_number(j, "render", s->render);
  json_close(j, '{');
  json_number(j, "mse", s->mse);
  json_number(j, "relmse", s->relmse);
  json_number(j, "error", sqrt(s->relmse));
  json_number(j, "estimated_error", s->estimate);
  json_close(j, '{');
}

static void json_point(json *j, const error_run *r, const error_point *p) {
  error_mean m = error_point_mean(r, p);
  json_open(j, NULL, '{');
  json_text(j, "method", p->method->name);
  json_text(j, "engine", p->method->path ? "path" : "raster");
  json_count(j, "spp", (unsigned long long)p->spp);
  json_open(j, "seconds", '{');
  json_number(j, "total", m.whole);
  json_number(j, "render", m.render);
  json_close(j, '{');
  json_number(j, "mse", m.mse);
  json_number(j, "relmse", m.relmse);
  json_number(j, "error", m.error);
  json_number(j, "estimated_error", m.estimate);
  json_open(j, "runs", '[');
  for (size_t n = 0; n < r->runs; n++)
    json_sample(j, &p->sample[n]);
  json_close(j, '[');
  json_close(j, '{');
}

// For programs.
static void print_error_json(const error_run *r) {
  json j = {.out = stdout};
  json_open(&j, NULL, '{');
  json_text(&j, "file", r->o->operands[0]);
  json_count(&j, "width", (unsigned long long)r->reference.width);
  json_count(&j, "height", (unsigned long long)r->reference.height);
  json_count(&j, "repeat", r->runs);
  json_open(&j, "reference", '{');
  json_text(&j, "file", r->o->value[OPT_REFERENCE].text);
  json_count(&j, "spp", (unsigned long long)r->reference_spp);
  json_number(&j, "estimated_error", r->reference_estimate);
  json_close(&j, '{');
  json_open(&j, "points", '[');
  for (size_t i = 0; i < r->count; i++)
    json_point(&j, r, &r->points[i]);
  json_close(&j, '[');
  json_close(&j, '{');
  json_end(&j);
}

// The points of one method from points[at] on, as a series; how many.
static size_t series_of(plot_series *s, const error_run *r, size_t at) {
  const error_method *method = r->points[at].method;
  size_t n = 0;
  while (at + n < r->count && r->points[at + n].method == method)
    n++;
  double *v = ARENA_NEW(r->mem, double, 4 * n);
  *s = (plot_series){.name = method->name,
                     .mark = method->path ? PLOT_DISC : PLOT_DIAMOND,
                     .n = n,
                     .x = v,
                     .y = v + n};
  for (size_t i = 0; i < n; i++) {
    error_mean m = error_point_mean(r, &r->points[at + i]);
    v[i] = m.whole, v[n + i] = m.error;
    v[2 * n + i] = m.low, v[3 * n + i] = m.high;
  }
  if (r->runs > 1) s->low = v + 2 * n, s->high = v + 3 * n;
  return n;
}

static sketch sketch_errors(const error_run *r) {
  plot_series *series = ARENA_NEW(r->mem, plot_series, r->count);
  size_t count = 0;
  for (size_t i = 0; i < r->count; count++) {
    i += series_of(&series[count], r, i);
    series[count].color = plot_color(count);
  }
  plot p = {.width = 640,
            .height = 420,
            .title = r->o->operands[0],
            .x = {.label = "seconds (whole process)", .log = true},
            .y = {.label = "relative error", .log = true},
            .series = series,
            .count = count};
  return plot_sketch(&p, r->mem);
}

static bool write_svg(const sketch *s, const char *path, arena *mem,
                      error *err) {
  file_writer w;
  if (!file_create(&w, path, mem, err)) return false;
  sketch_svg(s, w.stream);
  if (!ferror(w.stream)) return file_commit(&w, err);
  file_discard(&w);
  return fail(err, "%s: cannot be written", path);
}

// Draw the plot; an exit code.
static int write_plot(const error_run *r) {
  const char *path = r->o->value[OPT_OUTPUT].text;
  if (path == NULL) return EXIT_DONE;
  error err;
  sketch s = sketch_errors(r);
  image im = sketch_image(&s, r->mem);
  bool ok = cmd_has_suffix(path, ".svg")
                ? write_svg(&s, path, r->mem, &err)
                : picture_write(&im, path, PICTURE_PNG, 8, &err);
  return ok ? EXIT_DONE : cmd_fail(r->o, EXIT_OUTPUT, "%s", err.text);
}

int cmd_bench_error(const options *o) {
  const char *plot_path = o->value[OPT_OUTPUT].text;
  if (plot_path != NULL && !cmd_has_suffix(plot_path, ".png") &&
      !cmd_has_suffix(plot_path, ".svg"))
    return cmd_fail(o, EXIT_USAGE, "%s: a plot is a .png or an .svg",
                    plot_path);
  arena mem = {0};
  error err;
  error_run r = {.o = o, .mem = &mem};
  int code = EXIT_DONE;
  if (!child_folder_make(&r.folder, &mem, &err))
    code = cmd_fail(o, EXIT_OUTPUT, "%s", err.text);
  if (code == EXIT_DONE) {
    code = error_run_all(&r);
    child_folder_remove(&r.folder);
  }
  if (code == EXIT_DONE) {
    if (o->value[OPT_JSON].given)
      print_error_json(&r);
    else if (o->value[OPT_CSV].given)
      print_error_csv(&r);
    else
      print_error_table(&r);
    code = write_plot(&r);
  }
  arena_free(&mem);
  return code;
}
