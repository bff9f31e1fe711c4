// cmd_info.c — facet info: what is in a file.

#include "cmd_info_part.h"
#include "cmd_info_scene.h"

#include "file.h"
#include "pfm.h"
#include "picture.h"

#include <math.h>
#include <string.h>

// A picture and the range of its values.
typedef struct picture_facts {
  const char *format, *unit;
  int width, height, channels, depth;
  vec3 lo, hi;
  double mean[3];
  size_t non_finite;  // pixels left out of the range
} picture_facts;

// Range and mean of the pixels that are finite.
static void measure_pixels(picture_facts *f, const image *im) {
  size_t n = (size_t)im->width * (size_t)im->height, counted = 0;
  f->lo = vec3_all(INFINITY), f->hi = vec3_all(-INFINITY);
  for (size_t i = 0; i < n; i++) {
    vec3 p = im->pixels[i];
    if (!vec3_finite(p)) continue;
    f->lo = vec3_min(f->lo, p), f->hi = vec3_max(f->hi, p);
    f->mean[0] += (double)p.x;
    f->mean[1] += (double)p.y;
    f->mean[2] += (double)p.z;
    counted++;
  }
  f->non_finite = n - counted;
  for (int k = 0; k < 3; k++)
    f->mean[k] /= counted > 0 ? (double)counted : 1;
}

// Read a picture and measure it; a PFM as it stands, with what is not finite.
static bool read_picture_facts(picture_facts *f, const char *path, arena *mem,
                               error *err) {
  FILE *file = file_open(path, err);
  if (file == NULL) return false;
  unsigned char head[32];
  size_t n = fread(head, 1, sizeof head, file);
  rewind(file);
  picture_format format = picture_sniff(head, n);
  picture p = {.is_linear = true};
  bool ok = true;
  if (format == PICTURE_PFM) ok = pfm_load(&p.linear, file, path, mem, err);
  fclose(file);
  if (format == PICTURE_UNKNOWN)
    return fail(err, "%s: neither .obj nor .scene by its name, nor a picture",
                path);
  if (format != PICTURE_PFM) ok = picture_read(&p, path, mem, NULL, err);
  if (!ok) return false;
  static const char *const names[] = {"", "PNG", "PFM", "HDR", "JPEG", "TGA"};
  image im = p.is_linear ? p.linear : image_from_pixmap(mem, &p.stored, false);
  *f = (picture_facts){.format = names[format],
                       .unit = p.is_linear ? "linear" : "stored",
                       .width = im.width,
                       .height = im.height,
                       .channels = p.is_linear ? 3 : p.stored.channels,
                       .depth = p.is_linear ? 32 : p.stored.depth};
  measure_pixels(f, &im);
  return true;
}

static void json_floats(json *j, const char *key, vec3 v) {
  json_open(j, key, '[');
  json_float(j, NULL, v.x);
  json_float(j, NULL, v.y);
  json_float(j, NULL, v.z);
  json_close(j, '[');
}

static void print_json_picture(const picture_facts *f, const char *path) {
  json j = {.out = stdout};
  json_open(&j, NULL, '{');
  json_text(&j, "file", path);
  json_text(&j, "format", f->format);
  json_count(&j, "width", (unsigned long long)f->width);
  json_count(&j, "height", (unsigned long long)f->height);
  json_count(&j, "channels", (unsigned long long)f->channels);
  json_count(&j, "depth", (unsigned long long)f->depth);
  json_text(&j, "unit", f->unit);
  json_floats(&j, "min", f->lo);
  json_floats(&j, "max", f->hi);
  json_open(&j, "mean", '[');
  for (int k = 0; k < 3; k++)
    json_number(&j, NULL, f->mean[k]);
  json_close(&j, '[');
  json_count(&j, "non_finite", f->non_finite);
  json_close(&j, '{');
  json_end(&j);
}

static void print_text_picture(const picture_facts *f, const char *path) {
  printf("%s\n%s, %d x %d, %d channels of %d bits, values %s\n", path,
         f->format, f->width, f->height, f->channels, f->depth,
         strcmp(f->unit, "linear") == 0 ? "linear"
                                        : "as stored, 1 is full scale");
  printf("min  %g %g %g\n", (double)f->lo.x, (double)f->lo.y, (double)f->lo.z);
  printf("max  %g %g %g\n", (double)f->hi.x, (double)f->hi.y, (double)f->hi.z);
  printf("mean %g %g %g\n", f->mean[0], f->mean[1], f->mean[2]);
  if (f->non_finite > 0) printf("%zu pixels are not finite\n", f->non_finite);
}

// Say what a picture holds.
static int info_picture(const options *o, const char *path) {
  arena mem = {0};
  picture_facts f = {0};
  error err;
  int code = EXIT_DONE;
  if (!read_picture_facts(&f, path, &mem, &err))
    code = cmd_fail(o, EXIT_INPUT, "%s", err.text);
  else if (o->value[OPT_JSON].given)
    print_json_picture(&f, path);
  else
    print_text_picture(&f, path);
  arena_free(&mem);
  return code;
}

int cmd_info(const options *o) {
  int code = EXIT_DONE;
  for (int i = 0; i < o->operand_count; i++) {
    const char *path = o->operands[i];
    bool mesh = strcmp(path, "-") == 0 || cmd_has_suffix(path, ".obj") ||
                cmd_has_suffix(path, ".scene");
    int now = mesh                            ? info_scene(o, path)
              : cmd_has_suffix(path, ".part") ? info_part(o, path)
                                              : info_picture(o, path);
    if (now != EXIT_DONE) code = now;
  }
  return code;
}
