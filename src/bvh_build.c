// bvh_build.c — a tree from the top, on all threads.
//
// The top is built level by level: all nodes of a level are binned, cut and
// parted together, in chunks of triangles that the threads take as they come.
// A node that has become small is a task: one thread builds all below it.
// Chunks and tasks depend on the mesh alone, and neither joining boxes nor
// counting asks for an order: so the tree is the same for any threads.

#include "bvh_part.h"
#include "bvh_read.h"
#include "clock.h"

#include <string.h>

// At most SMALL triangles, or 1 / TASKS of all, are a task; CHUNK of them are
// binned or moved in one go.
enum { TASKS = 64, SMALL = 2048, CHUNK = 4096 };

// A node of the level that is being parted, its chunks and its two parts.
typedef struct level_node {
  bvh_part part, child[2];
  bvh_cut cut;
  uint32_t first_chunk, chunk_count;
} level_node;

// Refs begin..end-1 of a level's node: their bins, where the left and the
// right ones go, and the bounds of the centres of either.
typedef struct level_chunk {
  level_node *node;
  uint32_t begin, end;
  uint32_t to[2];
  sah_box centres[2];
  sah_bins bins;
} level_chunk;

// A worker's memory: nodes of the task at hand, two a triangle, its refs once
// more, and nodes of
// finished tasks, which are about two for three.
typedef struct task_room {
  bvh_node *nodes;
  sah_ref *spare;
  arena done;
} task_room;

// What the threads share during one build.
typedef struct builder {
  bvh *out;
  bvh_method method;
  const bvh_hands *hands;
  pool *threads;
  uint32_t small;         // so many triangles or fewer are a task
  sah_ref *refs, *spare;  // the level's refs, and where the next level's go
  level_node *level, *next_level;
  level_chunk *chunks;
  bvh_task *tasks;
  bvh_node *top;      // nodes above the tasks
  task_room *rooms;   // one a worker
  uint32_t *offsets;  // where a task's nodes begin in the finished tree
  uint32_t level_count, chunk_count, task_count, top_count;
} builder;

static uint32_t smaller(uint32_t a, uint32_t b) {
  return a < b ? a : b;
}

static void bin_chunk(void *context, size_t item, int worker) {
  (void)worker;
  builder *b = context;
  level_chunk *c = &b->chunks[item];
  const sah_grid *g = &c->node->cut.grid;
  if (g->bins == 0) return;
  b->hands->bin(&c->bins, g, b->refs + c->begin, c->end - c->begin);
}

// How many refs of a chunk go left; its bins know.
static uint32_t left_of_chunk(const level_chunk *c) {
  const bvh_cut *cut = &c->node->cut;
  uint32_t n = 0;
  if (cut->split.axis < 0) {
    for (uint32_t i = c->begin; i < c->end; i++)
      n += bvh_cut_left(cut, &c->node->part, NULL, i);
    return n;
  }
  for (int i = 0; i <= cut->split.after; i++)
    n += c->bins.count[cut->split.axis][i];
  return n;
}

// Join the bins of a node's chunks, choose its cut, and tell each chunk where
// its refs go.
static void cut_node(void *context, size_t item, int worker) {
  (void)worker;
  builder *b = context;
  level_node *n = &b->level[item];
  level_chunk *c = &b->chunks[n->first_chunk];
  sah_bins bins = c[0].bins;
  for (uint32_t i = 1; i < n->chunk_count; i++)
    sah_bins_join(&bins, &n->cut.grid, &c[i].bins);
  bvh_cut_choose(&n->cut, &n->part, &bins, b->method);
  uint32_t left = n->part.begin;
  for (uint32_t i = 0; i < n->chunk_count; i++) {
    c[i].to[0] = left;
    left += left_of_chunk(&c[i]);
  }
  uint32_t right = left;
  for (uint32_t i = 0; i < n->chunk_count; i++) {
    c[i].to[1] = right;
    uint32_t next = i + 1 < n->chunk_count ? c[i + 1].to[0] : left;
    right += c[i].end - c[i].begin - (next - c[i].to[0]);
  }
  n->child[0] = (bvh_part){.begin = n->part.begin, .end = left};
  n->child[1] = (bvh_part){.begin = left, .end = n->part.end};
}

