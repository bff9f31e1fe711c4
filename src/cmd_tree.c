// cmd_tree.c

#include "cmd_tree.h"

#include "build.h"
#include "bvh_shared.h"
#include "clock.h"
#include "wide_patch.h"

#include <math.h>

// The words of --bvh, in the order of its row in the table of options.
enum { TREE_AUTO, TREE_BINARY, TREE_WIDE, TREE_BRUTE, TREE_FAST, TREE_HIGH };

// What to expect where the number of samples is open, and the rays of a path.
enum { SPP_GUESS = 64, RAYS_A_PATH = 4 };

double cmd_tree_rays(int width, int height, int spp) {
  return (double)width * height * (spp > 0 ? spp : SPP_GUESS) * RAYS_A_PATH;
}

// A mesh as builders of trees want it, with no tree yet.
static bvh mesh_as_bvh(const mesh *m) {
  return (bvh){.positions = m->positions,
               .index = m->position_index,
               .triangle_count = (uint32_t)m->triangle_count};
}

// The binary tree: cut triangles or not, as the word says or the rays repay.
static void build_binary(cmd_tree *t, long long word, const mesh *m, arena *mem,
                         pool *threads) {
  bvh of = mesh_as_bvh(m);
  if (word == TREE_AUTO || word == TREE_HIGH) {
    double rays = word == TREE_HIGH ? HUGE_VAL : t->rays;
    bvh_shared_build(&t->binary, &of, rays, mem, threads);
    return;
  }
  bool coarse = word == TREE_WIDE || word == TREE_FAST;
  build_tree(&t->binary, &of, coarse ? BVH_COARSE : BVH_SAH, mem, threads);
}

// Ask the cache for a wide tree; false when it must be built.  Then *c, if it
// has a name, is what to save it under.
static bool load_wide(cmd_tree *t, tree_cache *c, long long word, const mesh *m,
                      arena *mem, pool *threads) {
  double start = clock_seconds();
  bool wide = word != TREE_BINARY && word != TREE_BRUTE;
  if (!wide || t->name == NULL || cache_limit() == 0 ||
      m->triangle_count < TREE_CACHE_LEAST)
    return false;
  t->binary = mesh_as_bvh(m);
  *c = (tree_cache){.cuts = word == TREE_AUTO || word == TREE_HIGH,
                    .rays = word == TREE_HIGH ? HUGE_VAL : t->rays,
                    .name = t->name};
  tree_cache_begin(c, &t->binary, m->position_count, threads);
  t->from_cache = tree_cache_load(c, &t->wide, &t->binary, mem, threads);
  t->seconds = clock_seconds() - start;
  if (t->from_cache) t->tracer = wide_tracer(&t->wide);
  return t->from_cache;
}

// Keep a tree that was built.
static void save_wide(cmd_tree *t, const tree_cache *c, pool *threads) {
  if (c->name == NULL || t->wide.nodes == NULL) return;
  double start = clock_seconds();
  tree_cache_save(c, &t->wide, &t->binary, cache_limit(), threads);
  t->save_seconds = clock_seconds() - start;
}

// Look for patches where the rays repay it, or forget those that another run
// has found where nothing is to be skipped; true when the cache has not seen
// them.
static bool find_patches(cmd_tree *t, const options *o, const mesh *m,
                         arena *mem, pool *threads) {
  wide_tree *w = &t->wide;
  double least = (double)WIDE_PATCH_RAYS * (double)m->triangle_count;
  if (o->value[OPT_NO_SKIP].given) {
    w->patch = NULL;
    w->patch_count = 0;
    return false;
  }
  if (!t->paths || w->nodes == NULL || w->patches_looked_for ||
      !(t->rays >= least))
    return false;
  double start = clock_seconds();
  wide_patches_find(w, (uint32_t)m->triangle_count, mem, threads);
  t->seconds += clock_seconds() - start;
  return true;
}

// Where patches were not looked for, or do not pay, those of a few.
static void find_large(cmd_tree *t, const options *o, const mesh *m,
                       arena *mem) {
  t->patches = t->wide.patch != NULL;
  if (t->paths && !t->patches && !o->value[OPT_NO_SKIP].given)
    wide_patches_large(&t->wide, (uint32_t)m->triangle_count, mem);
}

void cmd_tree_build(cmd_tree *out, const options *o, const mesh *m, arena *mem,
                    pool *threads) {
  long long word = o->value[OPT_BVH].words;
  bool wide = word != TREE_BINARY && word != TREE_BRUTE;
  arena scratch = {0};
  tree_cache cache = {.name = NULL};
  *out = (cmd_tree){.rays = out->rays, .paths = out->paths, .name = out->name};
  if (load_wide(out, &cache, word, m, mem, threads)) {
    if (find_patches(out, o, m, mem, threads)) save_wide(out, &cache, threads);
    find_large(out, o, m, mem);
    return;
  }
  build_binary(out, word, m, wide ? &scratch : mem, threads);
  out->seconds = out->binary.seconds;
  if (wide) wide_tree_build(&out->wide, &out->binary, mem, threads);
  if (out->wide.nodes == NULL) {
    out->tracer = word == TREE_BRUTE ? brute_tracer(&out->binary)
                                     : bvh_tracer(&out->binary);
    arena_adopt(mem, &scratch);
    return;
  }
  out->seconds += out->wide.seconds;
  find_patches(out, o, m, mem, threads);
  out->tracer = wide_tracer(&out->wide);
  out->binary.nodes = NULL;
  out->binary.order = NULL;
  arena_free(&scratch);
  save_wide(out, &cache, threads);
  find_large(out, o, m, mem);
}

size_t cmd_tree_bytes(const cmd_tree *t) {
  if (t->wide.nodes != NULL) return wide_tree_bytes(&t->wide);
  const bvh *b = &t->binary;
  return b->node_count * sizeof(bvh_node) + b->refs * sizeof(uint32_t) +
         (size_t)b->triangle_count * 3 * sizeof(uint32_t);
}

void cmd_tree_json(json *j, const cmd_tree *t) {
  bool wide = t->wide.nodes != NULL;
  json_text(j, "kind", wide ? "wide" : "binary");
  json_count(j, "nodes", wide ? t->wide.node_count : t->binary.node_count);
  json_count(j, "binary_nodes", t->binary.node_count);
  json_number(j, "cost", t->binary.cost);
  json_count(j, "parts", t->binary.parts);
  json_number(j, "rays_expected", t->rays);
  json_flag(j, "patches", t->patches);
  int depth = wide ? t->wide.depth : t->binary.depth;
  json_count(j, "depth", (unsigned long long)depth);
  json_count(j, "dropped", t->binary.dropped);
  json_count(j, "bytes", cmd_tree_bytes(t));
  json_flag(j, "from_cache", t->from_cache);
}
