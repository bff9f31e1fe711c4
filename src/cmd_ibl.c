// cmd_ibl.c — facet ibl: light from an environment, prepared, as files or as
// answers to questions.

#include "cmd_shared.h"

#include "dfg.h"
#include "file.h"
#include "ibl.h"
#include "picture.h"
#include "scene_file.h"
#include "text.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

// What a line of --eval asks for.
typedef enum question_kind {
  ASK_NOTHING,  // a blank line or a comment
  ASK_IRRADIANCE,
  ASK_RADIANCE,
  ASK_DFG
} question_kind;

// A line of --eval.
typedef struct question {
  question_kind kind;
  vec3 d;
  float nv, roughness;
} question;

// All of a file, and what has to be prepared to answer.
typedef struct questions {
  question *list;
  size_t count, room;
  float roughness[IBL_MAX_LEVELS + 1];
  int roughness_count;  // more than IBL_MAX_LEVELS: too many to list
  bool irradiance, radiance, dfg;
} questions;

bool cmd_env_of(env *out, const char *text, arena *mem, report *r, error *err) {
  scene_env e = scene_env_of_text(text, mem);
  *out = (env){.kind = e.kind, .constant = e.constant, .scale = 1};
  return e.kind != ENV_MAP || env_load(out, e.path, mem, r, err);
}

// Note a roughness value, once.
static void note_roughness(questions *q, float r) {
  int n = q->roughness_count;
  for (int i = 0; i < n; i++)
    if (q->roughness[i] == r) return;
  if (n <= IBL_MAX_LEVELS) q->roughness[q->roughness_count++] = r;
}

// The numbers after the first word: as many as the kind needs, in range.
static bool parse_numbers(question *q, span rest) {
  float x[4];
  int n = 0, want = q->kind == ASK_IRRADIANCE ? 3 : q->kind == ASK_DFG ? 2 : 4;
  for (span word; (word = text_word(&rest)).length > 0; n++)
    if (n == 4 || !span_float(word, &x[n]) || !isfinite(x[n])) return false;
  if (n != want) return false;
  if (q->kind == ASK_DFG)
    q->nv = x[0];
  else
    q->d = vec3_unit((vec3){x[0], x[1], x[2]});
  q->roughness = q->kind == ASK_IRRADIANCE ? 0 : x[n - 1];
  bool range =
      q->roughness >= 0 && q->roughness <= 1 && q->nv >= 0 && q->nv <= 1;
  return range && (q->kind == ASK_DFG || vec3_length(q->d) > 0.5f);
}

static bool parse_question(question *q, span line) {
  span rest = text_uncomment(line), word = text_word(&rest);
  *q = (question){ASK_NOTHING, {0, 0, 0}, 0, 0};
  if (word.length == 0) return true;
  q->kind = span_is(word, "irradiance") ? ASK_IRRADIANCE
            : span_is(word, "radiance") ? ASK_RADIANCE
            : span_is(word, "dfg")      ? ASK_DFG
                                        : ASK_NOTHING;
  return q->kind != ASK_NOTHING && parse_numbers(q, rest);
}

// Read the file of questions.
static bool read_questions(questions *out, const char *path, arena *mem,
                           error *err) {
  span text;
  if (!text_read(&text, path, mem, err)) return false;
  text_lines lines = text_lines_of(text, 1);
  bool ok = true;
  for (span line; ok && text_next_line(&lines, &line);) {
    out->list =
        array_grow(out->list, &out->room, out->count + 1, sizeof *out->list);
    question *q = &out->list[out->count++];
    ok = parse_question(q, line);
    if (!ok)
      fail(err,
           "%s:%llu: expected 'irradiance X Y Z', 'radiance X Y Z ROUGHNESS' "
           "or 'dfg NOV ROUGHNESS', NOV and ROUGHNESS in 0..1",
           path, (unsigned long long)lines.line);
    out->irradiance |= q->kind == ASK_IRRADIANCE;
    out->radiance |= q->kind == ASK_RADIANCE;
    out->dfg |= q->kind == ASK_DFG;
    if (ok && q->kind == ASK_RADIANCE) note_roughness(out, q->roughness);
  }
  text_lines_free(&lines);
  return ok;
}

