// view_paths.c — the trick: a pass is one sample a pixel, cut into tiles so
// small that the threads can be told to stop at any time.

#include "view_paths.h"

#include "build.h"
#include "film.h"
#include "path.h"
#include "ready.h"
#include "wide.h"

#include <assert.h>
#include <string.h>

// Pixels a side of a tile: what a worker finishes before it stops.
enum { TILE_SIDE = 16 };

// All of the scene or its metal-rough triangles alone: a tree and what shines.
typedef struct view_tree {
  wide_tree tree;
  scene lit;  // with this index, for
  light_set lights;
  bool built;
} view_tree;

// What a worker needs to sample a tile.
typedef struct view_worker {
  path_start *starts;
  vec3 *colors;
  void *room;  // of the integrator
} view_worker;

struct view_paths {
  const scene *given;
  view_paths_settings set;
  pool *threads;
  arena *mem;
  scene scene;  // given, with materials as they look
  view_tree all, rough;
  path_world world;
  path_tracer tracer;
  integrator by;
  camera_view view;
  film film;
  arena rooms;  // of the team
  view_worker *team;
  int tiles_across, tile_count;
  int spp;       // passes in the film
  bool running;  // a pass is under way
};

// Anew for each look: a room knows what of its materials is plain.
static void hire_workers(view_paths *p) {
  size_t workers = (size_t)pool_threads(p->threads);
  arena_free(&p->rooms);
  p->team = ARENA_NEW(&p->rooms, view_worker, workers);
  for (size_t i = 0; i < workers; i++) {
    view_worker *w = &p->team[i];
    w->starts = ARENA_NEW(&p->rooms, path_start, TILE_SIDE * TILE_SIDE);
    w->colors = ARENA_NEW(&p->rooms, vec3, TILE_SIDE * TILE_SIDE);
    w->room = p->by.room(p->by.self, &p->rooms);
  }
}

view_paths *view_paths_new(const view_paths_settings *set, pool *threads,
                           arena *mem) {
  view_paths *p = ARENA_NEW(mem, view_paths, 1);
  const scene *s = set->world.scene;
  *p = (view_paths){.given = s, .set = *set, .threads = threads, .mem = mem};
  p->scene = *s;
  p->scene.materials = ARENA_NEW(mem, material, s->material_count + 1);
  p->world = set->world;
  p->world.scene = &p->scene;
  p->film = film_new(mem, set->width, set->height, false);
  p->tracer = (path_tracer){.world = &p->world,
                            .ready = ready_best(),
                            .starts = ready_starts_best(),
                            .sky = ready_sky_best(),
                            .seed = set->seed};
  p->by = path_integrator(&p->tracer);
  p->tiles_across = (set->width + TILE_SIDE - 1) / TILE_SIDE;
  p->tile_count = p->tiles_across * ((set->height + TILE_SIDE - 1) / TILE_SIDE);
  return p;
}

// The index of a mesh in which the triangles of other materials have shrunk
// to their first corner: a tree leaves those out and keeps the numbers.
static const uint32_t *only_rough_index(const scene *s, arena *mem) {
  const mesh *m = &s->mesh;
  uint32_t *index = ARENA_NEW(mem, uint32_t, 3 * m->triangle_count);
  for (size_t i = 0; i < m->triangle_count; i++) {
    const material *of = &s->materials[s->material_of[i]];
    bool keep = of->kind == MATERIAL_METAL_ROUGH;
    for (size_t c = 0; c < 3; c++)
      index[3 * i + c] = m->position_index[3 * i + (keep ? c : 0)];
  }
  return index;
}

