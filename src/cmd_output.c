// cmd_output.c

#include "cmd_output.h"

#include "tonemap.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

int output_problem(const char *path, arena *mem) {
  const char *slash = strrchr(path, '/');
  size_t n = slash == NULL ? 0 : (size_t)(slash - path) + 1;
  const char *folder = n == 0 ? "." : arena_text(mem, path, n);
  struct stat st;
  if (stat(path, &st) == 0) {
    if (S_ISDIR(st.st_mode)) return EISDIR;
    if (!S_ISREG(st.st_mode)) return 0;  // a device or pipe needs no folder
  }
  if (stat(folder, &st) != 0) return errno;
  if (!S_ISDIR(st.st_mode)) return ENOTDIR;
  return access(folder, W_OK | X_OK) != 0 ? errno : 0;
}

// The format by --format or suffix; an exit code.
static int choose_format(output *out) {
  const options *o = out->o;
  static const picture_format formats[] = {PICTURE_PNG, PICTURE_PFM,
                                           PICTURE_HDR, PICTURE_UNKNOWN};
  const option_value *v = &o->value[OPT_FORMAT];
  out->format = picture_format_of(out->path);
  out->part = cmd_has_suffix(out->path, ".part");
  if (v->given) {
    out->format = formats[v->words];
    out->part = v->words == 3;
  }
  if (out->part) return EXIT_DONE;
  for (int i = 0; i < 3; i++)
    if (out->format == formats[i]) return EXIT_DONE;
  if (strcmp(out->path, "-") == 0)
    return cmd_fail(o, EXIT_USAGE, "-o - needs --format png, pfm, hdr or part");
  return cmd_fail(o, EXIT_USAGE,
                  "%s: cannot tell the format from this suffix, expected "
                  ".png, .pfm, .hdr or .part, or --format",
                  out->path);
}

// NAME.normal.pfm beside NAME.png.
void output_name_aovs(output *out, unsigned aovs, arena *mem) {
  const option *o = &option_table[OPT_AOV];
  char word[32], suffix[64];
  for (unsigned i = 0; i < RENDER_AOV_COUNT; i++) {
    if ((aovs >> i & 1) == 0) continue;
    option_word(o, i, word, sizeof word);
    snprintf(suffix, sizeof suffix, ".%s.pfm", word);
    out->aov[i] = cmd_beside(mem, out->path, suffix);
  }
}

// STEM.2-of-8.part for --shard 2/8.
static const char *shard_path(const options *o, const char *stem, arena *mem) {
  char *path = arena_format(mem, "%s.%s.part", stem, o->value[OPT_SHARD].text);
  char *slash = strchr(path + strlen(stem), '/');
  if (slash == NULL) return path;
  *slash = 0;
  return arena_format(mem, "%s-of-%s", path, slash + 1);
}

int output_plan(output *out, const options *o, arena *mem) {
  *out = (output){.o = o, .path = o->value[OPT_OUTPUT].text};
  out->radiance = o->value[OPT_SHADING].words < 3;
  const char *in = o->operands[0];
  if (out->path == NULL) {
    const char *stem = strcmp(in, "-") == 0 ? "stdin" : cmd_stem(mem, in);
    const char *const suffixes[] = {"png", "pfm", "hdr", "part"};
    unsigned format = o->value[OPT_FORMAT].words;
    if (o->value[OPT_SHARD].given && !o->value[OPT_FORMAT].given)
      out->path = shard_path(o, stem, mem);
    else
      out->path = arena_format(mem, "%s.%s", stem, suffixes[format]);
  }
  int code = choose_format(out);
  if (code != EXIT_DONE) return code;
  error err;
  const char *pane = o->value[OPT_POST].text;
  out->frosted = pane != NULL;
  if (out->frosted && !post_parse(&out->pane, pane, &err))
    return cmd_fail(o, EXIT_USAGE, "%s", err.text);
  out->depth = o->value[OPT_DEPTH].words == 1 ? 16 : 8;
  if (strcmp(out->path, "-") == 0) {
    if (o->value[OPT_AOV].given)
      return cmd_fail(o, EXIT_USAGE, "--aov needs the name of a file: -o FILE");
    if (o->value[OPT_JSON].given)
      return cmd_fail(o, EXIT_USAGE,
                      "-o - and --json both want standard output");
    if (isatty(STDOUT_FILENO))
      return cmd_fail(o, EXIT_USAGE,
                      "will not write a picture to a terminal; use -o FILE, or "
                      "send standard output elsewhere");
    return EXIT_DONE;
  }
  if (!out->part) output_name_aovs(out, o->value[OPT_AOV].words, mem);
  int problem = output_problem(out->path, mem);
  if (problem == 0) return EXIT_DONE;
  return cmd_fail(o, EXIT_OUTPUT, "%s: cannot be written: %s", out->path,
                  strerror(problem));
}