// Answer one question on a line.
static void answer(const question *q, const ibl *b, const dfg *table) {
  if (q->kind == ASK_DFG) {
    dfg_pair p = dfg_lookup(table, q->nv, q->roughness);
    printf("%.9g %.9g\n", (double)p.c1, (double)p.c2);
  } else if (q->kind != ASK_NOTHING) {
    vec3 v = q->kind == ASK_IRRADIANCE ? ibl_irradiance(b, q->d)
                                       : ibl_radiance(b, q->d, q->roughness);
    printf("%.9g %.9g %.9g\n", (double)v.x, (double)v.y, (double)v.z);
  }
}

// What one run of the command holds.
typedef struct ibl_run {
  const options *o;
  env e;
  pbr_model model;
  pool *threads;
  arena *mem;
} ibl_run;

// facet ibl --eval: prepare what the questions need, answer them.
static int answer_all(const ibl_run *r) {
  questions q = {0};
  error err;
  if (!read_questions(&q, r->o->value[OPT_EVAL].text, r->mem, &err)) {
    array_free(q.list);
    return cmd_fail(r->o, EXIT_INPUT, "%s", err.text);
  }
  bool many = q.roughness_count > IBL_MAX_LEVELS;
  ibl b = {0};
  ibl_need need = {.model = r->model,
                   .diffuse = q.irradiance,
                   .all = many,
                   .roughness = q.roughness,
                   .count = many ? 0 : q.roughness_count,
                   .use_cache = !r->o->value[OPT_NO_CACHE].given};
  if (q.irradiance || q.radiance)
    ibl_make(&b, &r->e, &need, r->mem, r->threads);
  dfg table = {0};
  if (q.dfg) dfg_build(&table, r->model, r->mem, r->threads);
  for (size_t i = 0; i < q.count; i++)
    answer(&q.list[i], &b, &table);
  array_free(q.list);
  return EXIT_DONE;
}

// Write a picture into the folder.
static bool write_into(const ibl_run *r, const image *im, const char *name,
                       error *err) {
  const char *folder = r->o->value[OPT_OUTPUT].text;
  const char *path = arena_format(r->mem, "%s/%s", folder, name);
  return picture_write(im, path, PICTURE_PFM, 8, err);
}

// A level as plain values at its nodes.
static bool write_level(const ibl_run *r, const ibl_level *l, const char *name,
                        error *err) {
  image im = image_new(r->mem, l->width, l->height);
  for (int y = 0; y < l->height; y++)
    for (int x = 0; x < l->width; x++)
      im.pixels[(size_t)y * (size_t)l->width + (size_t)x] = ibl_level_at(
          l, (float)x / (float)l->width, (float)y / (float)(l->height - 1));
  return write_into(r, &im, name, err);
}

static bool write_dfg(const ibl_run *r, const dfg *d, error *err) {
  image im = image_new(r->mem, DFG_COLUMNS, DFG_ROWS);
  for (size_t i = 0; i < (size_t)DFG_COLUMNS * DFG_ROWS; i++)
    im.pixels[i] = (vec3){d->table[i].c1, d->table[i].c2, 0};
  return write_into(r, &im, "dfg.pfm", err);
}

// A level in the list of files.
static void json_level(json *j, const ibl_level *l, const char *name) {
  json_open(j, NULL, '{');
  json_text(j, "file", name);
  if (l->roughness >= 0) json_float(j, "roughness", l->roughness);
  json_count(j, "width", (unsigned long long)l->width);
  json_count(j, "height", (unsigned long long)l->height);
  json_close(j, '{');
}

static const char *level_name(const ibl_run *r, const ibl_level *l) {
  return arena_format(r->mem, "radiance-%g.pfm", (double)l->roughness);
}

