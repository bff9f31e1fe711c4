// cmd_forced.c

#include "cmd_forced.h"

#include "clock.h"
#include "cmd_tree.h"
#include "dfg.h"
#include "lean.h"
#include "light_env.h"

// The sky that stands in where a scene has none to sum up.
static env stand_in(const env *e) {
  bool map = e->kind == ENV_MAP && e->map.pixels != NULL;
  return map ? *e : (env){.kind = ENV_SKY, .scale = 1};
}

static void force_table(const plan *p, const shot *s, arena *mem) {
  dfg table;
  dfg_build(&table, p->of.model, mem, s->threads);
}

static void force_lean(const plan *p, const shot *s, arena *mem) {
  (void)p;
  lean table;
  lean_build(&table, mem, s->threads);
}

static void force_sums(const plan *p, const shot *s, arena *mem) {
  ibl made;
  env e = stand_in(&s->scene.env);
  ibl_need need = {.model = p->of.model, .diffuse = true, .all = true};
  ibl_make(&made, &e, &need, mem, s->threads);
}

static void force_directions(const plan *p, const shot *s, arena *mem) {
  (void)p;
  light_env made;
  env e = stand_in(&s->scene.env);
  light_env_build(&made, &e, mem, s->threads);
}

// A stage, and who does it for nothing.
typedef struct forced_stage {
  plan_stage stage;
  void (*force)(const plan *p, const shot *s, arena *mem);
} forced_stage;

static const forced_stage STAGES[] = {{PLAN_TABLE, force_table},
                                      {PLAN_LEAN, force_lean},
                                      {PLAN_IBL, force_sums},
                                      {PLAN_ENV_TABLE, force_directions}};

void cmd_forced_tables(plan *p, const shot *s) {
  if (!p->of.no_skip) return;
  for (size_t i = 0; i < sizeof STAGES / sizeof *STAGES; i++) {
    plan_line *l = &p->line[STAGES[i].stage];
    if (!l->told || l->did >= l->need) continue;
    arena once = {0};
    double start = clock_seconds();
    STAGES[i].force(p, s, &once);
    arena_free(&once);
    double before = l->seconds > 0 ? l->seconds : 0;
    plan_note(p, STAGES[i].stage, l->need, before + clock_seconds() - start,
              l->bytes);
  }
}

void cmd_forced_tree(plan *p, const shot *s) {
  if (!plan_needs(p, PLAN_TREE)) return;
  arena once = {0};
  cmd_tree tree = {.rays = cmd_tree_rays(s->width, s->height, 0)};
  cmd_tree_build(&tree, s->o, &s->scene.mesh, &once, s->threads);
  plan_note(p, PLAN_TREE, 1, tree.seconds, (double)cmd_tree_bytes(&tree));
  arena_free(&once);
}
