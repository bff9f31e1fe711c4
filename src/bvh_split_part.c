// bvh_split_part.c — two ways to part a node: triangles to either side, or
// space, and with it the triangles that lie across.

#include "bvh_split_part.h"

#include "bvh_split_clip.h"

// Cuts of space are tried where the two sides of the best other cut overlap by
// more than this share of the root's area.  Source: Stich and others 2009.
#define LEAST_OVERLAP 1e-5

// A node being parted.
typedef struct parting {
  const bvh_split_shop *shop;
  const bvh_split_node *n;
  bvh_cut cut;          // of the refs
  bvh_split_cut space;  // of space, when its axis is not -1
  bvh_split_grid grid;
  uint32_t chunk_count;
} parting;

static void run(parting *p, pool_work work) {
  pool_run(p->shop->threads, p->chunk_count, work, p);
}

static void corners_of(vec3 out[3], const bvh *b, uint32_t triangle) {
  const uint32_t *v = b->index + 3 * (size_t)triangle;
  for (int i = 0; i < 3; i++)
    out[i] = b->positions[v[i]];
}

static void bin_refs(void *context, size_t item, int worker) {
  (void)worker;
  const parting *p = context;
  bvh_split_chunk *c = &p->shop->chunks[item];
  sah_bins_clear(&c->bins, &p->cut.grid);
  sah_bins_add(&c->bins, &p->cut.grid, p->shop->refs[p->n->array] + c->begin,
               c->end - c->begin);
}

static void bin_parts(void *context, size_t item, int worker) {
  (void)worker;
  const parting *p = context;
  bvh_split_chunk *c = &p->shop->chunks[item];
  bvh_split_bins_clear(&c->parts);
  for (uint32_t i = c->begin; i < c->end; i++) {
    const sah_ref *r = &p->shop->refs[p->n->array][i];
    if (r->as.unused != SPLIT_LARGE) {
      bvh_split_bins_add(&c->parts, &p->grid, &r->box);
      continue;
    }
    vec3 corner[3];
    corners_of(corner, p->shop->b, r->as.triangle);
    bvh_split_bins_add_parts(&c->parts, &p->grid, &r->box, corner);
  }
}

// The area of a grown to hold b.
static double joint_area(const sah_box *a, const sah_box *b) {
  sah_box both = *a;
  sah_box_join(&both, b);
  return sah_half_area(&both);
}

// Of a ref across the plane: whether it costs less to have it whole on one
// side, which then grows, than in part on both.  Source: Stich and others
// 2009, "reference unsplitting".
static bool keep_whole(const bvh_split_cut *cut, const sah_box *box,
                       int *side) {
  double area[2], cost[2], both = 0;
  for (int k = 0; k < 2; k++) {
    area[k] = sah_half_area(&cut->side[k]);
    both += area[k] * cut->count[k];
  }
  for (int k = 0; k < 2; k++)
    cost[k] = joint_area(&cut->side[k], box) * cut->count[k] +
              area[1 - k] * ((double)cut->count[1 - k] - 1);
  *side = cost[1] < cost[0];
  return cost[*side] < both;
}

// What of a ref goes to either side: bit k when part[k] goes to side k.
static int part_ref(const parting *p, const sah_ref *r, uint32_t position,
                    sah_ref part[2]) {
  part[0] = part[1] = *r;
  const bvh_split_cut *cut = &p->space;
  if (cut->axis < 0)
    return bvh_cut_left(&p->cut, &p->n->part, r, position) ? 1 : 2;
  if (r->as.unused != SPLIT_LARGE) return 1 << bvh_split_side(cut, &r->box);
  if (r->box.hi[cut->axis] <= cut->at) return 1;
  if (r->box.lo[cut->axis] >= cut->at) return 2;
  int side;
  if (keep_whole(cut, &r->box, &side)) return 1 << side;
  vec3 corner[3];
  corners_of(corner, p->shop->b, r->as.triangle);
  bvh_outline of = bvh_outline_of(corner);
  bvh_slice below = {cut->axis, -INFINITY, cut->at};
  bvh_slice above = {cut->axis, cut->at, INFINITY};
  int sides = (bvh_split_clip(&part[0].box, &r->box, &of, below) ? 1 : 0) |
              (bvh_split_clip(&part[1].box, &r->box, &of, above) ? 2 : 0);
  part[0].as.triangle = part[1].as.triangle = r->as.triangle;
  part[0].as.unused = part[1].as.unused = SPLIT_LARGE;
  return sides;
}

