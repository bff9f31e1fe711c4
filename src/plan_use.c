// plan_use.c

#include "plan_use.h"

void plan_prune(const plan *p, scene *s) {
  s->lights = p->lamps;
  s->light_count = p->lamp_count;
  if (p->of.no_skip) return;
  if (!plan_needs(p, PLAN_TEXCOORDS)) s->mesh.texcoord_index = NULL;
  if (p->black) s->env.kind = ENV_NONE;
}

void plan_settle(const plan *p, raster_settings *set) {
  set->lights = p->lamp_count > 0;
  set->shadows = plan_needs(p, PLAN_SHADOW_MAPS);
  set->sky = plan_needs(p, PLAN_SKY);
  set->thorough = p->of.no_skip;
  set->spared = (raster_spared){0};
  if (p->of.no_skip) return;
  set->spared = (raster_spared){.outside = true,
                                .edges = true,
                                .covered = p->line[PLAN_SKY].at_most,
                                .unseen = p->sight.unseen};
}

void plan_settle_paths(const plan *p, path_world *world) {
  world->lights = p->lamp_count > 0;
  world->max_depth = p->of.max_depth;
  world->lamps_only = p->lamps_only;
  world->thorough = p->of.no_skip;
}

static vec2 dark_place(const void *self, uint64_t pixel, uint32_t sample) {
  const integrator *real = self;
  return real->place(real->self, pixel, sample);
}

static void *no_room(const void *self, arena *mem) {
  (void)self;
  (void)mem;
  return NULL;
}

static void no_radiance(const void *self, const path_start *starts, size_t n,
                        vec3 *out, path_stats *stats, void *room) {
  (void)self;
  (void)starts;
  (void)stats;
  (void)room;
  for (size_t i = 0; i < n; i++)
    out[i] = vec3_all(0);
}

integrator plan_dark(const integrator *real) {
  return (integrator){real, dark_place, no_room, no_radiance, NULL};
}
