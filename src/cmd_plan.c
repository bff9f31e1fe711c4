// cmd_plan.c

#include "cmd_plan.h"

#include "clock.h"
#include "plan_use.h"
#include "plan_word.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

plan_request cmd_plan_request(const shot *s, bool path) {
  const option_value *v = s->o->value;
  static const render_shading shadings[] = {RENDER_RADIANCE, RENDER_RADIANCE,
                                            RENDER_RADIANCE, RENDER_NORMAL,
                                            RENDER_DEPTH,    RENDER_ALBEDO};
  bool crop = s->x1 > 0;
  bool ends = v[OPT_TIME].given || v[OPT_ERROR].given;
  plan_request r = {
      .scene = &s->scene,
      .view = s->view,
      .width = s->width,
      .height = s->height,
      .window = {s->x0, s->y0, crop ? s->x1 : s->width,
                 crop ? s->y1 : s->height},
      .path = path,
      .shading = shadings[v[OPT_SHADING].words],
      .aovs = v[OPT_AOV].words,
      .lights = v[OPT_LIGHTS].words == 0,
      .shadows = v[OPT_SHADOWS].words == 0,
      .naive = v[OPT_INTEGRATOR].words == 1,
      .learns = v[OPT_INTEGRATOR].words == 0,
      .each = v[OPT_SHADE].words == 1,
      .split = v[OPT_IBL].words == 1,
      .model = (pbr_model)v[OPT_PBR_MODEL].words,
      .msaa = (int)v[OPT_MSAA].whole[0],
      .max_depth = (int)v[OPT_MAX_DEPTH].whole[0],
      .estimate = v[OPT_JSON].given || !v[OPT_QUIET].given || ends,
      .frosted = v[OPT_POST].given,
      .no_skip = v[OPT_NO_SKIP].given,
  };
  uint64_t pixels = (uint64_t)(r.window[2] - r.window[0]) *
                    (uint64_t)(r.window[3] - r.window[1]);
  if (!ends) r.samples = pixels * (uint64_t)v[OPT_SPP].whole[0];
  return r;
}

// The flags' own defaults, which only facet render has.
enum { USUAL_WIDTH = 1280, USUAL_HEIGHT = 720, USUAL_MSAA = 4, USUAL_SPP = 64 };

bool cmd_plan_usual(plan_request *out, const scene *s, bool path, error *err) {
  bool given = s->film_width > 0;
  int w = given ? s->film_width : USUAL_WIDTH;
  int h = given ? s->film_height : USUAL_HEIGHT;
  const camera *found = scene_camera(s, NULL);
  camera c = found != NULL ? *found
                           : camera_framing(s->lo, s->hi, (float)w / (float)h);
  *out = (plan_request){.scene = s,
                        .width = w,
                        .height = h,
                        .window = {0, 0, w, h},
                        .path = path,
                        .lights = true,
                        .shadows = true,
                        .msaa = USUAL_MSAA,
                        .samples = (uint64_t)w * (uint64_t)h * USUAL_SPP,
                        .estimate = true};
  return camera_view_of(&out->view, &c, w, h, err);
}

// Note what was decoded and kept.
static void note_files(plan *p, const shot *s, size_t failed) {
  const scene *sc = &s->scene;
  const mesh *m = &sc->mesh;
  size_t bytes, n = texture_decoded(&sc->textures, &bytes);
  plan_note(p, PLAN_TEXTURES, n + failed,
            sc->seconds_textures - sc->seconds_env, (double)bytes);
  bool map = sc->env.kind == ENV_MAP && sc->env.map.pixels != NULL;
  plan_note(p, PLAN_ENV_MAP, map, sc->seconds_env,
            map ? (double)sc->env.map.width * sc->env.map.height * sizeof(vec3)
                : 0);
  double corners = 3.0 * (double)m->triangle_count * sizeof(uint32_t);
  bool uv = m->texcoord_index != NULL, normals = m->normal_index != NULL;
  plan_note(p, PLAN_TEXCOORDS, uv ? m->texcoord_count : 0, -1,
            uv ? corners + (double)m->texcoord_count * sizeof(vec2) : 0);
  plan_note(p, PLAN_NORMALS, normals ? m->normal_count : 0, -1,
            normals ? corners + (double)m->normal_count * sizeof(vec3) : 0);
}

