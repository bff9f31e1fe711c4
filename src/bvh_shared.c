// bvh_shared.c — bundles of a tree, cut, under a tree of their parts.

#include "bvh_shared.h"

#include "build.h"
#include "bvh_bundle.h"
#include "bvh_read.h"
#include "bvh_split.h"
#include "clock.h"
#include "slab.h"
#include "wide_cost.h"

#include <string.h>

// So many refs or bundles are looked at in one go; steps to find how many parts
// there is room for.
enum { CHUNK = 1024, STEPS = 40 };

// No part is made that spares less than this of what a part costs in the mean:
// more parts are more nodes, and all compete for the cache.
#define LEAST_SHARE (1 / 3.0)

// What a box that a ray enters for nothing costs, and what a part costs the
// builder.  Measured, and rough.
#define RAY_SECONDS 6e-9

#define PART_SECONDS 2e-6

// What the threads share.
typedef struct splitter {
  const bvh *plain;
  bvh_bundle *bundles;
  sah_ref *parts;
  float least;  // slab_large
  double area;  // half that of all
  uint32_t bundle_count;
} splitter;

static splitter splitter_of(const bvh *plain, const bvh_source *from) {
  const sah_box *box = &from->root.box;
  aabb all = {{box->lo[0], box->lo[1], box->lo[2]},
              {box->hi[0], box->hi[1], box->hi[2]}};
  return (splitter){
      .plain = plain, .least = slab_large(&all), .area = sah_half_area(box)};
}

// What the wide tree makes one leaf of is a bundle; in order.
static void find_bundles(splitter *s, arena *mem, pool *threads) {
  const bvh *b = s->plain;
  const wide_cost *costs = wide_costs_of(b, mem, threads);
  uint32_t stack[BVH_MAX_DEPTH + 1], top = 0, first = 0;
  s->bundles = ARENA_NEW(mem, bvh_bundle, b->kept);
  stack[top++] = 0;
  while (top > 0) {
    uint32_t node = stack[--top];
    if (!wide_is_leaf(&costs[node])) {
      stack[top++] = b->nodes[node].first + 1;
      stack[top++] = b->nodes[node].first;
      continue;
    }
    bvh_bundle *u = &s->bundles[s->bundle_count++];
    u->first = first;
    u->count = costs[node].below;
    first += u->count;
  }
}

static void measure_some(void *context, size_t item, int worker) {
  (void)worker;
  const splitter *s = context;
  uint32_t begin = (uint32_t)item * CHUNK;
  for (uint32_t i = begin; i < s->bundle_count && i - begin < CHUNK; i++)
    bvh_bundle_measure(s->plain, &s->bundles[i], s->least, s->area);
}

static double parts_of(const bvh_bundle *u, double rate) {
  return fmax(1, floor(rate * sqrt(u->excess) + 0.5));
}

static double parts_of_all(const splitter *s, double rate) {
  double sum = 0;
  for (uint32_t i = 0; i < s->bundle_count; i++)
    sum += parts_of(&s->bundles[i], rate);
  return sum;
}

// Share parts out: of a bundle `rate` times the root of its excess, with the
// largest rate for which there is room and every part is worth its place.
static void share_parts(splitter *s) {
  double flat = 0, roots = 0;
  for (uint32_t i = 0; i < s->bundle_count; i++) {
    flat += s->bundles[i].flat;
    roots += sqrt(s->bundles[i].excess);
  }
  double room = s->bundle_count + s->plain->kept * (BVH_SHARED_PERCENT / 100.0);
  double high = 0, low = 0;
  room = fmin(room, INT32_MAX);
  if (roots > 0)
    high = fmin((1 / LEAST_SHARE - 1) * roots / flat, 2 * room / roots);
  if (parts_of_all(s, high) <= room) low = high;
  for (int i = 0; i < STEPS && low < high; i++) {
    double rate = 0.5 * (low + high);
    if (parts_of_all(s, rate) <= room)
      low = rate;
    else
      high = rate;
  }
  uint64_t at = 0;
  for (uint32_t i = 0; i < s->bundle_count; i++) {
    bvh_bundle *u = &s->bundles[i];
    u->parts = (uint32_t)parts_of(u, low);
    u->at = at;
    at += u->parts;
  }
}

// How many rays repay cutting triangles: a part spares what is left of the
// excess with one less, and all parts must be built over.
static double cut_rays_of(const splitter *s) {
  double spared = 0, parts = 0;
  for (uint32_t i = 0; i < s->bundle_count; i++) {
    const bvh_bundle *u = &s->bundles[i];
    spared += u->excess * (1 - 1.0 / u->parts);
    parts += u->parts;
  }
  return spared > 0 ? parts * PART_SECONDS / (spared * RAY_SECONDS) : HUGE_VAL;
}

