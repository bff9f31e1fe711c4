// bvh_split.c — from the top, on all threads.
//
// Large nodes are parted one after the other by all threads; a node that has
// become small is a task, and one thread builds all below it.  Every node owns
// a piece of the two arrays of refs, with room to spare that it divides among
// its children: no two threads ask for the same room, and what there is
// depends on the mesh alone.

#include "bvh_split.h"

#include "build.h"
#include "bvh_read.h"
#include "bvh_split_part.h"
#include "clock.h"
#include "slab.h"

#include <float.h>
#include <string.h>

// At most SMALL refs, or 1 / TASKS of all, are a task; CHUNK are binned or
// moved in one go; a large triangle asks for room for PARTS more of it.
enum { TASKS = 64, SMALL = 2048, CHUNK = 4096, PARTS = 32 };

// What a box that a ray enters for nothing costs, and what the build costs
// more for each triangle when some are cut.  Measured, and rough.
#define RAY_SECONDS 4e-9
#define CUT_SECONDS 3e-6

// A subtree for one thread, as bvh_task: leaves count in `order`.
typedef struct split_task {
  bvh_split_node root;
  bvh_node *nodes;
  uint32_t *order;
  uint32_t node_count, ref_count, first_node, first_ref;
  int depth;
} split_task;

// A worker's memory: nodes and triangle numbers of the task at hand, as many
// as there can be, and those of finished tasks, as many as there are.
typedef struct split_room {
  bvh_node *nodes;
  uint32_t *order;
  arena done;
} split_room;

// What the threads share during one build.
typedef struct split_builder {
  bvh *out;
  bvh_split_shop shop;
  bvh_split_chunk *worker_chunk;  // one a thread
  uint32_t small;
  bvh_split_node *queue;  // nodes that are no tasks
  split_task *tasks;
  bvh_node *top;
  split_room *rooms;  // one a thread
  uint32_t queue_count, task_count, top_count;
} split_builder;

// Refs that one work item looks at, and what it finds: how many triangles are
// large, by how much their boxes are too large together, and the sum of the
// squares of that.
typedef struct split_look {
  uint32_t large;
  double excess, squares;
} split_look;

typedef struct split_looking {
  const bvh *b;
  sah_ref *refs;
  uint32_t count;
  float least;  // slab_large
  double area;  // half of that of all
  split_look *found;
} split_looking;

// Half the area of a box less that of a flat box around the triangle in it:
// half the rays that enter the one for nothing.
static double excess_of(const bvh *b, const sah_ref *r) {
  const uint32_t *v = b->index + 3 * (size_t)r->as.triangle;
  const vec3 *p = b->positions;
  double e[2][3];
  for (int i = 0; i < 2; i++) {
    e[i][0] = (double)p[v[i + 1]].x - (double)p[v[0]].x;
    e[i][1] = (double)p[v[i + 1]].y - (double)p[v[0]].y;
    e[i][2] = (double)p[v[i + 1]].z - (double)p[v[0]].z;
  }
  double x = e[0][1] * e[1][2] - e[0][2] * e[1][1];
  double y = e[0][2] * e[1][0] - e[0][0] * e[1][2];
  double z = e[0][0] * e[1][1] - e[0][1] * e[1][0];
  return fmax(sah_half_area(&r->box) - sqrt(x * x + y * y + z * z), 0);
}

// Mark the refs whose triangles are large.
static void look_at(void *context, size_t item, int worker) {
  (void)worker;
  const split_looking *job = context;
  split_look *found = &job->found[item];
  uint32_t begin = (uint32_t)item * CHUNK;
  uint32_t end = job->count - begin < CHUNK ? job->count : begin + CHUNK;
  for (uint32_t i = begin; i < end; i++) {
    sah_ref *r = &job->refs[i];
    vec3 side = {r->box.hi[0] - r->box.lo[0], r->box.hi[1] - r->box.lo[1],
                 r->box.hi[2] - r->box.lo[2]};
    bool large = vec3_peak(side) > job->least;
    r->as.unused = large ? SPLIT_LARGE : SPLIT_WHOLE;
    if (!large) continue;
    found->large++;
    double excess = excess_of(job->b, r) / job->area;
    found->excess += excess;
    found->squares += excess * excess;
  }
}

// All of them.
static split_look look_at_all(const bvh *b, sah_ref *refs, const sah_box *box,
                              arena *mem, pool *threads) {
  aabb all = {{box->lo[0], box->lo[1], box->lo[2]},
              {box->hi[0], box->hi[1], box->hi[2]}};
  size_t chunks = b->kept / CHUNK + 1;
  split_looking job = {.b = b,
                       .refs = refs,
                       .count = b->kept,
                       .least = slab_large(&all),
                       .area = sah_half_area(box),
                       .found = ARENA_NEW(mem, split_look, chunks)};
  split_look sum = {0};
  pool_run(threads, chunks, look_at, &job);
  for (size_t i = 0; i < chunks; i++) {
    sum.large += job.found[i].large;
    sum.excess += job.found[i].excess;
    sum.squares += job.found[i].squares;
  }
  return sum;
}

// How many rays repay cutting triangles.  The excess would be the same if
// `alike` triangles had equal shares of it.  Where the room is not enough to
// cut each of those once, boxes of whole triangles remain between those of
// parts, and no number of rays repays it; elsewhere parts have a share less.
static double cut_rays_of(const split_look *l, uint32_t kept) {
  if (l->large == 0 || !(l->excess > 0)) return HUGE_VAL;
  double alike = l->excess * l->excess / l->squares;
  double cuts = kept * (BVH_SPLIT_PERCENT / 100.0) / alike;
  double spared = l->excess * (cuts / (1 + cuts));
  return cuts >= 1 ? kept * CUT_SECONDS / (spared * RAY_SECONDS) : DBL_MAX;
}

