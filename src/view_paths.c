// view_paths.c — the trick: a pass is one sample a pixel, cut into tiles so
// small that the threads can be told to stop at any time.

#include "view_paths.h"

#include "bvh.h"
#include "film.h"

#include <assert.h>
#include <string.h>

// Pixels a side of a tile: what a worker finishes before it stops.
enum { TILE_SIDE = 16 };

// A tree over all of the scene or over its metal-rough triangles.
typedef struct view_tree {
  bvh tree;
  bool built;
} view_tree;

struct view_paths {
  const scene *given;
  view_paths_settings set;
  pool *threads;
  arena *mem;
  scene scene;  // given, with materials as they look
  view_tree all, rough;
  path_world world;
  camera_view view;
  film film;
  path_stats *stats;  // by worker
  int tiles_across, tile_count;
  int spp;       // passes in the film
  bool running;  // a pass is under way
};

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
  p->stats = ARENA_NEW(mem, path_stats, (size_t)pool_threads(threads));
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

// The tree for a look, built when it is first asked for.
static const bvh *tree_for(view_paths *p, const view_look *look) {
  view_tree *t = look->only_rough ? &p->rough : &p->all;
  if (t->built) return &t->tree;
  const mesh *m = &p->given->mesh;
  const uint32_t *index =
      look->only_rough ? only_rough_index(p->given, p->mem) : m->position_index;
  bvh_build(&t->tree, m->positions, index, (uint32_t)m->triangle_count, BVH_SAH,
            p->mem, p->threads);
  t->built = true;
  return &t->tree;
}

// One more sample of pixel (x, y), the same as of any other renderer's pass.
static void sample_pixel(view_paths *p, int x, int y, path_stats *stats) {
  size_t i = (size_t)y * (size_t)p->set.width + (size_t)x;
  rng random = rng_of(p->set.seed, i, (uint64_t)p->spp);
  float dx = rng_next(&random), dy = rng_next(&random);
  ray r = camera_ray(&p->view, (float)x + dx, (float)y + dy);
  vec3 color = path_naive_radiance(&p->world, r, &random, stats);
  if (vec3_finite(color)) film_add(&p->film, i, color);
}

// Work of the pool: one sample for each pixel of a tile.
static void sample_tile(void *context, size_t item, int worker) {
  view_paths *p = context;
  path_stats stats = {0};
  int x0 = (int)item % p->tiles_across * TILE_SIDE;
  int y0 = (int)item / p->tiles_across * TILE_SIDE;
  for (int y = y0; y < y0 + TILE_SIDE && y < p->set.height; y++)
    for (int x = x0; x < x0 + TILE_SIDE && x < p->set.width; x++)
      sample_pixel(p, x, y, &stats);
  p->stats[worker].rays += stats.rays;
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
  p->world.tracer = bvh_tracer(tree_for(p, look));
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
  if (p != NULL) view_paths_stop(p);
}