// What a look shows, built when it is first asked for.
static const view_tree *tree_for(view_paths *p, const view_look *look) {
  view_tree *t = look->only_rough ? &p->rough : &p->all;
  if (t->built) return t;
  const mesh *m = &p->given->mesh;
  const uint32_t *index =
      look->only_rough ? only_rough_index(p->given, p->mem) : m->position_index;
  arena scratch = {0};
  bvh binary, of = {.positions = m->positions,
                    .index = index,
                    .triangle_count = (uint32_t)m->triangle_count};
  build_tree(&binary, &of, BVH_SAH, &scratch, p->threads);
  wide_tree_build(&t->tree, &binary, p->mem, p->threads);
  arena_free(&scratch);
  t->lit = *p->given;
  t->lit.mesh.position_index = (uint32_t *)index;
  light_set_build(&t->lights, &t->lit, p->world.lights, true, p->mem,
                  p->threads);
  t->built = true;
  return t;
}

// Work of the pool: one sample for each pixel of a tile, the same as of any
// other renderer's pass.
static void sample_tile(void *context, size_t item, int worker) {
  view_paths *p = context;
  view_worker *w = &p->team[worker];
  path_stats stats = {0};
  int x0 = (int)item % p->tiles_across * TILE_SIDE;
  int y0 = (int)item / p->tiles_across * TILE_SIDE;
  size_t n = 0;
  int x1 = x0 + TILE_SIDE < p->set.width ? x0 + TILE_SIDE : p->set.width;
  for (int y = y0; y < y0 + TILE_SIDE && y < p->set.height; y++)
    for (int x = x0; x < x1; x += PATH_ROW) {
      path_row row = {.view = &p->view,
                      .x = x,
                      .y = y,
                      .count = x1 - x < PATH_ROW ? x1 - x : PATH_ROW,
                      .sample = (uint32_t)p->spp};
      row.pixel = (uint64_t)y * (uint64_t)p->set.width + (uint64_t)x;
      integrator_begin(&p->by, &row, w->starts + n);
      n += (size_t)row.count;
    }
  p->by.radiance(p->by.self, w->starts, n, w->colors, &stats, w->room);
  for (size_t i = 0; i < n; i++)
    if (vec3_finite(w->colors[i]))
      film_add(&p->film, (size_t)w->starts[i].pixel, w->colors[i]);
}

static void start_pass(view_paths *p) {
  p->running = true;
  pool_start(p->threads, (size_t)p->tile_count, sample_tile, p);
}

void view_paths_stop(view_paths *p) {
  if (!p->running) return;
  pool_cancel(p->threads);
  pool_wait(p->threads);
  p->running = false;
}

bool view_paths_restart(view_paths *p, const view_look *look, error *err) {
  camera_view view;
  if (!camera_view_of(&view, &look->camera, p->set.width, p->set.height, err))
    return false;
  view_paths_stop(p);
  p->view = view;
  view_materials(p->scene.materials, p->given->materials,
                 p->given->material_count, look);
  const view_tree *t = tree_for(p, look);
  p->world.tracer = wide_tracer(&t->tree);
  p->tracer.lights = &t->lights;
  hire_workers(p);
  size_t pixels = (size_t)p->set.width * (size_t)p->set.height;
  memset(p->film.sum, 0, pixels * sizeof *p->film.sum);
  memset(p->film.count, 0, pixels * sizeof *p->film.count);
  p->spp = 0;
  start_pass(p);
  return true;
}

bool view_paths_poll(view_paths *p, image *out, arena *mem) {
  if (!p->running || !pool_done(p->threads)) return false;
  p->spp++;
  *out = film_image(&p->film, mem);
  start_pass(p);
  return true;
}

image view_paths_finish(view_paths *p, int spp, arena *mem) {
  assert(p->running);
  while (p->spp < spp) {
    pool_wait(p->threads);
    p->spp++;
    if (p->spp < spp) start_pass(p);
  }
  p->running = false;
  return film_image(&p->film, mem);
}

int view_paths_spp(const view_paths *p) {
  return p->spp;
}

void view_paths_free(view_paths *p) {
  if (p == NULL) return;
  view_paths_stop(p);
  arena_free(&p->rooms);
}