static void count_sides(void *context, size_t item, int worker) {
  (void)worker;
  const parting *p = context;
  bvh_split_chunk *c = &p->shop->chunks[item];
  c->count[0] = c->count[1] = 0;
  for (uint32_t i = c->begin; i < c->end; i++) {
    sah_ref part[2];
    int sides = part_ref(p, &p->shop->refs[p->n->array][i], i, part);
    c->count[0] += (sides & 1) != 0;
    c->count[1] += (sides & 2) != 0;
  }
}

// Move the refs of a chunk to their sides of the other array, in order.
static void move_refs(void *context, size_t item, int worker) {
  (void)worker;
  const parting *p = context;
  bvh_split_chunk *c = &p->shop->chunks[item];
  const sah_ref *from = p->shop->refs[p->n->array];
  sah_ref *to = p->shop->refs[1 - p->n->array];
  for (int k = 0; k < 2; k++) {
    c->box[k] = c->centres[k] = sah_box_empty();
    c->large[k] = 0;
  }
  uint32_t at[2] = {c->to[0], c->to[1]};
  for (uint32_t i = c->begin; i < c->end; i++) {
    sah_ref part[2];
    int sides = part_ref(p, &from[i], i, part);
    for (int k = 0; k < 2; k++) {
      if (!(sides & 1 << k)) continue;
      to[at[k]++] = part[k];
      sah_box_join(&c->box[k], &part[k].box);
      sah_box_join_centre(&c->centres[k], &part[k].box);
      c->large[k] += part[k].as.unused == SPLIT_LARGE;
    }
  }
}

// Divide the node's refs into chunks.
static void make_chunks(parting *p) {
  const bvh_part *part = &p->n->part;
  p->chunk_count = 0;
  for (uint32_t at = part->begin; at < part->end;) {
    bvh_split_chunk *c = &p->shop->chunks[p->chunk_count++];
    c->begin = at;
    at = part->end - at < p->shop->chunk_size ? part->end
                                              : at + p->shop->chunk_size;
    c->end = at;
  }
}

// Choose a cut of the refs; false when a leaf costs less.
static bool choose_cut(parting *p) {
  const bvh_split_node *n = p->n;
  // The room and not the refs bounds the depth: all below may fill it.
  bvh_part most = n->part;
  most.end = most.begin + (n->room_end - n->room_begin);
  p->cut.grid = bvh_part_grid(&most, BVH_COARSE);
  bvh_split_chunk *c = p->shop->chunks;
  if (p->cut.grid.bins > 0) {
    run(p, bin_refs);
    for (uint32_t i = 1; i < p->chunk_count; i++)
      sah_bins_join(&c[0].bins, &p->cut.grid, &c[i].bins);
  }
  return bvh_cut_choose(&p->cut, &n->part, &c[0].bins, BVH_COARSE);
}

// The area in which two boxes overlap.
static double overlap_of(const sah_box *a, const sah_box *b) {
  sah_box both = *a;
  for (int k = 0; k < 3; k++) {
    if (b->lo[k] > both.lo[k]) both.lo[k] = b->lo[k];
    if (b->hi[k] < both.hi[k]) both.hi[k] = b->hi[k];
    if (both.lo[k] > both.hi[k]) return 0;
  }
  return sah_half_area(&both);
}

// Whether cuts of space are worth a look.
static bool may_cut_space(const parting *p) {
  const bvh_split_node *n = p->n;
  const sah_split *s = &p->cut.split;
  if (n->large == 0 || p->cut.grid.bins == 0 ||
      n->room_end - n->room_begin <= n->part.end - n->part.begin)
    return false;
  return s->axis < 0 ||
         overlap_of(&s->left, &s->right) > LEAST_OVERLAP * p->shop->root_area;
}

