// wide_patch.c

#include "wide_patch.h"

#include "scalar.h"
#include "wide.h"

#include <math.h>
#include <string.h>

// Levels above their leaves from which on patches pay.
#define FAR 1.25f

// A triangle is large that has this share of half the surface of the tree's
// box.
#define LARGE (1.0f / 256)

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

// Search one chunk of `every`; how far patches are above their leaves, in the
// mean.
static float search(patch_search *s, uint32_t every, pool *threads) {
  uint32_t levels = 0, triangles = 0, step = CHUNK * every;
  size_t chunks = (s->t->node_count + step - 1) / step;
  s->every = every;
  pool_run(threads, chunks, search_chunk, s);
  for (size_t i = 0; i < chunks; i++) {
    levels += s->levels[i];
    triangles += s->triangles[i];
  }
  return (float)levels / float_max((float)triangles, 1);
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
  if (search(&s, SAMPLE, threads) >= FAR) {
    search(&s, 1, threads);
    t->patch_count = triangles;
    t->patch = order_patches(&s, mem);
  }
  arena_free(&scratch);
}

// Half the surface of a box of these sides.
static float half_surface(const float side[3]) {
  return side[0] * side[1] + side[1] * side[2] + side[2] * side[0];
}

// The same of child k of a node.
static float child_surface(const wide_node *n, uint32_t k) {
  float side[3];
  for (int i = 0; i < 3; i++)
    side[i] = n->scale[i] * (float)(n->plane[i][1][k] - n->plane[i][0][k]);
  return half_surface(side);
}

static vec3 corner_of(const uint32_t *leaf, uint32_t n, uint32_t k,
                      uint32_t i) {
  vec3 p;
  memcpy(&p.x, &leaf[(3 * i + 0) * n + k], sizeof p.x);
  memcpy(&p.y, &leaf[(3 * i + 1) * n + k], sizeof p.y);
  memcpy(&p.z, &leaf[(3 * i + 2) * n + k], sizeof p.z);
  return p;
}

// The patches of the large triangles of a leaf: the leaf, or none.
static void patch_large(wide_tree *t, uint32_t child, float area,
                        const wide_level *level) {
  uint32_t n = wide_leaf_count(child), patch[WIDE];
  const uint32_t *leaf = t->triangles + 10 * (size_t)wide_leaf_first(child);
  const wide_leaf_place alone = {.leaf = child};
  bool looked = false;
  for (uint32_t k = 0; k < n; k++) {
    vec3 a = corner_of(leaf, n, k, 0);
    vec3 ab = vec3_sub(corner_of(leaf, n, k, 1), a);
    vec3 ac = vec3_sub(corner_of(leaf, n, k, 2), a);
    if (!(vec3_length(vec3_cross(ab, ac)) >= 2 * area)) continue;
    if (!looked) level->patches(t, &alone, patch);
    looked = true;
    t->patch[leaf[9 * n + k]] = patch[k];
  }
}

void wide_patches_large(wide_tree *t, uint32_t triangles, arena *mem) {
  float side[3];
  if (t->nodes == NULL) return;
  for (int i = 0; i < 3; i++)
    side[i] = t->hi[i] - t->lo[i];
  float area = LARGE * half_surface(side);
  arena scratch = {0};
  uint32_t *waiting = ARENA_NEW(&scratch, uint32_t, t->node_count), count = 1;
  t->patch_count = triangles;
  t->patch = ARENA_NEW(mem, uint32_t, triangles);
  waiting[0] = 0;
  while (count > 0) {
    const wide_node *n = &t->nodes[waiting[--count]];
    for (uint32_t k = 0; k < WIDE; k++) {
      if ((n->valid >> k & 1) == 0 || !(child_surface(n, k) >= 2 * area))
        continue;
      if (n->child[k] & WIDE_LEAF_BIT)
        patch_large(t, n->child[k], area, wide_level_best());
      else
        waiting[count++] = n->child[k];
    }
  }
  arena_free(&scratch);
}
