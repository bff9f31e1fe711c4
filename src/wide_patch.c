// wide_patch.c

#include "wide_patch.h"

#include "scalar.h"
#include "wide.h"

#include <math.h>

// Nodes that a thread takes at a time, and of how many of these one is looked
// at first.
enum { CHUNK = 16, SAMPLE = 16 };

// What finding has at hand: the parent of each node, and the patch of each
// triangle of a leaf; some nodes at first, in turn all.
typedef struct patch_search {
  const wide_tree *t;
  const wide_level *level;
  uint32_t *parent, *patch;
  uint32_t *place;      // by first triangle of a leaf: the last child it is
  uint32_t every;       // which chunks: of so many one
  uint32_t *levels;     // by chunk: how far patches are above their leaves
  uint32_t *triangles;  // and how many there are
  float unsure;
} patch_search;

static void search_chunk(void *context, size_t item, int worker) {
  const patch_search *s = context;
  const uint32_t chunk = (uint32_t)item * s->every + s->every / 2;
  uint32_t levels = 0, triangles = 0;
  for (uint32_t i = chunk * CHUNK; i < (chunk + 1) * CHUNK; i++) {
    if (i >= s->t->node_count) break;
    const wide_node *w = &s->t->nodes[i];
    for (uint32_t k = 0; k < WIDE; k++) {
      if ((w->valid >> k & 1) == 0 || !(w->child[k] & WIDE_LEAF_BIT)) continue;
      if (s->place[wide_leaf_first(w->child[k])] != WIDE * i + k) continue;
      const wide_leaf_place at = {s->parent, i, w->child[k], s->unsure};
      levels +=
          s->level->patches(s->t, &at, s->patch + wide_leaf_first(w->child[k]));
      triangles += wide_leaf_count(w->child[k]);
    }
  }
  s->levels[item] = levels;
  s->triangles[item] = triangles;
  (void)worker;
}

// Search one chunk of `every`; whether patches are, in the mean, this far above
// their leaves.
static bool search(patch_search *s, uint32_t every, float far, pool *threads) {
  uint32_t levels = 0, triangles = 0, step = CHUNK * every;
  size_t chunks = (s->t->node_count + step - 1) / step;
  s->every = every;
  pool_run(threads, chunks, search_chunk, s);
  for (size_t i = 0; i < chunks; i++) {
    levels += s->levels[i];
    triangles += s->triangles[i];
  }
  return (float)levels >= far * (float)triangles;
}

// A leaf may be the child of many: it is looked at as one of them.
static void find_places(const patch_search *s) {
  const wide_tree *t = s->t;
  for (uint32_t i = 0; i < t->node_count; i++)
    for (uint32_t k = 0; k < WIDE; k++) {
      uint32_t child = t->nodes[i].child[k];
      if ((t->nodes[i].valid >> k & 1) == 0) continue;
      if (child & WIDE_LEAF_BIT)
        s->place[wide_leaf_first(child)] = WIDE * i + k;
      else
        s->parent[child] = i;
    }
}

// The patch by number of a triangle.
static uint32_t *order_patches(const patch_search *s, arena *mem) {
  const wide_tree *t = s->t;
  uint32_t *out = ARENA_NEW(mem, uint32_t, t->patch_count);
  for (uint32_t i = 0; i < t->node_count; i++)
    for (uint32_t k = 0; k < WIDE; k++) {
      uint32_t child = t->nodes[i].child[k];
      if ((t->nodes[i].valid >> k & 1) == 0 || !(child & WIDE_LEAF_BIT))
        continue;
      uint32_t first = wide_leaf_first(child), n = wide_leaf_count(child);
      const uint32_t *number = t->triangles + 10 * (size_t)first + 9 * n;
      for (uint32_t j = 0; j < n; j++)
        out[number[j]] = s->patch[first + j];
    }
  return out;
}

void wide_patches_find(wide_tree *t, uint32_t triangles, arena *mem,
                       pool *threads) {
  arena scratch = {0};
  patch_search s = {.t = t, .level = wide_level_best()};
  t->patches_looked_for = true;
  if (t->nodes == NULL) return;
  size_t chunks = t->node_count / CHUNK + 1;
  s.parent = ARENA_NEW(&scratch, uint32_t, t->node_count);
  s.patch = ARENA_NEW(&scratch, uint32_t, t->triangle_count);
  s.place = ARENA_NEW(&scratch, uint32_t, t->triangle_count);
  s.levels = ARENA_NEW(&scratch, uint32_t, chunks);
  s.triangles = ARENA_NEW(&scratch, uint32_t, chunks);
  float reach = 0;
  for (int k = 0; k < 3; k++)
    reach = float_max(reach, float_max(fabsf(t->lo[k]), fabsf(t->hi[k])));
  s.unsure = 0x1p-19f * reach;
  find_places(&s);
  if (search(&s, SAMPLE, 1.5f, threads) && search(&s, 1, 2, threads)) {
    t->patch_count = triangles;
    t->patch = order_patches(&s, mem);
  }
  arena_free(&scratch);
}
