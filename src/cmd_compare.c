// cmd_compare.c — facet compare: how far A is from the reference B.

#include "cmd_shared.h"

#include "file.h"
#include "metric.h"
#include "pfm.h"
#include "picture.h"

#include <float.h>
#include <math.h>
#include <string.h>

// The pictures to compare, in one unit: linear light, or stored numbers.
typedef struct comparison {
  const options *o;
  arena *mem;
  image a, b;
  bool is_linear;
  metric m;
} comparison;

// The rule of --metric, as a number and whether small is good.
typedef struct criterion {
  const char *name;
  double value, limit;
  bool good;
} criterion;

// Read a picture.  A PFM is taken as it stands: repairing its NaNs, as
// picture_read does for light, would hide what a comparison must find.
static bool read_side(picture *out, const comparison *c, const char *path,
                      error *err) {
  FILE *f = file_open(path, err);
  if (f == NULL) return false;
  unsigned char head[32];
  size_t n = fread(head, 1, sizeof head, f);
  rewind(f);
  bool raw = picture_sniff(head, n) == PICTURE_PFM;
  picture p = {.is_linear = true};
  bool ok = raw && pfm_load(&p.linear, f, path, c->mem, err);
  fclose(f);
  if (raw && ok) *out = p;
  return raw ? ok : picture_read(out, path, c->mem, NULL, err);
}

// Bring both sides to one unit.
static void bring_together(comparison *c, const picture *a, const picture *b) {
  c->is_linear = a->is_linear || b->is_linear;
  c->a = a->is_linear ? a->linear
                      : image_from_pixmap(c->mem, &a->stored, c->is_linear);
  c->b = b->is_linear ? b->linear
                      : image_from_pixmap(c->mem, &b->stored, c->is_linear);
}

// What --metric and --fail make of the numbers.  A larger PSNR is better; not
// a number is never good.
static criterion decide(const options *o, const metric *m) {
  const double values[] = {m->rmse,   m->mae, m->psnr,
                           m->relmse, m->max, m->p999};
  const char *const names[] = {"rmse", "mae", "psnr", "relmse", "max", "p99.9"};
  unsigned which = o->value[OPT_METRIC].words;
  const option_value *limit = &o->value[OPT_FAIL];
  bool psnr = which == 2;
  criterion c = {.name = names[which], .value = values[which]};
  c.limit = psnr ? (double)INFINITY : 0;
  if (limit->given) c.limit = (double)limit->number[0];
  c.good = psnr ? c.value >= c.limit : c.value <= c.limit;
  return c;
}

// Write |a - b| times a power of two, chosen so that the largest difference is
// bright: at least half of white, unless it already is.  The PNG's codes are
// proportional to the difference, therefore the sRGB curve is undone first.
static bool write_difference(const comparison *c, double *gain, error *err) {
  *gain = 1;
  while (c->m.max > 0 && c->m.max * *gain < 0.5 && *gain < 0x1p30)
    *gain *= 2;
  image d = image_new(c->mem, c->a.width, c->a.height);
  size_t n = (size_t)d.width * (size_t)d.height;
  float g = (float)*gain;
  for (size_t i = 0; i < n; i++) {
    vec3 x = vec3_scale(vec3_abs(vec3_sub(c->a.pixels[i], c->b.pixels[i])), g);
    x = vec3_min(x, vec3_all(1));
    d.pixels[i] =
        (vec3){(float)srgb_decode((double)x.x), (float)srgb_decode((double)x.y),
               (float)srgb_decode((double)x.z)};
  }
  return picture_write(&d, c->o->value[OPT_DIFF].text, PICTURE_PNG, 8, err);
}

// A z-test of every channel of every pixel.
typedef struct z_test {
  bool asked, good;
  long pixels, passed;
  double level;   // of one comparison, so that all together have 1 %
  double mean_z;  // over all channels; near 0 without bias
} z_test;

// The share of pixels that must pass.  Source: the acceptance rule of Mitsuba
// 3's render tests.
#define Z_SHARE 0.9975

