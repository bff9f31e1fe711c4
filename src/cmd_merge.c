// cmd_merge.c — facet merge: from parts to a picture.

#include "cmd_output.h"

#include "clock.h"
#include "halves.h"
#include "part_set.h"

#include <string.h>

typedef struct merge_job {
  const options *o;
  output out;
  part_set set;
  part whole;
  halves halves;
  render_guide guide;  // of a picture in halves
  render_result result;
  arena *mem;
} merge_job;

static vec3 mean_of_halves(const void *self, size_t i) {
  return halves_mean(self, i);
}

static vec3 variance_of_halves(const void *self, size_t i) {
  return halves_variance(self, i);
}

// Print what does not fit; an exit code.
static int check_set(const merge_job *j) {
  report why = {.mem = j->mem};
  if (part_set_fits(&j->set, &why)) return EXIT_DONE;
  for (const report_line *l = why.first; l != NULL; l = l->next)
    cmd_fail(j->o, EXIT_NO, "%s", l->text);
  if (why.warnings > why.stored)
    cmd_fail(j->o, EXIT_NO, "and %d more", why.warnings - why.stored);
  return EXIT_NO;
}

// Where the picture goes; an exit code.
static int plan_output(merge_job *j) {
  if (j->o->value[OPT_OUTPUT].text == NULL)
    return cmd_fail(j->o, EXIT_USAGE, "merge needs -o FILE");
  int code = output_plan(&j->out, j->o, j->mem);
  if (code != EXIT_DONE) return code;
  for (size_t i = 0; i < j->set.count; i++)
    if (output_overwrites(&j->out, j->set.paths[i]) != NULL)
      return cmd_fail(j->o, EXIT_USAGE, "%s: is an input; write somewhere else",
                      j->out.path);
  return EXIT_DONE;
}

// What the parts say of the picture and its companions.
static void adopt_facts(merge_job *j) {
  const part *p = &j->set.parts[0];
  report remarks = {.mem = j->mem};
  bool given = j->o->value[OPT_EXPOSURE].given;
  j->out.radiance = p->radiance;
  j->out.exposure = given ? j->o->value[OPT_EXPOSURE].number[0] : p->exposure;
  j->out.pane.x0 = p->window.x0, j->out.pane.y0 = p->window.y0;
  if (strcmp(j->out.path, "-") != 0 && !j->out.part)
    output_name_aovs(&j->out, p->aovs, j->mem);
  else if (p->aovs != 0 && !j->out.part)
    report_warn(&remarks, "AOVs need the name of a file and are left out");
  output_warn(&j->out, &remarks);
  cmd_remarks(j->o, &remarks);
}

// The images that the sums make.
static void develop(merge_job *j) {
  part *p = &j->whole;
  film *f = p->film;
  bool in_halves = f[PART_EVEN].sum != NULL;
  if (in_halves) {
    f[PART_COLOR] = film_new(j->mem, part_width(p), part_height(p), false);
    size_t n = (size_t)part_width(p) * (size_t)part_height(p);
    for (size_t i = 0; i < n; i++)
      f[PART_COLOR].count[i] = f[PART_EVEN].count[i] + f[PART_ODD].count[i];
    j->halves = (halves){{f[PART_EVEN], f[PART_ODD]}};
    j->guide = (render_guide){.self = &j->halves,
                              .mean = mean_of_halves,
                              .variance = variance_of_halves};
  }
  render_sums sums = {.color = f[PART_COLOR],
                      .normal = f[PART_NORMAL],
                      .depth = f[PART_DEPTH],
                      .albedo = f[PART_ALBEDO],
                      .tally = p->tally};
  render_sums_images(&j->result, &sums, p->aovs, in_halves ? &j->guide : NULL,
                     j->mem);
  render_sums_counts(&j->result, &sums, p->width);
}

static bool write_whole(merge_job *j, error *err) {
  if (j->out.part) return part_write(&j->whole, j->out.path, err);
  develop(j);
  return output_write(&j->out, &j->result, j->mem, err);
}

static void say(const merge_job *j) {
  const tally *t = &j->whole.tally;
  const part *p = &j->whole;
  if (j->o->value[OPT_QUIET].given) return;
  if (t->non_finite > 0)
    fprintf(stderr, "%llu samples were not finite and are left out\n",
            (unsigned long long)t->non_finite);
  fprintf(stderr, "%s: %dx%d, %zu parts, %.2f s\n",
          strcmp(j->out.path, "-") == 0 ? "standard output" : j->out.path,
          part_width(p), part_height(p), j->set.count,
          clock_seconds() - j->o->started);
}

static int run_merge(merge_job *j) {
  error err;
  int code = plan_output(j);
  if (code != EXIT_DONE) return code;
  if (!part_set_read(&j->set, j->set.paths, j->set.count, j->mem, &err))
    return cmd_fail(j->o, EXIT_INPUT, "%s", err.text);
  if ((code = check_set(j)) != EXIT_DONE) return code;
  adopt_facts(j);
  if (!part_set_join(&j->whole, &j->set, j->mem, &err))
    return cmd_fail(j->o, EXIT_INPUT, "%s", err.text);
  if (!write_whole(j, &err)) return cmd_fail(j->o, EXIT_OUTPUT, "%s", err.text);
  say(j);
  return EXIT_DONE;
}

int cmd_merge(const options *o) {
  arena mem = {0};
  merge_job j = {.o = o, .mem = &mem};
  j.set.paths = o->operands;
  j.set.count = (size_t)o->operand_count;
  int code = run_merge(&j);
  arena_free(&mem);
  return code;
}
