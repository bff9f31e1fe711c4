// cmd_bench.c — facet bench load and bench rays: how fast, on this machine.

#include "cmd_tree.h"

#include "clock.h"
#include "normals.h"
#include "obj.h"
#include "rays.h"

#include <math.h>

// The stages of reading an OBJ.
enum { LOAD_STAGES = 5 };

// Seconds of one reading, stage by stage; the last is the whole.
typedef struct load_run {
  double seconds[LOAD_STAGES];
  size_t bytes, triangles;
} load_run;

static const char *const load_names[LOAD_STAGES] = {
    "read and parse", "merge", "triangulate", "normals", "all",
};

// The same as JSON keys.
static const char *const load_keys[LOAD_STAGES] = {
    "read_parse", "merge", "triangulate", "normals", "total",
};

// Read the file once.
static bool load_once(load_run *out, const options *o, pool *threads,
                      error *err) {
  arena mem = {0};
  mesh m;
  obj_times times;
  double start = clock_seconds();
  if (!obj_read(&m, o->operands[0], &mem, threads, NULL, &times, err)) {
    arena_free(&mem);
    return false;
  }
  double before = clock_seconds();
  normals_generate(&m, (normals_mode)o->value[OPT_NORMALS].words,
                   o->value[OPT_CREASE].number[0], &mem, threads);
  double end = clock_seconds();
  *out = (load_run){{times.read_parse, times.merge, times.triangulate,
                     end - before, end - start},
                    times.bytes,
                    m.triangle_count};
  arena_free(&mem);
  return true;
}

// The medians, as a table or as JSON.
static void print_load(const options *o, const load_run *median, int threads) {
  double mb = (double)median->bytes * 1e-6;
  if (!o->value[OPT_JSON].given) {
    printf("%s: %.1f MB, %zu triangles, %d threads, median of %lld\n",
           o->operands[0], mb, median->triangles, threads,
           o->value[OPT_REPEAT].whole[0]);
    for (int i = 0; i < LOAD_STAGES; i++)
      printf("%-15s %8.4f s %9.1f MB/s\n", load_names[i], median->seconds[i],
             mb / fmax(median->seconds[i], 1e-9));
    return;
  }
  json j = {.out = stdout};
  json_open(&j, NULL, '{');
  json_text(&j, "file", o->operands[0]);
  json_count(&j, "bytes", median->bytes);
  json_count(&j, "triangles", median->triangles);
  json_count(&j, "threads", (unsigned long long)threads);
  json_open(&j, "seconds", '{');
  for (int i = 0; i < LOAD_STAGES; i++)
    json_number(&j, load_keys[i], median->seconds[i]);
  json_close(&j, '{');
  json_open(&j, "mb_per_second", '{');
  for (int i = 0; i < LOAD_STAGES; i++)
    json_number(&j, load_keys[i], mb / fmax(median->seconds[i], 1e-9));
  json_close(&j, '{');
  json_close(&j, '{');
  json_end(&j);
}

int cmd_bench_load(const options *o) {
  arena mem = {0};
  error err;
  pool *threads = pool_new(&mem, cmd_threads(o));
  size_t repeat = (size_t)o->value[OPT_REPEAT].whole[0];
  double *seconds = ARENA_NEW(&mem, double, repeat *LOAD_STAGES);
  load_run run = {0};
  int code = EXIT_DONE;
  for (size_t k = 0; k < repeat && code == EXIT_DONE; k++) {
    if (!load_once(&run, o, threads, &err))
      code = cmd_fail(o, EXIT_INPUT, "%s", err.text);
    for (size_t i = 0; i < LOAD_STAGES; i++)
      seconds[i * repeat + k] = run.seconds[i];
  }
  for (size_t i = 0; i < LOAD_STAGES; i++)
    run.seconds[i] = cmd_median(seconds + i * repeat, repeat);
  if (code == EXIT_DONE) print_load(o, &run, pool_threads(threads));
  pool_free(threads);
  arena_free(&mem);
  return code;
}

// What bench rays measures.
typedef struct rays_run {
  const options *o;
  mesh m;
  cmd_tree tree;
  ray_set set;
  hit *hits;
  double build_seconds, trace_seconds;
  pool *threads;
} rays_run;

// Bytes of the tree and of the triangles as it reads them, per triangle.
static double bytes_per_triangle(const rays_run *r) {
  return (double)cmd_tree_bytes(&r->tree) /
         fmax((double)r->m.triangle_count, 1);
}

static int tree_depth(const rays_run *r) {
  return r->tree.wide.nodes != NULL ? r->tree.wide.depth : r->tree.binary.depth;
}