// Move the refs of a chunk to their sides, in order.
static void move_chunk(void *context, size_t item, int worker) {
  (void)worker;
  builder *b = context;
  level_chunk *c = &b->chunks[item];
  bvh_move m = {.part = &c->node->part,
                .cut = &c->node->cut,
                .refs = b->refs,
                .begin = c->begin,
                .end = c->end,
                .to = {b->spare + c->to[0], b->spare + c->to[1]}};
  b->hands->move(&m);
  memcpy(c->centres, m.centres, sizeof c->centres);
}

// A finished part joins the tasks or the next level.
static void sort_part(builder *b, const bvh_part *p, uint32_t *next_count) {
  if (p->end - p->begin > b->small) {
    b->next_level[(*next_count)++].part = *p;
    return;
  }
  b->tasks[b->task_count++] =
      (bvh_task){.root = *p, .refs = b->refs, .method = b->method};
}

// The bounds of the children of a parted node.
static void bound_children(const builder *b, level_node *n) {
  for (int side = 0; side < 2; side++) {
    bvh_part *p = &n->child[side];
    p->box = side == 0 ? n->cut.split.left : n->cut.split.right;
    p->centres = sah_box_empty();
    for (uint32_t i = 0; i < n->chunk_count; i++)
      sah_box_join(&p->centres, &b->chunks[n->first_chunk + i].centres[side]);
    if (n->cut.split.axis >= 0) continue;
    p->box = sah_box_empty();
    for (uint32_t i = p->begin; i < p->end; i++)
      sah_box_join(&p->box, &b->refs[i].box);
  }
}

// Number the children of the level's nodes and send them on.
static void end_level(builder *b) {
  uint32_t next_count = 0;
  sah_ref *refs = b->refs;
  b->refs = b->spare;
  b->spare = refs;
  for (uint32_t i = 0; i < b->level_count; i++) {
    level_node *n = &b->level[i];
    bound_children(b, n);
    b->top[n->part.node] = bvh_node_of(&n->part.box, b->top_count, 0);
    for (int side = 0; side < 2; side++) {
      n->child[side].node = b->top_count++;
      n->child[side].depth = n->part.depth + 1;
      sort_part(b, &n->child[side], &next_count);
    }
  }
  level_node *level = b->level;
  b->level = b->next_level;
  b->next_level = level;
  b->level_count = next_count;
}

// Divide the nodes of a level into chunks.
static void begin_level(builder *b) {
  b->chunk_count = 0;
  for (uint32_t i = 0; i < b->level_count; i++) {
    level_node *n = &b->level[i];
    n->cut.grid = bvh_part_grid(&n->part, b->method);
    n->first_chunk = b->chunk_count;
    for (uint32_t at = n->part.begin; at < n->part.end; at += CHUNK) {
      level_chunk *c = &b->chunks[b->chunk_count++];
      c->node = n;
      c->begin = at;
      c->end = at + smaller(CHUNK, n->part.end - at);
    }
    n->chunk_count = b->chunk_count - n->first_chunk;
  }
}

// The top of the tree, down to the tasks.  A level has fewer than TASKS nodes,
// since each has more than 1 / TASKS of the triangles.
static void build_top(builder *b, const bvh_part *root, arena *refs,
                      arena *scratch) {
  uint32_t n = root->end;
  b->small = n / TASKS > SMALL ? n / TASKS : SMALL;
  b->spare = ARENA_NEW(refs, sah_ref, n > b->small ? n : 0);
  b->level = ARENA_NEW(scratch, level_node, TASKS);
  b->next_level = ARENA_NEW(scratch, level_node, TASKS);
  b->chunks =
      ARENA_NEW(scratch, level_chunk, n > b->small ? n / CHUNK + TASKS : 0);
  b->tasks = ARENA_NEW(scratch, bvh_task, TASKS * BVH_MAX_DEPTH + 1);
  b->top = ARENA_NEW(scratch, bvh_node, 2 * TASKS * BVH_MAX_DEPTH + 1);
  b->top_count = 1;
  sort_part(b, root, &b->level_count);
  level_node *level = b->level;
  b->level = b->next_level;
  b->next_level = level;
  while (b->level_count > 0) {
    begin_level(b);
    pool_run_near(b->threads, b->chunk_count, bin_chunk, b);
    pool_run(b->threads, b->level_count, cut_node, b);
    pool_run_near(b->threads, b->chunk_count, move_chunk, b);
    end_level(b);
  }
}