// Whether most rays that enter bundles do so for nothing, and cutting could
// spare it.  Where many bundles stay large however they are cut, triangles had
// better be cut one by one.
static bool excess_rules(const splitter *s) {
  double flat = 0, excess = 0;
  for (uint32_t i = 0; i < s->bundle_count; i++) {
    flat += s->bundles[i].flat;
    excess += s->bundles[i].excess;
  }
  return excess > flat;
}

static void cut_some(void *context, size_t item, int worker) {
  (void)worker;
  const splitter *s = context;
  uint32_t begin = (uint32_t)item * CHUNK;
  for (uint32_t i = begin; i < s->bundle_count && i - begin < CHUNK; i++) {
    bvh_bundle *u = &s->bundles[i];
    sah_ref *part = s->parts + u->at;
    u->made = bvh_bundle_cut(s->plain, u, s->least, u->parts, part);
    for (uint32_t k = 0; k < u->made; k++)
      part[k].as.triangle = i;
  }
}

// Close the gaps between the parts of bundles; the root over them.
static bvh_part join_parts(const splitter *s) {
  bvh_part root = {.box = sah_box_empty(), .centres = sah_box_empty()};
  for (uint32_t i = 0; i < s->bundle_count; i++)
    for (uint32_t k = 0; k < s->bundles[i].made; k++) {
      sah_ref r = s->parts[s->bundles[i].at + k];
      sah_box_join(&root.box, &r.box);
      sah_box_join_centre(&root.centres, &r.box);
      s->parts[root.end++] = r;
    }
  return root;
}

// The leaves of a tree over parts get the triangles of their bundles.
static void name_triangles(bvh *b, const splitter *s, const uint32_t *bundle) {
  for (uint32_t i = 0; i < b->node_count; i++) {
    bvh_node *n = &b->nodes[i];
    if (n->count == 0) continue;
    const bvh_bundle *u = &s->bundles[bundle[n->first]];
    n->first = u->first;
    n->count = u->count;
  }
}

// The tree over the parts of bundles.
static void build_cut(bvh *out, splitter *s, arena *mem, pool *threads) {
  arena refs = {0}, scratch = {0};
  const bvh_bundle *last = &s->bundles[s->bundle_count - 1];
  s->parts = ARENA_NEW(&refs, sah_ref, last->at + last->parts);
  pool_run(threads, s->bundle_count / CHUNK + 1, cut_some, s);
  bvh_source from = {s->parts, join_parts(s), BVH_ONES, &refs, build_hands()};
  bvh tree = {.kept = from.root.end};
  bvh_build_source(&tree, &from, &scratch, threads);
  out->node_count = tree.node_count;
  out->depth = tree.depth;
  out->nodes = ARENA_NEW(mem, bvh_node, tree.node_count);
  memcpy(out->nodes, tree.nodes, tree.node_count * sizeof *out->nodes);
  out->order = ARENA_NEW(mem, uint32_t, out->kept);
  memcpy(out->order, s->plain->order, out->kept * sizeof *out->order);
  out->bundle_count = s->bundle_count;
  out->bundles = ARENA_NEW(mem, uint32_t, s->bundle_count + 1);
  for (uint32_t i = 0; i < s->bundle_count; i++)
    out->bundles[i] = s->bundles[i].first;
  out->bundles[s->bundle_count] = out->kept;
  name_triangles(out, s, tree.order);
  out->parts = from.root.end - s->bundle_count;
  out->cost = bvh_cost(out, threads);
  arena_free(&scratch);
}

// The bundles of the plain tree and their parts; false where it is no use.
static bool plan(splitter *s, arena *mem, pool *threads) {
  find_bundles(s, mem, threads);
  pool_run(threads, s->bundle_count / CHUNK + 1, measure_some, s);
  if (!excess_rules(s)) return false;
  share_parts(s);
  return true;
}

void bvh_shared_build(bvh *out, const bvh *mesh, double rays, arena *mem,
                      pool *threads) {
  double start = clock_seconds();
  arena refs = {0}, scratch = {0}, own = {0};
  *out = (bvh){.positions = mesh->positions,
               .index = mesh->index,
               .triangle_count = mesh->triangle_count};
  bvh_source from = {
      .method = BVH_COARSE, .mem = &refs, .hands = build_hands()};
  from.root = bvh_read(&from.refs, out, 0, &refs, threads);
  bvh plain = *out;
  splitter s = splitter_of(&plain, &from);
  double one_by_one = bvh_split_rays(out, &from, &scratch, threads);
  bool large = one_by_one < HUGE_VAL;
  bvh_build_source(&plain, &from, &own, threads);
  bool bundles = large && plan(&s, &scratch, threads);
  double cut_rays = bundles ? cut_rays_of(&s) : one_by_one;
  if (rays > cut_rays && bundles) {
    build_cut(out, &s, mem, threads);
  } else if (rays > cut_rays) {
    bvh_split_build(out, mesh, rays, mem, threads);
  } else {
    *out = plain;
    arena_adopt(mem, &own);
  }
  arena_free(&own);
  arena_free(&scratch);
  out->cut_rays = cut_rays;
  out->seconds = clock_seconds() - start;
}
