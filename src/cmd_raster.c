// cmd_raster.c

#include "cmd_raster.h"

#include "clock.h"
#include "cmd_forced.h"
#include "matter.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

// Mesa's software renderer starts a thread for every CPU that it sees and
// knows nothing of quotas and -j.  Whoever has set the variable keeps it.
static void limit_threads(const options *o) {
  char threads[16];
  snprintf(threads, sizeof threads, "%d", cmd_threads(o));
  setenv("LP_NUM_THREADS", threads, 0);
}

bool raster_job_open(raster_job *job, const options *o, arena *mem,
                     error *err) {
  double start = clock_seconds();
  limit_threads(o);
  // The words of --gl are in the order of gl_backend.
  if (!gl_open(&job->g, (gl_backend)o->value[OPT_GL].words, mem, err))
    return false;
  job->gl_seconds = clock_seconds() - start;
  return true;
}

raster_settings raster_job_settings(const shot *s) {
  const option_value *v = s->o->value;
  static const raster_shading shadings[] = {RASTER_RADIANCE, RASTER_RADIANCE,
                                            RASTER_RADIANCE, RASTER_NORMAL,
                                            RASTER_DEPTH,    RASTER_ALBEDO};
  return (raster_settings){
      .width = s->width,
      .height = s->height,
      .x0 = s->x0,
      .y0 = s->y0,
      .x1 = s->x1,
      .y1 = s->y1,
      .msaa = (int)v[OPT_MSAA].whole[0],
      .lights = v[OPT_LIGHTS].words == 0,
      .shadows = v[OPT_SHADOWS].words == 0,
      .sky = true,
      .each = v[OPT_SHADE].words == 1,
      .shading = shadings[v[OPT_SHADING].words],
      .model = v[OPT_PBR_MODEL].words == 0 ? RASTER_GGX : RASTER_REPORT,
      .spared = {.outside = true, .edges = true},
  };
}

// An environment that is not the same all around.
static bool has_env(const shot *s) {
  return s->scene.env.kind == ENV_SKY || s->scene.env.kind == ENV_MAP;
}

// Whether the plan, if there is one, asks for a stage.
static bool needs(const raster_job *job, plan_stage stage) {
  return job->plan == NULL || plan_needs(job->plan, stage);
}

static const bool *unseen(const raster_job *job) {
  return job->settings.spared.unseen;
}

static bool lobes_lean(const raster_job *job, const shot *s) {
  return needs(job, PLAN_LEAN) && has_env(s) &&
         job->settings.model == RASTER_GGX && s->o->value[OPT_IBL].words == 0;
}

// Where lobes look, for the roughness values that will be asked for.
static void ready_lean(raster_job *job, const shot *s, arena *scratch) {
  lean table;
  ibl_need need = raster_env_need(&s->scene, PBR_GGX, job->any_roughness,
                                  unseen(job), scratch);
  if (need.all)
    lean_build(&table, scratch, s->threads);
  else
    lean_build_for(&table, need.roughness, need.count, scratch, s->threads);
  job->lean = raster_lean_new(job->g, &table, &job->rough);
  job->settings.metal_rough = raster_lean_piece(&job->lean);
}

// Metallic-roughness as the path engine has it: the table is the same.
static void ready_rough(raster_job *job, const shot *s) {
  if (!needs(job, PLAN_TABLE)) return;
  double start = clock_seconds();
  pbr_model model = job->settings.model == RASTER_REPORT ? PBR_REPORT : PBR_GGX;
  if (job->table == NULL)
    job->table = (job->any_roughness ? matter_table : matter_table_as_is)(
        &s->scene, model, s->mem, s->threads);
  if (job->table == NULL) return;
  arena scratch = {0};
  job->rough = raster_rough_new(job->g, job->table, &scratch);
  job->settings.metal_rough = raster_rough_piece(&job->rough);
  if (lobes_lean(job, s)) ready_lean(job, s, &scratch);
  job->table_seconds += clock_seconds() - start;
  arena_free(&scratch);
}

// Light from the environment.
static void ready_env(raster_job *job, const shot *s, arena *mem) {
  const env *e = &s->scene.env;
  if (!has_env(s) || job->settings.shading != RASTER_RADIANCE) return;
  if (!needs(job, PLAN_IBL)) return;
  pbr_model model = job->settings.model == RASTER_REPORT ? PBR_REPORT : PBR_GGX;
  ibl made;
  ibl_need need = raster_env_need(&s->scene, model, job->any_roughness,
                                  unseen(job), s->mem);
  need.use_cache = !s->o->value[OPT_NO_CACHE].given;
  ibl_make(&made, e, &need, s->mem, s->threads);
  job->env_seconds = made.seconds;
  job->sums = 1 + made.level_count;
  job->sums_kept = made.from_cache;
  job->sum_bytes = (double)ibl_bytes(&made);
  job->env = raster_env_new(job->g, &made, mem);
  job->settings.ambient = raster_env_piece(&job->env);
}