// The z of one channel: the difference over its standard deviation.  The files
// hold floats, whose rounding counts as noise, too: where a pixel has no other,
// the last bit of a picture would decide.
static double z_of(double a, double b, double variance) {
  double rounding = (double)FLT_EPSILON * fmax(fabs(a), fabs(b));
  double d = a - b;
  return d == 0 ? 0 : d / sqrt(variance + rounding * rounding);
}

// Test a against b, given the variances of both pictures' pixels.  Sidak's
// correction: among n comparisons the least likely is that unlikely by chance.
static z_test z_test_of(const comparison *c, const image *va, const image *vb) {
  size_t n = (size_t)c->a.width * (size_t)c->a.height;
  z_test t = {.asked = true, .pixels = (long)n};
  t.level = -expm1(log1p(-0.01) / (double)(3 * n));
  double sum = 0;
  for (size_t i = 0; i < n; i++) {
    bool pass = true;
    for (int k = 0; k < 3; k++) {
      double v = (double)(&va->pixels[i].x)[k] + (double)(&vb->pixels[i].x)[k];
      double z = z_of((double)(&c->a.pixels[i].x)[k],
                      (double)(&c->b.pixels[i].x)[k], v);
      sum += z;
      if (!(erfc(fabs(z) / sqrt(2)) >= t.level)) pass = false;
    }
    t.passed += pass;
  }
  t.mean_z = sum / (double)(3 * n);
  t.good = (double)t.passed >= Z_SHARE * (double)t.pixels;
  return t;
}

// Read the variances and test.  A's variance lies beside A where --aov
// variance left it; else A is taken to be as noisy as B.
static bool run_z_test(z_test *out, const comparison *c, error *err) {
  const char *path = c->o->value[OPT_Z_TEST].text;
  picture vb, va;
  if (!read_side(&vb, c, path, err)) return false;
  const char *beside = cmd_beside(c->mem, c->o->operands[0], ".variance.pfm");
  error ignored;
  if (strcmp(beside, path) == 0 || !read_side(&va, c, beside, &ignored))
    va = vb;
  if (!vb.is_linear || !va.is_linear)
    return fail(err, "%s: not a PFM of variances", path);
  if (vb.linear.width != c->a.width || vb.linear.height != c->a.height ||
      va.linear.width != c->a.width || va.linear.height != c->a.height)
    return fail(err, "%s: variances of another size than the picture", path);
  *out = z_test_of(c, &va.linear, &vb.linear);
  return true;
}

// Everything as one JSON object.
static void print_json(const comparison *c, const criterion *k, const z_test *z,
                       double gain) {
  json j = {.out = stdout};
  const metric *m = &c->m;
  json_open(&j, NULL, '{');
  json_text(&j, "unit", c->is_linear ? "linear" : "stored");
  json_number(&j, "rmse", m->rmse);
  json_number(&j, "mae", m->mae);
  json_number(&j, "psnr", m->psnr);
  json_number(&j, "mse", m->mse);
  json_number(&j, "relmse", m->relmse);
  json_number(&j, "max", m->max);
  json_number(&j, "p99.9", m->p999);
  json_number(&j, "mean", m->mean);
  json_open(&j, "worst", '[');
  json_count(&j, NULL, (unsigned long long)m->worst_x);
  json_count(&j, NULL, (unsigned long long)m->worst_y);
  json_close(&j, '[');
  json_count(&j, "differing", (unsigned long long)m->differing);
  if (gain > 0) json_number(&j, "diff_gain", gain);
  if (z->asked) {
    json_number(&j, "z_passed", (double)z->passed / (double)z->pixels);
    json_number(&j, "z_mean", z->mean_z);
  }
  json_text(&j, "metric", z->asked ? "z-test" : k->name);
  json_number(&j, "limit", z->asked ? Z_SHARE : k->limit);
  json_flag(&j, "equal", z->asked ? z->good : k->good);
  json_close(&j, '{');
  json_end(&j);
}