// Numbers for people or machines.
static void print_rays(const rays_run *r, size_t repeat) {
  const options *o = r->o;
  double rate = (double)r->set.count / fmax(r->trace_seconds, 1e-12) * 1e-6;
  size_t found = rays_count_hits(r->hits, r->set.count);
  const char *kind = o->value[OPT_RAYS].given
                         ? o->value[OPT_RAYS].text
                         : rays_kind_name((ray_kind)o->value[OPT_KIND].words);
  if (!o->value[OPT_JSON].given) {
    printf("%s: %zu triangles, %d threads, median of %zu\n", o->operands[0],
           r->m.triangle_count, pool_threads(r->threads), repeat);
    printf("build   %.4f s, cost %.2f, depth %d, %.1f bytes a triangle\n",
           r->build_seconds, r->tree.binary.cost, tree_depth(r),
           bytes_per_triangle(r));
    printf("rays    %zu of kind %s, %zu hits\n", r->set.count, kind, found);
    printf("trace   %.4f s, %.3f million rays a second\n", r->trace_seconds,
           rate);
    return;
  }
  json j = {.out = stdout};
  json_open(&j, NULL, '{');
  json_text(&j, "file", o->operands[0]);
  json_text(&j, "kind", kind);
  json_count(&j, "triangles", r->m.triangle_count);
  json_count(&j, "rays", r->set.count);
  json_count(&j, "hits", found);
  json_count(&j, "threads", (unsigned long long)pool_threads(r->threads));
  json_number(&j, "build_seconds", r->build_seconds);
  json_number(&j, "sah_cost", r->tree.binary.cost);
  json_count(&j, "parts", r->tree.binary.parts);
  json_count(&j, "depth", (unsigned long long)tree_depth(r));
  json_number(&j, "bytes_per_triangle", bytes_per_triangle(r));
  json_number(&j, "seconds", r->trace_seconds);
  json_number(&j, "mrays_per_second", rate);
  json_close(&j, '{');
  json_end(&j);
}

// Build the tree `repeat` times; the median counts.  All but the last are
// thrown away at once.
static void build_trees(rays_run *r, size_t repeat, arena *mem) {
  double *seconds = ARENA_NEW(mem, double, repeat);
  // The rays are made with the tree; most sets have about so many.
  r->tree.rays = (double)repeat * 0x1p20;
  for (size_t k = 0; k < repeat; k++) {
    arena once = {0};
    arena *into = k + 1 == repeat ? mem : &once;
    cmd_tree_build(&r->tree, r->o, &r->m, into, r->threads);
    seconds[k] = r->tree.seconds;
    arena_free(&once);
  }
  r->build_seconds = cmd_median(seconds, repeat);
}

// Read or make the rays; an exit code.
static int get_rays(rays_run *r, arena *mem) {
  const options *o = r->o;
  error err;
  if (o->value[OPT_RAYS].given) {
    if (rays_load(&r->set, o->value[OPT_RAYS].text, mem, &err))
      return EXIT_DONE;
    return cmd_fail(o, EXIT_INPUT, "%s", err.text);
  }
  ray_source from = {.m = &r->m, .tree = r->tree.tracer, .threads = r->threads};
  rays_generate(&r->set, (ray_kind)o->value[OPT_KIND].words, &from, mem);
  return EXIT_DONE;
}

// Everything once the pool is there.
static int run_rays(rays_run *r, arena *mem) {
  const options *o = r->o;
  size_t repeat = (size_t)o->value[OPT_REPEAT].whole[0];
  error err;
  if (!obj_read(&r->m, o->operands[0], mem, r->threads, NULL, NULL, &err))
    return cmd_fail(o, EXIT_INPUT, "%s", err.text);
  build_trees(r, repeat, mem);
  int code = get_rays(r, mem);
  if (code != EXIT_DONE) return code;
  r->hits = ARENA_NEW(mem, hit, r->set.count);
  r->trace_seconds =
      rays_trace(r->hits, &r->set, r->tree.tracer, r->threads, (int)repeat);
  const char *hits = o->value[OPT_HITS].text;
  if (hits != NULL && !rays_save_hits(&r->set, r->hits, hits, &err))
    return cmd_fail(o, EXIT_OUTPUT, "%s", err.text);
  print_rays(r, repeat);
  return EXIT_DONE;
}

int cmd_bench_rays(const options *o) {
  arena mem = {0};
  rays_run r = {.o = o, .threads = pool_new(&mem, cmd_threads(o))};
  int code = run_rays(&r, &mem);
  pool_free(r.threads);
  arena_free(&mem);
  return code;
}