bool raster_job_upload(raster_job *job, const shot *s, arena *mem, error *err) {
  ready_rough(job, s);
  ready_env(job, s, mem);
  if (!raster_new(&job->r, job->g, &s->scene, &job->settings, mem, err))
    return false;
  job->samples = raster_last_frame(job->r).samples;
  return true;
}

// Zero the pixels that are not finite; how many there were, and the first.
static void drop_non_finite(render_result *r, const shot *s) {
  image *im = &r->color;
  for (int y = 0; y < im->height; y++)
    for (int x = 0; x < im->width; x++) {
      vec3 *p = &im->pixels[(size_t)y * (size_t)im->width + (size_t)x];
      if (isfinite(p->x) && isfinite(p->y) && isfinite(p->z)) continue;
      *p = (vec3){0};
      if (r->non_finite++ > 0) continue;
      r->bad_x = s->x0 + x;
      r->bad_y = s->y0 + y;
    }
}

bool raster_job_draw(render_result *out, raster_job *job, const shot *s,
                     unsigned aovs, error *err) {
  double start = clock_seconds();
  *out = (render_result){0};
  if (!raster_draw(job->r, &s->view, err)) return false;
  out->color = raster_read(job->r, s->mem);
  job->times = raster_last_times(job->r);
  // The bits of normal, depth and albedo are in the order of raster_shading.
  for (int i = 0; i < 3; i++)
    if ((aovs >> i & 1) != 0 &&
        !raster_read_aov(&out->aov[i], job->r,
                         (raster_shading)(RASTER_NORMAL + i), s->mem, err))
      return false;
  drop_non_finite(out, s);
  out->seconds = clock_seconds() - start;
  return true;
}

// What the pictures of the frame took, by stage.
static void note_frame(const raster_job *job, plan *p) {
  raster_counts n = raster_last_counts(job->r);
  const raster_times *t = &job->times;
  plan_note(p, PLAN_MAPS, n.maps, n.map_seconds, (double)n.map_bytes);
  plan_note(p, PLAN_TRIANGLES, n.uploaded, n.seconds, (double)n.bytes);
  plan_note(p, PLAN_DRAW_LIST, n.drawn, t->draw, 0);
  plan_note(p, PLAN_VISIBILITY, n.once, -1, 0);
  plan_note(p, PLAN_RESOLVE, n.resolves, -1, 0);
  plan_note(p, PLAN_KINDS, n.kinds, t->compile, 0);
  plan_note(p, PLAN_SKY, n.skies, -1, 0);
  plan_note(p, PLAN_LAMPS, n.lamps, -1, 0);
  plan_note(p, PLAN_SHADOW_MAPS, n.layers, t->shadow, (double)n.shadow_bytes);
}

void raster_job_note(const raster_job *job, plan *p, const shot *s) {
  note_frame(job, p);
  bool leans = job->lean.texture != 0;
  plan_note(p, PLAN_TABLE, job->rough.texture != 0, job->table_seconds, 0);
  plan_note(p, PLAN_LEAN, leans, -1, 0);
  plan_note(p, PLAN_IBL, (uint64_t)job->sums, job->env_seconds, job->sum_bytes);
  if (job->sums_kept)
    p->line[PLAN_IBL].why = "those in use; kept by another run";
  plan_note(p, PLAN_TREE, 0, 0, 0);
  cmd_forced_tables(p, s);
  cmd_forced_tree(p, s);
}

void raster_job_json(json *j, const raster_job *job) {
  json_count(j, "msaa", (unsigned long long)job->samples);
  json_open(j, "gl", '{');
  json_text(j, "backend", gl_backend_name(job->g));
  json_text(j, "renderer", gl_renderer(job->g));
  json_close(j, '{');
}

void raster_job_drop(raster_job *job) {
  if (job->r != NULL) raster_free(job->r);
  if (job->rough.texture != 0) raster_rough_free(job->g, &job->rough);
  if (job->lean.texture != 0) raster_lean_free(job->g, &job->lean);
  if (job->env.texture != 0) raster_env_free(job->g, &job->env);
  job->r = NULL;
  job->rough = (raster_rough){0};
  job->lean = (raster_lean){0};
  job->env = (raster_env){0};
}

void raster_job_close(raster_job *job) {
  raster_job_drop(job);
  gl_close(job->g);
  *job = (raster_job){0};
}
