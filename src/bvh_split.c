// bvh_split.c — from the top, on all threads.
//
// Large nodes are parted one after the other by all threads; a node that has
// become small is a task, and one thread builds all below it.  Every node owns
// a piece of the two arrays of refs, with room to spare that it divides among
// its children: no two threads ask for the same room, and what there is
// depends on the mesh alone.

#include "bvh_split.h"

#include "bvh_read.h"
#include "bvh_split_part.h"
#include "clock.h"
#include "slab.h"

// At most SMALL refs, or 1 / TASKS of all, are a task; CHUNK are binned or
// moved in one go; a large triangle asks for room for PARTS more of it.
enum { TASKS = 64, SMALL = 2048, CHUNK = 4096, PARTS = 32 };

// A subtree for one thread, as bvh_task: leaves count in `order`.
typedef struct split_task {
  bvh_split_node root;
  bvh_node *nodes;
  uint32_t *order;
  uint32_t node_count, ref_count, first_node, first_ref;
  int depth;
} split_task;

// What the threads share during one build.
typedef struct split_builder {
  bvh *out;
  bvh_split_shop shop;
  bvh_split_chunk *worker_chunk;  // one a thread
  uint32_t small;
  bvh_split_node *queue;  // nodes that are no tasks
  split_task *tasks;
  bvh_node *top, *room;
  uint32_t *order;  // of all tasks, with gaps
  uint32_t queue_count, task_count, top_count;
} split_builder;

// Mark the refs whose triangles are large, and count them.
static uint32_t mark_large(sah_ref *refs, const bvh_part *root) {
  aabb all = {{root->box.lo[0], root->box.lo[1], root->box.lo[2]},
              {root->box.hi[0], root->box.hi[1], root->box.hi[2]}};
  float least = slab_large(&all);
  uint32_t count = 0;
  for (uint32_t i = root->begin; i < root->end; i++) {
    const sah_box *b = &refs[i].box;
    vec3 side = {b->hi[0] - b->lo[0], b->hi[1] - b->lo[1], b->hi[2] - b->lo[2]};
    bool large = vec3_peak(side) > least;
    refs[i].as.unused = large ? SPLIT_LARGE : SPLIT_WHOLE;
    count += large;
  }
  return count;
}

// A node joins the tasks or the queue.
static void sort_node(split_builder *b, const bvh_split_node *n) {
  if (n->part.end - n->part.begin > b->small) {
    b->queue[b->queue_count++] = *n;
    return;
  }
  b->tasks[b->task_count++] =
      (split_task){.root = *n,
                   .nodes = b->room + 2 * (size_t)n->room_begin,
                   .order = b->order + n->room_begin};
}

// The top of the tree, down to the tasks.
static void build_top(split_builder *b, const bvh_split_node *root) {
  b->top_count = 1;
  sort_node(b, root);
  for (uint32_t i = 0; i < b->queue_count; i++) {
    bvh_split_node n = b->queue[i], child[2];
    bvh_split_node_part(&b->shop, &n, child);
    b->top[n.part.node] = bvh_node_of(&n.part.box, b->top_count, 0);
    for (int k = 0; k < 2; k++) {
      child[k].part.node = b->top_count++;
      child[k].part.depth = n.part.depth + 1;
      sort_node(b, &child[k]);
    }
  }
}

// Make n a leaf of a task.
static void add_leaf(const split_builder *b, split_task *t,
                     const bvh_split_node *n) {
  const sah_ref *refs = b->shop.refs[n->array];
  t->nodes[n->part.node] =
      bvh_node_of(&n->part.box, t->ref_count, n->part.end - n->part.begin);
  for (uint32_t i = n->part.begin; i < n->part.end; i++)
    t->order[t->ref_count++] = refs[i].as.triangle;
  if (n->part.depth > t->depth) t->depth = n->part.depth;
}

// Depth first, left side first, as bvh_task_run.
static void run_task(void *context, size_t item, int worker) {
  split_builder *b = context;
  split_task *t = &b->tasks[item];
  bvh_split_shop shop = b->shop;
  shop.threads = NULL;
  shop.chunks = &b->worker_chunk[worker];
  shop.chunk_size = UINT32_MAX;
  bvh_split_node stack[BVH_MAX_DEPTH + 1], child[2];
  int top = 0;
  stack[top++] = t->root;
  stack[0].part.node = 0;
  t->node_count = 1;
  while (top > 0) {
    bvh_split_node n = stack[--top];
    while (bvh_split_node_part(&shop, &n, child)) {
      t->nodes[n.part.node] = bvh_node_of(&n.part.box, t->node_count, 0);
      for (int k = 0; k < 2; k++) {
        child[k].part.node = t->node_count++;
        child[k].part.depth = n.part.depth + 1;
      }
      stack[top++] = child[1];
      n = child[0];
    }
    add_leaf(b, t, &n);
  }
}