// Add up what the chunks have for either side.
static void sum_sides(const parting *p, uint32_t count[2]) {
  count[0] = count[1] = 0;
  for (uint32_t i = 0; i < p->chunk_count; i++)
    for (int k = 0; k < 2; k++)
      count[k] += p->shop->chunks[i].count[k];
}

// Choose a cut of space that costs less than `cost`; false when there is none,
// or the room is not enough for it.
static bool choose_space(parting *p, double cost, double area) {
  bvh_split_chunk *c = p->shop->chunks;
  p->grid = bvh_split_grid_of(&p->n->part.box);
  run(p, bin_parts);
  for (uint32_t i = 1; i < p->chunk_count; i++)
    bvh_split_bins_join(&c[0].parts, &c[i].parts);
  p->space = bvh_split_best(&c[0].parts, &p->grid, area);
  if (p->space.axis < 0 || !(p->space.cost < cost)) return false;
  uint32_t count[2], room = p->n->room_end - p->n->room_begin;
  run(p, count_sides);
  sum_sides(p, count);
  return count[0] > 0 && count[1] > 0 && count[0] + count[1] <= room;
}

// Left ones to the front of the room, right ones to its end; what is left
// between them is shared by how many refs of either side may be cut.
static void make_children(const parting *p, const uint32_t count[2],
                          bvh_split_node child[2]) {
  const bvh_split_node *n = p->n;
  uint32_t spare = n->room_end - n->room_begin - count[0] - count[1];
  for (int k = 0; k < 2; k++) {
    child[k] = (bvh_split_node){.array = 1 - n->array};
    sah_box box = sah_box_empty(), centres = box;
    for (uint32_t i = 0; i < p->chunk_count; i++) {
      const bvh_split_chunk *c = &p->shop->chunks[i];
      sah_box_join(&box, &c->box[k]);
      sah_box_join(&centres, &c->centres[k]);
      child[k].large += c->large[k];
    }
    child[k].part.box = box;
    child[k].part.centres = centres;
  }
  uint64_t large = (uint64_t)child[0].large + child[1].large;
  uint32_t left =
      large > 0 ? (uint32_t)((uint64_t)spare * child[0].large / large) : 0;
  child[0].room_begin = child[0].part.begin = n->room_begin;
  child[0].part.end = n->room_begin + count[0];
  child[0].room_end = child[1].room_begin = child[0].part.end + left;
  child[1].room_end = child[1].part.end = n->room_end;
  child[1].part.begin = n->room_end - count[1];
}

bool bvh_split_node_part(const bvh_split_shop *shop, const bvh_split_node *n,
                         bvh_split_node child[2]) {
  parting p = {.shop = shop, .n = n};
  uint32_t size = n->part.end - n->part.begin, count[2];
  make_chunks(&p);
  bool cut = choose_cut(&p);
  p.space.axis = -1;
  if (size > BVH_COARSE_LEAF && may_cut_space(&p)) {
    double area = sah_half_area(&n->part.box);
    double least = p.cut.split.axis >= 0 ? p.cut.split.cost : HUGE_VAL;
    if (size <= BVH_MAX_LEAF && area * size < least) least = area * size;
    if (choose_space(&p, least, area))
      cut = true;
    else
      p.space.axis = -1;
  }
  if (!cut) return false;
  if (p.space.axis < 0) run(&p, count_sides);
  sum_sides(&p, count);
  uint32_t to[2] = {n->room_begin, n->room_end - count[1]};
  for (uint32_t i = 0; i < p.chunk_count; i++) {
    bvh_split_chunk *c = &shop->chunks[i];
    for (int k = 0; k < 2; k++) {
      c->to[k] = to[k];
      to[k] += c->count[k];
    }
  }
  run(&p, move_refs);
  make_children(&p, count, child);
  return true;
}
