// cmd_render_plan.c

#include "cmd_render_plan.h"

#include "cmd_forced.h"

int render_plan_make(render_job *j) {
  plan_request r = cmd_plan_request(&j->shot, j->engine == ENGINE_PATH);
  r.kept = cmd_keep_wanted(&j->keep);
  if (r.kept) r.samples = 0;
  j->plan = plan_make(&r, j->shot.mem);
  if (plan_needs(&j->plan, PLAN_POST) && !j->out.frosted) {
    j->out.frosted = true;  // by --no-skip: a pane that is clear
    j->out.pane.radius = 0;
  }
  return cmd_plan_carry_out(&j->plan, &j->shot);
}

unsigned render_plan_films(const render_job *j) {
  unsigned firsts = RENDER_AOV_NORMAL | RENDER_AOV_DEPTH | RENDER_AOV_ALBEDO;
  unsigned aovs = j->o->value[OPT_AOV].words;
  if (!j->plan.of.no_skip || j->plan.of.kept) return aovs;
  return aovs | firsts | (j->engine == ENGINE_PATH ? RENDER_AOV_VARIANCE : 0);
}

void render_plan_note_paths(render_job *j) {
  plan *p = &j->plan;
  const render_result *r = &j->result;
  const cmd_tree *t = &j->tree;
  const light_env *e = &j->lights.env;
  unsigned walker = j->o->value[OPT_INTEGRATOR].words;
  bool mis = walker == 2, learns = walker == 0;
  plan_note(p, PLAN_TREE, 1, t->seconds, (double)cmd_tree_bytes(t));
  if (t->from_cache)
    p->line[PLAN_TREE].why = "rays ask it; kept by another run";
  plan_note(p, PLAN_TRIANGLES,
            j->shot.scene.mesh.triangle_count - t->binary.dropped, -1, 0);
  plan_note(p, PLAN_PATHS, r->paths.followed, r->seconds, 0);
  p->of.before = j->keep.before;
  if (p->of.samples == 0) p->line[PLAN_PATHS].all = r->samples - p->of.before;
  plan_note(p, PLAN_LAMPS, j->shot.scene.light_count, -1, 0);
  uint64_t tables =
      (e->columns != NULL) + (uint64_t)(j->lights.whole.columns != NULL);
  plan_note(p, PLAN_ENV_TABLE, tables, -1,
            1.25 * sizeof(uint32_t) * e->map.width * e->map.height *
                (double)tables);
  plan_note(p, PLAN_ASK, r->paths.asked, -1, 0);
  if (j->lights.memory != NULL)
    p->line[PLAN_ASK].why = j->lights.sky.count > 0
                                ? "memory knows what of the sky is seen where"
                                : "memory knows what lamps are seen where";
  plan_note(p, PLAN_SHADOW_RAY, r->paths.shadows, -1, 0);
  p->line[PLAN_SHADOW_RAY].all = r->paths.asked;
  plan_note(p, PLAN_AIM, r->paths.aimed, -1, 0);
  if (plan_needs(p, PLAN_AIM) && j->paths.aim == NULL)
    p->line[PLAN_AIM].why = mis ? "--integrator mis learns nothing"
                                : "it would take too little noise away";
  plan_note(p, PLAN_SHARE, r->paths.shared, -1, 0);
  if (plan_needs(p, PLAN_SHARE) && j->paths.film == NULL)
    p->line[PLAN_SHARE].why = learns ? "it would take too little noise away"
                                     : "only --integrator auto learns";
  plan_note(p, PLAN_ALPHA, r->paths.through, -1, 0);
  p->line[PLAN_ALPHA].all = r->paths.shadows;
  plan_note(p, PLAN_SEGMENTS,
            (uint64_t)(j->world.max_depth - j->world.lamps_only), -1, 0);
  plan_note(p, PLAN_SQUARES, r->squares, -1, 0);
  plan_note(p, PLAN_ESTIMATE, j->settings.guide != NULL, -1, 0);
  if (j->jury.pixels > 0)
    p->line[PLAN_ESTIMATE].why =
        arena_format(j->shot.mem, "a jury: %llu pixels by %llu samples more",
                     (unsigned long long)j->jury.pixels,
                     (unsigned long long)j->jury.samples);
  cmd_forced_tables(p, &j->shot);
}

void render_plan_note_output(render_job *j) {
  const render_result *r = &j->result;
  uint64_t films = 0;
  double pixel = sizeof(vec3) * (double)r->color.width * r->color.height;
  for (int i = 0; i < 3; i++)
    films += r->aov[i].pixels != NULL;
  plan_note(&j->plan, PLAN_FILMS, films, -1, pixel * (double)films);
  plan_note(&j->plan, PLAN_PIXELS,
            (uint64_t)r->color.width * (uint64_t)r->color.height, -1,
            r->film_bytes > 0 ? (double)r->film_bytes : pixel);
  plan_note(&j->plan, PLAN_POST, j->out.frosted, -1, 0);
}