double bvh_split_rays(const bvh *b, const bvh_source *from, arena *mem,
                      pool *threads) {
  split_look look = look_at_all(b, from->refs, &from->root.box, mem, threads);
  return cut_rays_of(&look, b->kept);
}

// A node joins the tasks or the queue.
static void sort_node(split_builder *b, const bvh_split_node *n) {
  if (n->part.end - n->part.begin > b->small) {
    b->queue[b->queue_count++] = *n;
    return;
  }
  b->tasks[b->task_count++] = (split_task){.root = *n};
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
static void grow_task(const split_builder *b, split_task *t, int worker) {
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

static void run_task(void *context, size_t item, int worker) {
  split_builder *b = context;
  split_task *t = &b->tasks[item];
  split_room *room = &b->rooms[worker];
  t->nodes = room->nodes;
  t->order = room->order;
  grow_task(b, t, worker);
  t->nodes = ARENA_NEW(&room->done, bvh_node, t->node_count);
  t->order = ARENA_NEW(&room->done, uint32_t, t->ref_count);
  memcpy(t->nodes, room->nodes, t->node_count * sizeof *t->nodes);
  memcpy(t->order, room->order, t->ref_count * sizeof *t->order);
}

// Each worker has room for whatever the largest task may become.
static void make_rooms(split_builder *b, arena *scratch) {
  size_t workers = (size_t)pool_threads(b->shop.threads), most = 0;
  for (uint32_t i = 0; i < b->task_count; i++) {
    const bvh_split_node *root = &b->tasks[i].root;
    size_t room = root->room_end - root->room_begin;
    if (room > most) most = room;
  }
  b->rooms = ARENA_NEW(scratch, split_room, workers);
  for (size_t i = 0; i < workers; i++) {
    b->rooms[i].nodes = ARENA_NEW(scratch, bvh_node, 2 * most);
    b->rooms[i].order = ARENA_NEW(scratch, uint32_t, most);
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

// Below the tasks, and all of it in one array, once the refs have gone.
static void build_tasks(split_builder *b, arena *mem, arena *refs_mem,
                        arena *scratch) {
  bvh *out = b->out;
  make_rooms(b, scratch);
  pool_run(b->shop.threads, b->task_count, run_task, b);
  arena_free(refs_mem);
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
  for (int i = 0; i < pool_threads(b->shop.threads); i++)
    arena_free(&b->rooms[i].done);
}

// Room for the top, once it is known how much there can be.
static void make_room(split_builder *b, uint32_t room, arena *refs_mem,
                      arena *scratch) {
  size_t threads = (size_t)pool_threads(b->shop.threads);
  b->small = room / TASKS > SMALL ? room / TASKS : SMALL;
  b->shop.refs[1] = ARENA_NEW(refs_mem, sah_ref, room);
  b->shop.chunk_size = CHUNK;
  b->shop.chunks = ARENA_NEW(scratch, bvh_split_chunk, room / CHUNK + 1);
  b->worker_chunk = ARENA_NEW(scratch, bvh_split_chunk, threads);
  // Nodes above the tasks: fewer than TASKS a level.
  b->queue = ARENA_NEW(scratch, bvh_split_node, TASKS * BVH_MAX_DEPTH + 1);
  b->tasks = ARENA_NEW(scratch, split_task, TASKS * BVH_MAX_DEPTH + 1);
  b->top = ARENA_NEW(scratch, bvh_node, 2 * TASKS * BVH_MAX_DEPTH + 1);
}

void bvh_split_build(bvh *out, const bvh *mesh, double rays, arena *mem,
                     pool *threads) {
  double start = clock_seconds();
  arena refs = {0}, scratch = {0};
  split_builder b = {.out = out, .shop = {.b = out, .threads = threads}};
  *out = (bvh){.positions = mesh->positions,
               .index = mesh->index,
               .triangle_count = mesh->triangle_count};
  bvh_split_node root = {.part = bvh_read(&b.shop.refs[0], out,
                                          BVH_SPLIT_PERCENT, &refs, threads)};
  split_look look =
      look_at_all(out, b.shop.refs[0], &root.part.box, &scratch, threads);
  double cut_rays = cut_rays_of(&look, out->kept);
  if (rays > cut_rays) {
    uint64_t most = (uint64_t)out->kept * BVH_SPLIT_PERCENT / 100;
    uint64_t wish = (uint64_t)look.large * PARTS;
    root.large = look.large;
    root.room_end = out->kept + (uint32_t)(wish < most ? wish : most);
    b.shop.root_area = sah_half_area(&root.part.box);
    make_room(&b, root.room_end, &refs, &scratch);
    build_top(&b, &root);
    build_tasks(&b, mem, &refs, &scratch);
    out->parts = out->refs - out->kept;
    out->cost = bvh_cost(out, threads);
  } else {
    bvh_source from = {b.shop.refs[0], root.part, BVH_COARSE, &refs,
                       build_hands()};
    bvh_build_source(out, &from, mem, threads);
  }
  arena_free(&refs);
  arena_free(&scratch);
  out->cut_rays = cut_rays;
  out->seconds = clock_seconds() - start;
}