// Build all below a task's root; then neither its refs nor the room for nodes
// that might have been are needed.  Its nodes go to where its refs were, of the
// same size, unless they are more.
static void run_task(void *context, size_t item, int worker) {
  builder *b = context;
  bvh_task *t = &b->tasks[item];
  task_room *room = &b->rooms[worker];
  t->nodes = room->nodes;
  t->spare = room->spare;
  b->hands->run(t);
  for (uint32_t i = t->root.begin; i < t->root.end; i++)
    b->out->order[i] = t->refs[i].as.triangle;
  t->nodes = (bvh_node *)(void *)(t->refs + t->root.begin);
  if (t->node_count > t->root.end - t->root.begin)
    t->nodes = ARENA_NEW(&room->done, bvh_node, t->node_count);
  memcpy(t->nodes, room->nodes, t->node_count * sizeof *t->nodes);
}

static void make_rooms(builder *b, uint32_t n, arena *scratch) {
  size_t workers = (size_t)pool_threads(b->threads);
  b->rooms = ARENA_NEW(scratch, task_room, workers);
  size_t most = smaller(n, b->small);
  for (size_t i = 0; i < workers; i++) {
    b->rooms[i].nodes = ARENA_NEW(scratch, bvh_node, 2 * most);
    b->rooms[i].spare = ARENA_NEW(scratch, sah_ref, most);
  }
}

// Node `from` of task k as a node of the finished tree: children move to
// where the task's nodes go.
static bvh_node finished_node(const builder *b, size_t k, uint32_t from) {
  bvh_node n = b->tasks[k].nodes[from];
  if (n.count == 0) n.first += b->offsets[k] - 1;
  return n;
}

// Copy a task's nodes to the finished tree; its root has a place among the
// top's nodes.
static void copy_task(void *context, size_t item, int worker) {
  (void)worker;
  builder *b = context;
  const bvh_task *t = &b->tasks[item];
  bvh_node *to = b->out->nodes;
  to[t->root.node] = finished_node(b, item, 0);
  for (uint32_t i = 1; i < t->node_count; i++)
    to[b->offsets[item] + i - 1] = finished_node(b, item, i);
}

// Below the tasks, and all of it in one array: the refs, the most of what a
// build needs, go before it comes.
static void build_tasks(builder *b, arena *mem, arena *refs, arena *scratch) {
  bvh *out = b->out;
  out->order = ARENA_NEW(mem, uint32_t, out->kept);
  make_rooms(b, out->kept, scratch);
  pool_run_near(b->threads, b->task_count, run_task, b);
  b->offsets = ARENA_NEW(scratch, uint32_t, b->task_count);
  uint32_t count = b->top_count;
  for (uint32_t k = 0; k < b->task_count; k++) {
    const bvh_task *t = &b->tasks[k];
    b->offsets[k] = count;
    count += t->node_count - 1;
    if (t->depth > out->depth) out->depth = t->depth;
  }
  out->node_count = count;
  out->nodes = ARENA_NEW(mem, bvh_node, count);
  for (uint32_t i = 0; i < b->top_count; i++)
    out->nodes[i] = b->top[i];
  pool_run_near(b->threads, b->task_count, copy_task, b);
  for (int i = 0; i < pool_threads(b->threads); i++)
    arena_free(&b->rooms[i].done);
  arena_free(refs);
}

void bvh_build_source(bvh *out, const bvh_source *from, arena *mem,
                      pool *threads) {
  arena scratch = {0};
  builder b = {.out = out,
               .method = from->method,
               .hands = from->hands,
               .threads = threads,
               .refs = from->refs};
  if (b.hands == NULL) b.hands = &bvh_plain_hands;
  if (out->kept > 0) {
    build_top(&b, &from->root, from->mem, &scratch);
    build_tasks(&b, mem, from->mem, &scratch);
    out->cost = bvh_cost(out, threads);
  }
  arena_free(from->mem);
  arena_free(&scratch);
}

void bvh_build(bvh *out, const vec3 *positions, const uint32_t *index,
               uint32_t triangle_count, bvh_method method, arena *mem,
               pool *threads) {
  double start = clock_seconds();
  *out = (bvh){
      .positions = positions, .index = index, .triangle_count = triangle_count};
  arena refs = {0};
  bvh_source from = {.method = method, .mem = &refs};
  from.root = bvh_read(&from.refs, out, 0, &refs, threads);
  bvh_build_source(out, &from, mem, threads);
  out->seconds = clock_seconds() - start;
}