// The same for people; the verdict is the last line.
static void print_text(const comparison *c, const criterion *k, const z_test *z,
                       double gain) {
  const metric *m = &c->m;
  const vec3 *a = &c->a.pixels[(size_t)m->worst_y * (size_t)c->a.width +
                               (size_t)m->worst_x];
  const vec3 *b = &c->b.pixels[a - c->a.pixels];
  printf("unit    %s\n",
         c->is_linear ? "linear light" : "stored values, 1 is full scale");
  printf("rmse    %.6g\nmae     %.6g\npsnr    %.4f dB\nrelmse  %.6g\n", m->rmse,
         m->mae, m->psnr, m->relmse);
  printf("max     %.6g at %d,%d: %g %g %g against %g %g %g\n", m->max,
         m->worst_x, m->worst_y, (double)a->x, (double)a->y, (double)a->z,
         (double)b->x, (double)b->y, (double)b->z);
  printf("p99.9   %.6g\nmean    %+.6g (A - B)\ndiffer  %ld of %ld pixels\n",
         m->p999, m->mean, m->differing, (long)c->a.width * c->a.height);
  if (gain > 0)
    printf("diff    %s, |A - B| times %g\n", c->o->value[OPT_DIFF].text, gain);
  if (z->asked) {
    printf("z-test  %.4f %% of pixels pass, mean z %+.4f\n",
           100 * (double)z->passed / (double)z->pixels, z->mean_z);
    printf("%s: %.4f %% of pixels pass, %.4f %% asked\n",
           z->good ? "equal" : "DIFFERENT",
           100 * (double)z->passed / (double)z->pixels, 100 * Z_SHARE);
    return;
  }
  printf("%s: %s %.6g, limit %.6g\n", k->good ? "equal" : "DIFFERENT", k->name,
         k->value, k->limit);
}

// Compare what has been read.
static int judge(comparison *c) {
  const options *o = c->o;
  error err;
  c->m = metric_compare(&c->a, &c->b, c->mem);
  if (c->m.non_finite)
    return cmd_fail(o, EXIT_NO, "%s: pixel %d,%d is not a finite number",
                    o->operands[c->m.bad_in_b], c->m.bad_x, c->m.bad_y);
  z_test z = {0};
  if (o->value[OPT_Z_TEST].given && !run_z_test(&z, c, &err))
    return cmd_fail(o, EXIT_INPUT, "%s", err.text);
  double gain = 0;
  if (o->value[OPT_DIFF].given && !write_difference(c, &gain, &err))
    return cmd_fail(o, EXIT_OUTPUT, "%s", err.text);
  criterion k = decide(o, &c->m);
  if (o->value[OPT_JSON].given)
    print_json(c, &k, &z, gain);
  else if (!o->value[OPT_QUIET].given)
    print_text(c, &k, &z, gain);
  return (z.asked ? z.good : k.good) ? EXIT_DONE : EXIT_NO;
}

int cmd_compare(const options *o) {
  const char *diff = o->value[OPT_DIFF].text;
  if (diff != NULL && picture_format_of(diff) != PICTURE_PNG)
    return cmd_fail(o, EXIT_USAGE, "--diff %s: expected a .png", diff);
  arena mem = {0};
  comparison c = {.o = o, .mem = &mem};
  picture a, b;
  error err;
  int code;
  if (!read_side(&a, &c, o->operands[0], &err) ||
      !read_side(&b, &c, o->operands[1], &err)) {
    code = cmd_fail(o, EXIT_INPUT, "%s", err.text);
  } else {
    bring_together(&c, &a, &b);
    if (c.a.width != c.b.width || c.a.height != c.b.height)
      code = cmd_fail(o, EXIT_USAGE, "sizes differ: %s is %dx%d, %s is %dx%d",
                      o->operands[0], c.a.width, c.a.height, o->operands[1],
                      c.b.width, c.b.height);
    else
      code = judge(&c);
  }
  arena_free(&mem);
  return code;
}
