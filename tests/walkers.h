// walkers.h — somebody who walks a world, what they draw of it, and how like
// two pictures are.

#ifndef WALKERS_H
#define WALKERS_H

#include "path_learn.h"
#include "ready.h"
#include "worlds.h"

// Must stay where it is made ready: parts point at each other.
typedef struct walker {
  light_set lights;
  path_tracer tracer;
  integrator by;
  arena *mem;
  camera camera;  // this and the film are for who draws
  int width, height;
} walker;

static inline void walker_ready(walker *k, const path_world *w, uint64_t seed,
                                arena *mem) {
  *k = (walker){.mem = mem};
  light_set_build(&k->lights, w->scene, w->lights, true, mem, NULL);
  k->tracer = (path_tracer){
      .world = w, .lights = &k->lights, .ready = ready_best(), .seed = seed};
  k->by = path_integrator(&k->tracer);
}

// The view of a film that is `times` as wide and high.
static inline camera_view walker_view(const walker *k, int times) {
  camera_view v;
  error err;
  assert_true(camera_view_of(&v, &k->camera, times * k->width,
                             times * k->height, &err));
  return v;
}

// A lesson of as many paths as those of a larger picture, by a view that lives
// as long as it is needed.
static inline path_film walker_lesson(const walker *k, camera_view *view) {
  enum { TIMES = 4 };
  *view = walker_view(k, TIMES);
  return (path_film){view, TIMES * k->width, TIMES * k->height};
}

// A picture with its variance.
static inline render_result walker_draw(const walker *k, int spp,
                                        pool *threads) {
  camera_view view = walker_view(k, 1);
  render_settings how = {.width = k->width,
                         .height = k->height,
                         .spp = spp,
                         .seed = k->tracer.seed,
                         .by = &k->by,
                         .aovs = RENDER_AOV_VARIANCE};
  render_result r;
  render_run(&r, k->tracer.world, &view, &how, k->mem, threads);
  assert_int_equal(r.non_finite, 0);
  return r;
}

// Another one, by the naive integrator.
static inline render_result walker_draw_naive(const walker *k, int spp,
                                              uint64_t seed) {
  path_naive naive = {k->tracer.world, seed};
  walker slow = *k;
  slow.by = path_naive_integrator(&naive);
  return walker_draw(&slow, spp, NULL);
}

static inline void assert_same_bytes(const render_result *a,
                                     const render_result *b) {
  assert_int_equal(a->color.width, b->color.width);
  assert_int_equal(a->color.height, b->color.height);
  size_t pixels = (size_t)a->color.width * (size_t)a->color.height;
  assert_memory_equal(a->color.pixels, b->color.pixels, pixels * sizeof(vec3));
}

// Threads do not show: whoever learns and draws with 1 and with 7 of them draws
// the same.
static inline void assert_same_lesson(world *w,
                                      void (*ready)(walker *k, world *w),
                                      bool (*learn)(walker *k, pool *threads)) {
  render_result pictures[2];
  for (int i = 0; i < 2; i++) {
    walker k;
    ready(&k, w);
    pool *threads = pool_new(&w->mem, i == 0 ? 1 : 7);
    assert_true(learn(&k, threads));
    pictures[i] = walker_draw(&k, 2, threads);
    pool_free(threads);
  }
  assert_same_bytes(&pictures[0], &pictures[1]);
}

// How far apart two pictures are, in standard errors: as a whole, in the worst
// block, and the mean square over all blocks.
typedef struct likeness {
  double z, worst, square;
  int blocks, blank;  // blank: without variance, these count as alike
} likeness;

// Sums over a block of n x n pixels: of the difference, and of its variance.
static inline void block_sums(const render_result *a, const render_result *b,
                              size_t first, size_t n, double sums[2]) {
  sums[0] = sums[1] = 0;
  for (size_t i = 0; i < n * n; i++) {
    size_t at = first + i / n * (size_t)a->color.width + i % n;
    const vec3 *va = a->aov[3].pixels, *vb = b->aov[3].pixels;
    sums[0] += (double)a->color.pixels[at].y - (double)b->color.pixels[at].y;
    sums[1] += (double)va[at].y + (double)vb[at].y;
  }
}

// By blocks of n x n pixels; n divides width and height.
static inline likeness likeness_of(const render_result *a,
                                   const render_result *b, size_t n) {
  likeness l = {0};
  double difference = 0, variance = 0, sums[2];
  size_t width = (size_t)a->color.width, height = (size_t)a->color.height;
  for (size_t y = 0; y < height; y += n)
    for (size_t x = 0; x < width; x += n) {
      block_sums(a, b, y * width + x, n, sums);
      double z = sums[1] > 0 ? sums[0] / sqrt(sums[1]) : 0;
      difference += sums[0], variance += sums[1];
      l.worst = fmax(l.worst, fabs(z));
      l.square += z * z;
      l.blank += !(sums[1] > 0);
      l.blocks++;
    }
  l.z = difference / sqrt(variance);
  l.square /= l.blocks;
  return l;
}

// The sum over pixels of the variance, relative to what `seen` shows there.
static inline double noise_of(const render_result *r,
                              const render_result *seen) {
  double sum = 0;
  for (int i = 0; i < r->color.width * r->color.height; i++) {
    double mean = (double)seen->color.pixels[i].y;
    sum += (double)r->aov[3].pixels[i].y / (mean * mean + 0.01);
  }
  return sum;
}

#endif
