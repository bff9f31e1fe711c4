// tree_cache.c

#include "tree_cache.h"

#include "clock.h"

#include <string.h>

// Another number when a builder makes another tree, or nodes or triangles are
// laid out in another way: old files are then ignored.
enum { VERSION = 4 };

static const char KIND[] = "tree";

// All of a tree but its arrays: of the wide one, and of the binary one that it
// was made of.  Eight bytes each, so that there are no gaps.
typedef struct tree_facts {
  float lo[4], hi[4];
  double large, cost, cut_rays;
  uint64_t nodes, triangles, depth;
  uint64_t binary_nodes, refs, parts, kept, dropped, binary_depth;
  uint64_t looked_for, patches;
} tree_facts;

static tree_facts facts_of(const wide_tree *t, const bvh *b) {
  tree_facts f = {.large = (double)t->large,
                  .cost = b->cost,
                  .cut_rays = b->cut_rays,
                  .nodes = t->node_count,
                  .triangles = t->triangle_count,
                  .depth = (uint64_t)t->depth,
                  .binary_nodes = b->node_count,
                  .refs = b->refs,
                  .parts = b->parts,
                  .kept = b->kept,
                  .dropped = b->dropped,
                  .binary_depth = (uint64_t)b->depth,
                  .looked_for = t->patches_looked_for,
                  .patches = t->patch_count};
  memcpy(f.lo, t->lo, sizeof f.lo);
  memcpy(f.hi, t->hi, sizeof f.hi);
  return f;
}

static void set_facts(wide_tree *t, bvh *b, const tree_facts *f) {
  memcpy(t->lo, f->lo, sizeof f->lo);
  memcpy(t->hi, f->hi, sizeof f->hi);
  t->large = (float)f->large;
  t->node_count = (uint32_t)f->nodes;
  t->triangle_count = (uint32_t)f->triangles;
  t->depth = (int)f->depth;
  t->patches_looked_for = f->looked_for != 0;
  t->patch_count = (uint32_t)f->patches;
  b->cost = f->cost;
  b->cut_rays = f->cut_rays;
  b->node_count = (uint32_t)f->binary_nodes;
  b->refs = (uint32_t)f->refs;
  b->parts = (uint32_t)f->parts;
  b->kept = (uint32_t)f->kept;
  b->dropped = (uint32_t)f->dropped;
  b->depth = (int)f->binary_depth;
}

void tree_cache_begin(tree_cache *c, const bvh *b, size_t position_count,
                      pool *threads) {
  cache_key parts[2] = {
      cache_sum(b->positions, position_count * sizeof *b->positions, threads),
      cache_sum(b->index, (size_t)b->triangle_count * 3 * sizeof *b->index,
                threads)};
  c->mesh = CACHE_KEY_START;
  cache_key_add(&c->mesh, parts, sizeof parts);
}

// The key of a tree by the builder that may cut triangles, which did or did
// not, or by the other one.
static cache_key key_of(const tree_cache *c, bool cut) {
  uint32_t head[] = {VERSION, sizeof(wide_node), WIDE, WIDE_LEAF, c->cuts, cut};
  cache_key k = c->mesh;
  cache_key_add(&k, head, sizeof head);
  return k;
}

// Fill the arrays from an open file that is at their beginning.
static bool take_arrays(cache_file *f, wide_tree *t, arena *mem,
                        pool *threads) {
  size_t nodes = t->node_count * sizeof *t->nodes;
  size_t triangles = (size_t)t->triangle_count * 10 * sizeof *t->triangles;
  size_t patches = t->patch_count * sizeof *t->patch;
  if (nodes + triangles + patches != f->left) return false;
  wide_tree_room(t, mem);
  if (patches > 0) t->patch = ARENA_NEW(mem, uint32_t, t->patch_count);
  return cache_take(f, t->nodes, nodes, threads) &&
         cache_take(f, t->triangles, triangles, threads) &&
         (patches == 0 || cache_take(f, t->patch, patches, threads));
}

// The tree of one key, if it is the one that the builder would make for so many
// rays.
static bool load_one(const tree_cache *c, bool cut, wide_tree *t, bvh *b,
                     arena *mem, pool *threads) {
  cache_file f;
  tree_facts facts;
  if (!cache_open(&f, KIND, key_of(c, cut))) return false;
  bool ok = cache_take(&f, &facts, sizeof facts, NULL);
  ok = ok && (facts.patches == 0 || facts.patches == b->triangle_count);
  bool wanted = ok && (!c->cuts || (c->rays > facts.cut_rays) == cut);
  if (wanted) set_facts(t, b, &facts);
  if (wanted) ok = take_arrays(&f, t, mem, threads);
  bool whole = cache_close(&f);
  if (ok && (whole || !wanted)) return wanted;
  cache_remove(KIND, key_of(c, cut));
  return false;
}

bool tree_cache_load(const tree_cache *c, wide_tree *t, bvh *b, arena *mem,
                     pool *threads) {
  double start = clock_seconds();
  const bvh before = *b;
  for (int cut = 0; cut <= c->cuts; cut++) {
    arena own = {0};
    *t = (wide_tree){.depth = 0};
    if (load_one(c, cut, t, b, &own, threads)) {
      t->seconds = clock_seconds() - start;
      arena_adopt(mem, &own);
      return true;
    }
    arena_free(&own);
    *b = before;
  }
  *t = (wide_tree){.depth = 0};
  return false;
}

void tree_cache_save(const tree_cache *c, const wide_tree *t, const bvh *b,
                     uint64_t most, pool *threads) {
  arena mem = {0};
  cache_file there;
  cache_key key = key_of(c, c->cuts && c->rays > b->cut_rays);
  if (!t->patches_looked_for && cache_open(&there, KIND, key)) {
    cache_close(&there);  // by another process, meanwhile
    return;
  }
  tree_facts facts = facts_of(t, b);
  cache_part parts[] = {
      {&facts, sizeof facts},
      {t->nodes, t->node_count * sizeof *t->nodes},
      {t->triangles, (size_t)t->triangle_count * 10 * sizeof *t->triangles},
      {t->patch, t->patch_count * sizeof *t->patch}};
  cache_item item = {.kind = KIND,
                     .key = key,
                     .what = arena_format(&mem, "%u triangles, %s",
                                          b->triangle_count, c->name),
                     .parts = parts,
                     .count = t->patch != NULL ? 4 : 3};
  cache_save(&item, most, threads);
  arena_free(&mem);
}