// ibl.json: what the files hold.
static bool write_index(const ibl_run *r, const ibl *b, error *err) {
  const char *path =
      arena_format(r->mem, "%s/ibl.json", r->o->value[OPT_OUTPUT].text);
  file_writer w;
  if (!file_create(&w, path, r->mem, err)) return false;
  json j = {.out = w.stream};
  json_open(&j, NULL, '{');
  json_text(&j, "environment", r->o->operands[0]);
  json_text(&j, "pbr_model", r->model == PBR_REPORT ? "report" : "ggx");
  json_text(&j, "layout",
            "equirectangular nodes: column i is u = i / width, row j from the "
            "top is v = j / (height - 1); the first and last rows are the "
            "poles +Y and -Y");
  json_text(&j, "direction", "u = 0.5 + atan2(x, -z) / 2 pi, v = acos(y) / pi");
  json_text(&j, "irradiance_unit", "L = 1 all around gives pi");
  json_open(&j, "levels", '[');
  json_level(&j, &b->irradiance, "irradiance.pfm");
  for (int i = 0; i < b->level_count; i++)
    json_level(&j, &b->level[i], level_name(r, &b->level[i]));
  json_close(&j, '[');
  json_open(&j, "dfg", '{');
  json_text(&j, "file", "dfg.pfm");
  json_text(&j, "columns", "sqrt(n.v), from 0 to 1, nodes on the edges");
  json_text(&j, "rows", "sqrt(roughness), from 0 on top to 1");
  json_text(&j, "channels", "C1, C2: the albedo is F0 C1 + C2");
  json_close(&j, '{');
  json_number(&j, "seconds", b->seconds);
  json_flag(&j, "from_cache", b->from_cache);
  json_close(&j, '{');
  json_end(&j);
  return file_commit(&w, err);
}

// facet ibl -o DIR: everything, as files.
static int write_all(const ibl_run *r) {
  const char *folder = r->o->value[OPT_OUTPUT].text;
  error err;
  if (mkdir(folder, 0777) != 0 && errno != EEXIST)
    return cmd_fail(r->o, EXIT_OUTPUT, "%s: cannot be made: %s", folder,
                    strerror(errno));
  ibl b;
  ibl_need need = {.model = r->model,
                   .diffuse = true,
                   .all = true,
                   .use_cache = !r->o->value[OPT_NO_CACHE].given};
  ibl_make(&b, &r->e, &need, r->mem, r->threads);
  dfg table;
  dfg_build(&table, r->model, r->mem, r->threads);
  bool ok = write_level(r, &b.irradiance, "irradiance.pfm", &err);
  for (int i = 0; i < b.level_count && ok; i++)
    ok = write_level(r, &b.level[i], level_name(r, &b.level[i]), &err);
  ok = ok && write_dfg(r, &table, &err) && write_index(r, &b, &err);
  if (!ok) return cmd_fail(r->o, EXIT_OUTPUT, "%s", err.text);
  if (!r->o->value[OPT_QUIET].given)
    fprintf(stderr, "%s: irradiance and %d levels in %.3f s%s\n", folder,
            b.level_count, b.seconds, b.from_cache ? ", from the cache" : "");
  return EXIT_DONE;
}

int cmd_ibl(const options *o) {
  if (!o->value[OPT_OUTPUT].given && !o->value[OPT_EVAL].given)
    return cmd_fail(o, EXIT_USAGE, "facet ibl: expected -o DIR or --eval FILE");
  arena mem = {0};
  report notes = {.mem = &mem};
  error err;
  ibl_run r = {.o = o,
               .model = (pbr_model)o->value[OPT_PBR_MODEL].words,
               .threads = pool_new(&mem, cmd_threads(o)),
               .mem = &mem};
  int code = EXIT_DONE;
  if (!cmd_env_of(&r.e, o->operands[0], &mem, &notes, &err))
    code = cmd_fail(o, EXIT_INPUT, "%s", err.text);
  cmd_remarks(o, &notes);
  if (code == EXIT_DONE && o->value[OPT_EVAL].given) code = answer_all(&r);
  if (code == EXIT_DONE && o->value[OPT_OUTPUT].given) code = write_all(&r);
  pool_free(r.threads);
  arena_free(&mem);
  return code;
}