// Node i of a task as a node of the finished tree.
static bvh_node finished_node(const split_task *t, uint32_t i) {
  bvh_node n = t->nodes[i];
  n.first += n.count > 0 ? t->first_ref : t->first_node - 1;
  return n;
}

static void copy_task(void *context, size_t item, int worker) {
  (void)worker;
  const split_builder *b = context;
  const split_task *t = &b->tasks[item];
  bvh_node *to = b->out->nodes;
  to[t->root.part.node] = finished_node(t, 0);
  for (uint32_t i = 1; i < t->node_count; i++)
    to[t->first_node + i - 1] = finished_node(t, i);
  for (uint32_t i = 0; i < t->ref_count; i++)
    b->out->order[t->first_ref + i] = t->order[i];
}

// Below the tasks, and all of it in one array.
static void build_tasks(split_builder *b, arena *mem) {
  bvh *out = b->out;
  pool_run(b->shop.threads, b->task_count, run_task, b);
  uint32_t nodes = b->top_count, refs = 0;
  for (uint32_t i = 0; i < b->task_count; i++) {
    split_task *t = &b->tasks[i];
    t->first_node = nodes;
    t->first_ref = refs;
    nodes += t->node_count - 1;
    refs += t->ref_count;
    if (t->depth > out->depth) out->depth = t->depth;
  }
  out->node_count = nodes;
  out->refs = refs;
  out->nodes = ARENA_NEW(mem, bvh_node, nodes);
  out->order = ARENA_NEW(mem, uint32_t, refs);
  for (uint32_t i = 0; i < b->top_count; i++)
    out->nodes[i] = b->top[i];
  pool_run(b->shop.threads, b->task_count, copy_task, b);
}

// Room for everything, once it is known how much there can be.
static void make_room(split_builder *b, uint32_t room, arena *scratch) {
  size_t threads = (size_t)pool_threads(b->shop.threads);
  b->small = room / TASKS > SMALL ? room / TASKS : SMALL;
  b->shop.refs[1] = ARENA_NEW(scratch, sah_ref, room);
  b->shop.chunk_size = CHUNK;
  b->shop.chunks = ARENA_NEW(scratch, bvh_split_chunk, room / CHUNK + 1);
  b->worker_chunk = ARENA_NEW(scratch, bvh_split_chunk, threads);
  // Nodes above the tasks: fewer than TASKS a level.
  b->queue = ARENA_NEW(scratch, bvh_split_node, TASKS * BVH_MAX_DEPTH + 1);
  b->tasks = ARENA_NEW(scratch, split_task, TASKS * BVH_MAX_DEPTH + 1);
  b->top = ARENA_NEW(scratch, bvh_node, 2 * TASKS * BVH_MAX_DEPTH + 1);
  b->room = ARENA_NEW(scratch, bvh_node, 2 * (size_t)room);
  b->order = ARENA_NEW(scratch, uint32_t, room);
}

void bvh_split_build(bvh *out, const vec3 *positions, const uint32_t *index,
                     uint32_t triangle_count, arena *mem, pool *threads) {
  double start = clock_seconds();
  *out = (bvh){
      .positions = positions, .index = index, .triangle_count = triangle_count};
  arena scratch = {0};
  split_builder b = {.out = out, .shop = {.b = out, .threads = threads}};
  bvh_split_node root = {
      .part =
          bvh_read(&b.shop.refs[0], out, BVH_SPLIT_PERCENT, &scratch, threads)};
  root.large = mark_large(b.shop.refs[0], &root.part);
  if (root.large == 0) {
    arena_free(&scratch);
    bvh_build(out, positions, index, triangle_count, BVH_SAH, mem, threads);
  } else {
    uint64_t most = (uint64_t)out->kept * BVH_SPLIT_PERCENT / 100;
    uint64_t wish = (uint64_t)root.large * PARTS;
    root.room_end = out->kept + (uint32_t)(wish < most ? wish : most);
    b.shop.root_area = sah_half_area(&root.part.box);
    make_room(&b, root.room_end, &scratch);
    build_top(&b, &root);
    build_tasks(&b, mem);
    out->cost = bvh_cost(out);
    arena_free(&scratch);
  }
  out->seconds = clock_seconds() - start;
}