void output_warn(const output *out, report *r) {
  static const option_id of_png[] = {OPT_DEPTH, OPT_TONEMAP, OPT_EXPOSURE};
  static const option_id of_merge[] = {OPT_DEPTH, OPT_TONEMAP, OPT_POST};
  if (out->format == PICTURE_PNG) return;
  const option_id *useless = out->part ? of_merge : of_png;
  for (int i = 0; i < 3; i++)
    if (out->o->value[useless[i]].given)
      report_warn(r, "--%s has no effect on %s: %s",
                  option_table[useless[i]].name, out->path,
                  out->part ? "facet merge has it"
                            : "only PNG has it, this format keeps linear "
                              "radiance");
}

// Whether both paths lead to one file.
static bool same_file(const char *a, const char *b) {
  struct stat x, y;
  return stat(a, &x) == 0 && stat(b, &y) == 0 && x.st_dev == y.st_dev &&
         x.st_ino == y.st_ino;
}

const char *output_overwrites(const output *out, const char *input) {
  if (input == NULL) return NULL;
  if (same_file(out->path, input)) return out->path;
  for (int i = 0; i < RENDER_AOV_COUNT; i++)
    if (out->aov[i] != NULL && same_file(out->aov[i], input))
      return out->aov[i];
  return NULL;
}

int output_protect_inputs(const output *out, const scene *s, arena *mem) {
  const char *in = out->o->operands[0];
  const char *bad = output_overwrites(out, in);
  const char *beside[] = {".obj", ".scene", ".mtl"};
  for (int i = 0; i < 3 && bad == NULL; i++)
    bad = output_overwrites(out, cmd_beside(mem, in, beside[i]));
  for (size_t i = 0; i < s->textures.count && bad == NULL; i++)
    bad = output_overwrites(out, s->textures.textures[i]->path);
  for (size_t i = 0; i < s->mesh.library_count && bad == NULL; i++) {
    const char *slash = strrchr(in, '/');
    int folder = slash == NULL ? 0 : (int)(slash - in) + 1;
    bad = output_overwrites(
        out, arena_format(mem, "%.*s%s", folder, in, s->mesh.libraries[i]));
  }
  if (bad == NULL) bad = output_overwrites(out, out->o->value[OPT_ENV].text);
  if (bad == NULL) return EXIT_DONE;
  return cmd_fail(out->o, EXIT_USAGE, "%s: is an input; write somewhere else",
                  bad);
}

// Whether exposure and curve change the picture.
static bool is_developed(const output *out) {
  bool curve = out->o->value[OPT_TONEMAP].words != TONEMAP_NONE;
  return out->format == PICTURE_PNG && out->radiance &&
         (out->exposure != 0 || curve);
}

bool output_write(const output *out, const render_result *r, arena *mem,
                  error *err) {
  image im = r->color;
  if (out->frosted) {
    im = post_frosted(&r->color, out->pane, mem, NULL);
  } else if (is_developed(out)) {
    im = image_new(mem, im.width, im.height);
    memcpy(im.pixels, r->color.pixels,
           (size_t)im.width * (size_t)im.height * sizeof *im.pixels);
  }
  if (is_developed(out))
    tonemap_apply(&im, out->exposure,
                  (tonemap_curve)out->o->value[OPT_TONEMAP].words);
  // The companions first: where the picture is, everything is.
  for (int i = 0; i < RENDER_AOV_COUNT; i++)
    if (out->aov[i] != NULL && r->aov[i].pixels != NULL &&
        !picture_write(&r->aov[i], out->aov[i], PICTURE_PFM, 8, err))
      return false;
  return picture_write(&im, out->path, out->format, out->depth, err);
}
