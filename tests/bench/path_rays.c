// path_rays.c — what a ray costs inside the renderer: nanoseconds of the rays
// that paths ask for, in the batches in which they ask.
//
//   make && cc -std=gnu11 -O2 -iquote src tests/bench/path_rays.c \
//     $(ls build/release/src/*.o | grep -v main.o) build/release/*.o \
//     -lpng -ljpeg -lm -lpthread -ldl -o build/path_rays
//   tests/bench/scenes.py build/bench
//   build/path_rays build/bench/room.scene build/bench/balls.scene
//
// One line a scene and set of instructions: rays and nanoseconds of one thread
// a ray, closest and any, with whatever else paths do in between.  The fastest
// of ROUNDS (environment, default 3) renders of SPP (2) samples a pixel and up
// to 16 segments; SIMD (default: all) is a list of levels; with PATCHES=0 rays
// look at what they leave, but with LARGE=1 for large triangles.

#include "aim_learn.h"
#include "ready.h"
#include "render.h"
#include "wide.h"
#include "wide_patch.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

// Rays asked of another tracer, with the seconds that these took.
typedef struct watch {
  tracer by;
  double seconds[2];
  uint64_t rays[2];
} watch;

static double thread_seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void note(watch *w, int any, double start, size_t n) {
  if (n == 0) return;
  w->seconds[any] += thread_seconds() - start;
  w->rays[any] += n;
}

static void closest_many(const void *self, const ray *r, const uint32_t *left,
                         hit *hits, size_t n) {
  watch *w = (watch *)self;
  double start = thread_seconds();
  w->by.closest_many(w->by.tree, r, left, hits, n);
  note(w, 0, start, n);
}

static void any_many(const void *self, const ray *r, bool *blocked, size_t n) {
  watch *w = (watch *)self;
  double start = thread_seconds();
  w->by.any_many(w->by.tree, r, blocked, n);
  note(w, 1, start, n);
}

// Rays that are asked one by one are answered, but not counted.
static bool closest(const void *self, const ray *r, hit *h) {
  const watch *w = self;
  return w->by.closest(w->by.tree, r, h);
}

static bool any(const void *self, const ray *r) {
  const watch *w = self;
  return w->by.any(w->by.tree, r);
}

static long setting(const char *name, long otherwise) {
  const char *text = getenv(name);
  return text != NULL ? strtol(text, NULL, 10) : otherwise;
}

// A scene, ready to be walked through.
typedef struct set {
  arena mem;
  scene scene;
  wide_tree tree;
  path_world world;
  light_set lights;
  camera_view view;
} set;

static bool set_load(set *s, const char *path, error *err) {
  scene_options o = {0};
  report r = {.mem = &s->mem};
  if (!scene_load(&s->scene, path, &o, &s->mem, NULL, &r, err)) return false;
  const mesh *m = &s->scene.mesh;
  bvh b;
  bvh_build(&b, m->positions, m->position_index, (uint32_t)m->triangle_count,
            BVH_COARSE, &s->mem, NULL);
  wide_tree_build(&s->tree, &b, &s->mem, NULL);
  if (setting("PATCHES", 1) != 0)
    wide_patches_find(&s->tree, (uint32_t)s->scene.mesh.triangle_count, &s->mem,
                      NULL);
  if (setting("LARGE", 0) != 0 && s->tree.patch == NULL)
    wide_patches_large(&s->tree, (uint32_t)s->scene.mesh.triangle_count,
                       &s->mem);
  s->world = (path_world){.scene = &s->scene, .lights = true, .max_depth = 16};
  s->world.dfg = matter_table(&s->scene, PBR_GGX, &s->mem, NULL);
  s->world.tracer = wide_tracer(&s->tree);
  light_set_build(&s->lights, &s->scene, true, true, &s->mem, NULL);
  return camera_view_of(&s->view, scene_camera(&s->scene, NULL),
                        s->scene.film_width, s->scene.film_height, err);
}

// One render, whose rays are watched but for those of the lessons.
static void draw(const set *s, path_tracer by, watch *w) {
  path_world world = s->world;
  arena mem = {0};
  world.tracer = (tracer){w, closest, any, closest_many, any_many};
  by.world = &world;
  integrator walk = path_integrator(&by);
  render_settings how = {.width = s->scene.film_width,
                         .height = s->scene.film_height,
                         .spp = (int)setting("SPP", 2),
                         .by = &walk};
  render_result out;
  render_run(&out, &world, &s->view, &how, &mem, NULL);
  arena_free(&mem);
}

static void measure(const set *s, const path_tracer *by, const char *name,
                    const wide_level *level) {
  watch best = {0};
  for (long i = 0; i < setting("ROUNDS", 3); i++) {
    watch w = {.by = wide_tracer_at(&s->tree, level)};
    draw(s, *by, &w);
    for (int k = 0; k < 2; k++)
      if (i == 0 || w.seconds[k] < best.seconds[k])
        best.seconds[k] = w.seconds[k], best.rays[k] = w.rays[k];
  }
  printf("%-16s %-7s", name, level->name);
  for (int k = 0; k < 2; k++) {
    if (best.rays[k] == 0) continue;
    printf("  %s %9llu rays %4.0f ns", k == 0 ? "closest" : "any",
           (unsigned long long)best.rays[k],
           1e9 * best.seconds[k] / (double)best.rays[k]);
  }
  printf("\n");
}

static bool bench(const char *path, error *err) {
  set *s = calloc(1, sizeof *s);
  if (!set_load(s, path, err)) return false;
  path_tracer by = {
      .world = &s->world, .lights = &s->lights, .ready = ready_best()};
  path_film lesson = {&s->view, s->scene.film_width, s->scene.film_height};
  path_learn(&s->lights, &by, &lesson, &s->mem, NULL);
  by.aim = aim_learn(&by, &lesson, &s->mem, NULL);
  const char *slash = strrchr(path, '/'), *list = getenv("SIMD");
  for (int i = 0; i < WIDE_LEVELS; i++) {
    const wide_level *l = wide_level_at(i);
    if (l != NULL && (list == NULL || strstr(list, l->name) != NULL))
      measure(s, &by, slash != NULL ? slash + 1 : path, l);
  }
  arena_free(&s->mem);
  free(s);
  return true;
}

int main(int argc, char **argv) {
  error err;
  for (int i = 1; i < argc; i++)
    if (!bench(argv[i], &err)) {
      fprintf(stderr, "path_rays: %s\n", err.text);
      return 1;
    }
  return 0;
}