int cmd_plan_carry_out(plan *p, shot *s) {
  size_t failed = s->scene.textures.failed;
  plan_prune(p, &s->scene);
  int code = shot_decode(s, p->maps, plan_needs(p, PLAN_ENV_MAP));
  if (code == EXIT_DONE) note_files(p, s, s->scene.textures.failed - failed);
  return code;
}

// A number of things, "any" where nobody knows.
static const char *count_text(char text[24], uint64_t n) {
  if (n == PLAN_ANY)
    snprintf(text, 24, "any");
  else
    snprintf(text, 24, "%" PRIu64, n);
  return text;
}

// Bytes with three digits.
static const char *bytes_text(char text[24], double bytes) {
  static const char *const units[] = {"B", "KB", "MB", "GB", "TB"};
  int i = 0;
  for (; bytes >= 999.5 && i < 4; i++)
    bytes /= 1000;
  if (bytes > 0)
    snprintf(text, 24, "%.3g %s", bytes, units[i]);
  else
    snprintf(text, 24, "-");
  return text;
}

static void print_line(const plan_line *l, plan_stage stage, FILE *out) {
  char did[24], all[24], bytes[24], seconds[24] = "-", much[80];
  uint64_t n = l->counted ? l->did : l->need;
  if (l->counted && l->seconds >= 0)
    snprintf(seconds, sizeof seconds, "%.4f s", l->seconds);
  snprintf(much, sizeof much, "%s of %s %s", count_text(did, n),
           count_text(all, l->all), plan_unit(stage));
  fprintf(out, "%-20s %-8s %-32s %9s %8s  %s%s\n", plan_name(stage),
          plan_word(plan_verdict_of(l)), much, seconds,
          bytes_text(bytes, l->bytes), l->why,
          plan_kept(l) ? "" : " (not as planned)");
}

void cmd_plan_print(const plan *p, FILE *out) {
  fprintf(out, "plan of the %s engine%s\n", p->of.path ? "path" : "raster",
          p->of.no_skip ? ", nothing skipped" : "");
  if (p->of.before > 0)
    fprintf(out,
            "counts are of this run, which went on from %" PRIu64 " samples\n",
            p->of.before);
  for (int i = 0; i < PLAN_STAGES; i++)
    if (p->line[i].told) print_line(&p->line[i], (plan_stage)i, out);
}

// A count, null where nobody knows.
static void json_known(json *j, const char *key, uint64_t n) {
  if (n == PLAN_ANY)
    json_text(j, key, NULL);
  else
    json_count(j, key, n);
}

static void json_line(json *j, const plan_line *l, plan_stage stage) {
  json_open(j, NULL, '{');
  json_text(j, "stage", plan_name(stage));
  json_text(j, "verdict", plan_word(plan_verdict_of(l)));
  json_text(j, "why", l->why);
  json_text(j, "unit", plan_unit(stage));
  json_known(j, "need", l->need);
  json_known(j, "all", l->all);
  json_flag(j, "at_most", l->at_most);
  if (l->counted) {
    json_count(j, "did", l->did);
    json_flag(j, "kept", plan_kept(l));
    json_number(j, "seconds", l->seconds >= 0 ? l->seconds : (double)NAN);
    json_number(j, "bytes", l->bytes);
  }
  json_close(j, '{');
}

void cmd_plan_json(json *j, const char *key, const plan *p) {
  json_open(j, key, '[');
  for (int i = 0; i < PLAN_STAGES; i++)
    if (p->line[i].told) json_line(j, &p->line[i], (plan_stage)i);
  json_close(j, '[');
}
