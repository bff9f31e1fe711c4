// rays_versus_embree.c — facet and Embree 3.13 trace the same rays in turn.
//
//   apt-get install libembree-dev && make && cc -std=gnu11 -O2 -iquote src \
//     tests/bench/rays_versus_embree.c \
//     $(ls build/release/src/*.o | grep -v main.o) build/release/*.o \
//     -lembree3 -lpng -ljpeg -lm -lpthread -ldl -o build/rays_versus_embree
//   build/rays_versus_embree MESH.obj...
//
// One line a mesh and kind of ray (src/rays.h): million rays a second of
// Embree, robust, ray by ray; of facet's binary tree; of its wide tree with
// each set of instructions, ray by ray and in streams of 4096; and the last
// over Embree. One thread's processor time, the fastest of ROUNDS (environment,
// default 5); BUILDS (5) is how often trees are built, SIZE (640) and LIMIT
// (400000) are the sizes of the sets, SIMD (default: all) a list of levels,
// KINDS (all) one of kinds.  With HIGH both cut triangles: Embree builds in
// high quality, facet as for --bvh high.  THREADS (1) build; of more than one
// the seconds are those of a clock, so the machine should have nothing else to
// do.

#include "build.h"
#include "bvh_shared.h"
#include "clock.h"
#include "obj.h"
#include "rays.h"
#include "wide.h"

#include <embree3/rtcore.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { CHUNK = 4096, WAYS = 2 + 2 * WIDE_LEVELS };

// Seconds of this thread.
static double thread_seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static long setting(const char *name, long otherwise) {
  const char *text = getenv(name);
  return text != NULL ? strtol(text, NULL, 10) : otherwise;
}

// Seconds of what builds: of this thread's work where it is alone.
static double build_seconds(void) {
  return setting("THREADS", 1) > 1 ? clock_seconds() : thread_seconds();
}

static RTCScene embree_scene(RTCDevice device, const mesh *m) {
  RTCScene scene = rtcNewScene(device);
  if (getenv("HIGH") == NULL)
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene, getenv("HIGH") != NULL
                                     ? RTC_BUILD_QUALITY_HIGH
                                     : RTC_BUILD_QUALITY_MEDIUM);
  RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  float *p = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0,
                                     RTC_FORMAT_FLOAT3, 12, m->position_count);
  memcpy(p, m->positions, 12 * m->position_count);
  uint32_t *i = rtcSetNewGeometryBuffer(
      g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, m->triangle_count);
  memcpy(i, m->position_index, 12 * m->triangle_count);
  rtcCommitGeometry(g);
  rtcAttachGeometry(scene, g);
  rtcReleaseGeometry(g);
  rtcCommitScene(scene);
  return scene;
}

static void embree_trace(RTCScene scene, const ray_set *s, hit *hits) {
  struct RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (size_t i = 0; i < s->count; i++) {
    const ray *r = &s->rays[i];
    struct RTCRayHit q;
    q.ray = (struct RTCRay){r->o.x, r->o.y, r->o.z,  r->tmin, r->d.x, r->d.y,
                            r->d.z, 0,      r->tmax, ~0u,     0,      0};
    q.hit.geomID = q.hit.primID = RTC_INVALID_GEOMETRY_ID;
    if (s->any) {
      rtcOccluded1(scene, &context, &q.ray);
      hits[i].triangle = q.ray.tfar < 0 ? 0 : HIT_NONE;
      continue;
    }
    rtcIntersect1(scene, &context, &q);
    hits[i] = (hit){q.ray.tfar, q.hit.u, q.hit.v, q.hit.primID};
  }
}

static void facet_one(tracer t, const ray_set *s, hit *hits) {
  for (size_t i = 0; i < s->count; i++) {
    hits[i] = (hit){.t = s->rays[i].tmax, .triangle = HIT_NONE};
    if (!s->any)
      t.closest(t.tree, &s->rays[i], &hits[i]);
    else if (t.any(t.tree, &s->rays[i]))
      hits[i].triangle = 0;
  }
}

static void facet_many(tracer t, const ray_set *s, hit *hits) {
  static bool blocked[CHUNK];
  for (size_t i = 0; i < s->count; i += CHUNK) {
    size_t n = s->count - i < CHUNK ? s->count - i : CHUNK;
    if (!s->any) {
      t.closest_many(t.tree, s->rays + i, NULL, hits + i, n);
      continue;
    }
    t.any_many(t.tree, s->rays + i, blocked, n);
    for (size_t k = 0; k < n; k++)
      hits[i + k].triangle = blocked[k] ? 0 : HIT_NONE;
  }
}

// Everything that is compared.
typedef struct contest {
  RTCDevice device;
  pool *threads;
  RTCScene scene;
  bvh binary;
  wide_tree wide;
  double log_ratio[RAYS_KINDS];
  int meshes;
} contest;

static bool wanted(int level) {
  const char *list = getenv("SIMD");
  const wide_level *l = wide_level_at(level);
  return l != NULL && (list == NULL || strstr(list, l->name) != NULL);
}

// Seconds of one of the ways.
static double go(const contest *c, int way, const ray_set *s, hit *hits) {
  double start = thread_seconds();
  if (way == 0)
    embree_trace(c->scene, s, hits);
  else if (way == 1)
    facet_one(bvh_tracer(&c->binary), s, hits);
  else if (way < 2 + WIDE_LEVELS)
    facet_one(wide_tracer_at(&c->wide, wide_level_at(way - 2)), s, hits);
  else
    facet_many(wide_tracer_at(&c->wide, wide_level_at(way - 2 - WIDE_LEVELS)),
               s, hits);
  return thread_seconds() - start;
}

