// bvh.c — down the tree, nearer child first.
//
// The two questions, closest and any, with and without counting, are one
// function, specialised by the compiler: `any` is known where it is inlined,
// and so is whether there is something to count into.

#include "bvh.h"

#include "slab.h"
#include "triangle.h"

// A function whose flags the compiler must know where it is called.
#define KERNEL static inline __attribute__((always_inline))

// What one ray needs on its way, and the best hit so far: t = tmax of the ray
// and HIT_NONE before the first.
typedef struct bvh_walk {
  const bvh *b;
  ray r;
  ray_shear shear;
  slab_ray slab;
  hit best;
} bvh_walk;

// A node to come back to, and where the ray enters it.
typedef struct bvh_later {
  uint32_t node;
  float near;
} bvh_later;

// False for a ray that can hit nothing: no triangle, no direction, or a
// component that is not finite.
static bool walk_start(bvh_walk *w, const bvh *b, const ray *r) {
  vec3 d = ray_flush(r->d);
  if (b->nodes == NULL || !vec3_finite(r->o) || !vec3_finite(d)) return false;
  if (d.x == 0 && d.y == 0 && d.z == 0) return false;
  w->b = b;
  w->r = (ray){r->o, d, r->tmin, r->tmax};
  w->shear = ray_shear_of(d);
  aabb all = {b->nodes[0].lo, b->nodes[0].hi};
  w->slab = slab_ray_of(r->o, d, &all);
  w->best = (hit){.t = r->tmax, .triangle = HIT_NONE};
  return true;
}

// Test triangles order[first .. first + count - 1] and keep the best hit: the
// smallest t, of equal t the lowest triangle.  With `any`, stop at the first.
KERNEL bool walk_triangles(bvh_walk *w, uint32_t first, uint32_t count,
                           bool any) {
  bool found = false;
  for (uint32_t i = first; i < first + count; i++) {
    uint32_t triangle = w->b->order[i];
    const uint32_t *v = w->b->index + 3 * (size_t)triangle;
    const vec3 *p = w->b->positions;
    vec3 corner[3] = {p[v[0]], p[v[1]], p[v[2]]};
    hit h = {.triangle = triangle};
    if (!triangle_hit(&w->r, &w->shear, corner[0], corner[1], corner[2], &h) ||
        !slab_hold(&w->slab, &w->r, corner, &h))
      continue;
    if (any) return true;
    if (h.t > w->best.t || (h.t == w->best.t && h.triangle > w->best.triangle))
      continue;
    w->best = h;
    found = true;
  }
  return found;
}

// Visit the nodes that the ray enters no later than the best hit; `<=` and not
// `<`, because a box that begins exactly there may hold a lower triangle at
// the same t.  v, unless NULL, counts.
KERNEL bool walk_tree(bvh_walk *w, bool any, bvh_visits *v) {
  bvh_later stack[BVH_MAX_DEPTH];
  int top = 0;
  bool found = false;
  const bvh_node *nodes = w->b->nodes, *n = nodes;
  float tmin = w->r.tmin;
  for (;;) {
    if (v != NULL) v->nodes++;
    if (n->count > 0) {
      if (v != NULL) v->triangles += n->count;
      if (walk_triangles(w, n->first, n->count, any)) {
        found = true;
        if (any) return true;
      }
    } else {
      uint32_t c = n->first;
      const bvh_node *l = nodes + c, *r = l + 1;
      slab_span span = {tmin, w->best.t};
      slab_span a = slab_cut(&w->slab, l, span);
      slab_span b = slab_cut(&w->slab, r, span);
      bool in_a = a.near <= a.far, in_b = b.near <= b.far;
      if (in_a && in_b) {
        bool swap = b.near < a.near;
        stack[top++] = (bvh_later){swap ? c : c + 1, swap ? a.near : b.near};
        n = swap ? r : l;
        continue;
      }
      if (in_a || in_b) {
        n = in_a ? l : r;
        continue;
      }
    }
    do {
      if (top == 0) return found;
      top--;
    } while (stack[top].near > w->best.t);
    n = nodes + stack[top].node;
  }
}

bool bvh_closest(const bvh *b, const ray *r, hit *h) {
  bvh_walk w;
  if (!walk_start(&w, b, r) || !walk_tree(&w, false, NULL)) return false;
  *h = w.best;
  return true;
}

bool bvh_closest_counted(const bvh *b, const ray *r, hit *h, bvh_visits *v) {
  bvh_walk w;
  if (!walk_start(&w, b, r) || !walk_tree(&w, false, v)) return false;
  *h = w.best;
  return true;
}

bool bvh_any(const bvh *b, const ray *r) {
  bvh_walk w;
  return walk_start(&w, b, r) && walk_tree(&w, true, NULL);
}

bool brute_closest(const bvh *b, const ray *r, hit *h) {
  bvh_walk w;
  if (!walk_start(&w, b, r) || !walk_triangles(&w, 0, b->refs, false))
    return false;
  *h = w.best;
  return true;
}

bool brute_any(const bvh *b, const ray *r) {
  bvh_walk w;
  return walk_start(&w, b, r) && walk_triangles(&w, 0, b->refs, true);
}

// The four again, without their types, as tracer wants them.
static bool tree_closest(const void *tree, const ray *r, hit *h) {
  return bvh_closest(tree, r, h);
}

static bool tree_any(const void *tree, const ray *r) {
  return bvh_any(tree, r);
}

static bool list_closest(const void *tree, const ray *r, hit *h) {
  return brute_closest(tree, r, h);
}

static bool list_any(const void *tree, const ray *r) {
  return brute_any(tree, r);
}

tracer bvh_tracer(const bvh *b) {
  return (tracer){.tree = b, .closest = tree_closest, .any = tree_any};
}

tracer brute_tracer(const bvh *b) {
  return (tracer){.tree = b, .closest = list_closest, .any = list_any};
}