static void compare_kind(contest *c, ray_kind kind, const ray_set *s,
                         arena *mem) {
  hit *hits[2] = {ARENA_NEW(mem, hit, s->count), ARENA_NEW(mem, hit, s->count)};
  double best[WAYS];
  size_t differ = 0;
  for (int w = 0; w < WAYS; w++)
    best[w] = INFINITY;
  for (long k = setting("ROUNDS", 5); k >= 0; k--)
    for (int w = 0; w < WAYS; w++) {
      if (w >= 2 && !wanted((w - 2) % WIDE_LEVELS)) continue;
      if (w == 1 && getenv("SIMD") != NULL) continue;
      best[w] = fmin(best[w], go(c, w, s, hits[w > 0]));
    }
  for (size_t i = 0; i < s->count; i++)
    differ +=
        (hits[0][i].triangle == HIT_NONE) != (hits[1][i].triangle == HIT_NONE);
  printf("%-8s", rays_kind_name(kind));
  double last = 0;
  for (int w = 0; w < WAYS; w++) {
    double rate = (double)s->count / best[w] * 1e-6;
    if (isinf(best[w])) {
      printf("       -");
      continue;
    }
    printf(" %7.3f", last = rate);
  }
  double ratio = last / ((double)s->count / best[0] * 1e-6);
  printf("  x %5.2f   %zu differ\n", ratio, differ);
  fflush(stdout);
  c->log_ratio[kind] += log(ratio);
}

static void build_binary(bvh *b, const mesh *m, arena *mem, pool *threads) {
  bvh of = {.positions = m->positions,
            .index = m->position_index,
            .triangle_count = (uint32_t)m->triangle_count};
  if (getenv("HIGH") != NULL)
    bvh_shared_build(b, &of, INFINITY, mem, threads);
  else
    build_tree(b, &of, BVH_COARSE, mem, threads);
}

// Build in turn, BUILDS (5) times: the least seconds of Embree, of the binary
// tree as --bvh wide has it, and of the wide tree.
static void build_all(contest *c, const mesh *m, arena *mem, double best[3]) {
  best[0] = best[1] = best[2] = INFINITY;
  for (long k = setting("BUILDS", 5); k > 0; k--) {
    arena once = {0}, *to = k == 1 ? mem : &once;
    double t[4] = {build_seconds()};
    c->scene = embree_scene(c->device, m);
    t[1] = build_seconds();
    build_binary(&c->binary, m, to, c->threads);
    t[2] = build_seconds();
    wide_tree_build(&c->wide, &c->binary, to, c->threads);
    t[3] = build_seconds();
    for (int i = 0; i < 3; i++)
      best[i] = fmin(best[i], t[i + 1] - t[i]);
    if (k > 1) rtcReleaseScene(c->scene);
    arena_free(&once);
  }
}

static void compare_mesh(contest *c, const char *path) {
  arena mem = {0};
  mesh m;
  error err;
  if (!obj_read(&m, path, &mem, NULL, NULL, NULL, &err)) {
    fprintf(stderr, "%s\n", err.text);
    exit(3);
  }
  double built[3];
  build_all(c, &m, &mem, built);
  printf("== %s: %zu triangles; build %.4f s, facet %.4f + %.4f, x %.2f; "
         "%.1f bytes a triangle\n",
         path, m.triangle_count, built[0], built[1], built[2],
         (built[1] + built[2]) / built[0],
         (double)wide_tree_bytes(&c->wide) / (double)m.triangle_count);
  ray_source from = {.m = &m, .tree = wide_tracer(&c->wide)};
  from.size = (int)setting("SIZE", 640);
  from.limit = (size_t)setting("LIMIT", 400000);
  const char *kinds = getenv("KINDS");
  for (int k = 0; k < RAYS_KINDS; k++) {
    if (kinds != NULL && strstr(kinds, rays_kind_name((ray_kind)k)) == NULL)
      continue;
    ray_set s;
    arena set = {0};
    rays_generate(&s, (ray_kind)k, &from, &set);
    compare_kind(c, (ray_kind)k, &s, &set);
    arena_free(&set);
  }
  rtcReleaseScene(c->scene);
  arena_free(&mem);
  c->meshes++;
}

int main(int argc, char **argv) {
  arena mem = {0};
  char config[64];
  long threads = setting("THREADS", 1);
  snprintf(config, sizeof config, "threads=%ld,set_affinity=0", threads);
  contest c = {.device = rtcNewDevice(config),
               .threads = pool_new(&mem, (int)threads)};
  printf("%-8s  embree  binary", "Mray/s");
  for (int w = 0; w < 2 * WIDE_LEVELS; w++) {
    const wide_level *l = wide_level_at(w % WIDE_LEVELS);
    printf(" %6.6s%c", l != NULL ? l->name : "-", w < WIDE_LEVELS ? '1' : '*');
  }
  printf("\n");
  for (int i = 1; i < argc; i++)
    compare_mesh(&c, argv[i]);
  printf("geometric mean over %d meshes:", c.meshes);
  for (int k = 0; k < RAYS_KINDS; k++)
    printf("  %s %.2f", rays_kind_name((ray_kind)k),
           exp(c.log_ratio[k] / c.meshes));
  printf("\n");
  rtcReleaseDevice(c.device);
  pool_free(c.threads);
  arena_free(&mem);
  return 0;
}
