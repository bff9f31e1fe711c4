// watertight.c — rays from inside of closed meshes, at points of their edges
// and at their vertices: each must hit something.

#include "../shapes.h"
#include "stress.h"
#include "wide.h"

enum { BATCH = 8192 };

// A closed mesh, star-shaped about its centre, and what found a way out.
typedef struct vessel {
  shape s;
  vec3 centre, room;  // rays start at centre +- room
  bvh b;
  wide_tree wide;
  tracer many;
  uint64_t seed;
  bool both;        // ask the binary tree, too
  uint32_t *leaks;  // of each batch: even ones aim at edges, odd at vertices
} vessel;

static vec3 aim_of(const shape *s, bool vertex, uint64_t *state) {
  uint32_t t = (uint32_t)(shape_random(state) * (float)s->triangles);
  uint32_t side = (uint32_t)(shape_random(state) * 3);
  const uint32_t *v = s->index + 3 * (size_t)(t < s->triangles ? t : 0);
  vec3 a = s->positions[v[side % 3]], b = s->positions[v[(side + 1) % 3]];
  return vertex ? a : vec3_lerp(a, b, shape_random(state));
}

static void try_batch(void *context, size_t item, int worker) {
  (void)worker;
  vessel *m = context;
  uint64_t state = m->seed + UINT64_C(0x9e3779b97f4a7c15) * (item + 1);
  uint32_t leaks = 0;
  ray rays[BATCH];
  hit hits[BATCH];
  for (int i = 0; i < BATCH; i++) {
    vec3 o = vec3_add(m->centre, vec3_mul(m->room, shape_point(&state)));
    rays[i] = ray_from(o, vec3_sub(aim_of(&m->s, item % 2, &state), o));
  }
  m->many.closest_many(&m->wide, rays, hits, BATCH);
  for (int i = 0; i < BATCH; i++) {
    hit h;
    bool lost = hits[i].triangle == HIT_NONE;
    if (m->both) lost = lost || !bvh_closest(&m->b, &rays[i], &h);
    leaks += lost;
  }
  m->leaks[item] = leaks;
}

// Rays tried and lost, at edges and at vertices.
typedef struct losses {
  double tried[2], lost[2];
} losses;

static void pour(losses *sum, stress *s, shape of, vec3 centre, vec3 room,
                 size_t rays) {
  arena mem = {0};
  size_t batches = 2 * (rays / BATCH + 1);
  vessel m = {.s = of, .centre = centre, .room = room};
  m.both = s->size != STRESS_LONG;
  m.seed = 1 + 7919 * s->slice;
  m.leaks = ARENA_NEW(&mem, uint32_t, batches);
  bvh_build(&m.b, of.positions, of.index, of.triangles, BVH_SAH, &mem,
            s->threads);
  wide_tree_build(&m.wide, &m.b, &mem, s->threads);
  m.many = wide_tracer(&m.wide);
  pool_run(s->threads, batches, try_batch, &m);
  for (size_t i = 0; i < batches; i++) {
    sum->tried[i % 2] += BATCH;
    sum->lost[i % 2] += m.leaks[i];
  }
  arena_free(&mem);
}

static const vec3 ZERO = {0, 0, 0};

// Spheres of three sizes, about the origin and far away; an octahedron and a
// cube, whose faces lie in faces of boxes.
static void friendly(losses *l, stress *s, arena *mem, size_t rays) {
  const float sizes[] = {1, 1e-6f, 1e6f};
  for (int i = 0; i < 3; i++) {
    float r = sizes[i];
    shape ball = shape_moved(shape_sphere(mem, 40), "ball", vec3_all(r), ZERO);
    pour(l, s, ball, ZERO, vec3_all(0.5f * r), rays);
  }
  vec3 far = {1e6f, -1e6f, 1e6f};
  shape ball = shape_moved(shape_sphere(mem, 12), "far", vec3_all(100), far);
  pour(l, s, ball, far, vec3_all(40), rays);
  shape flat = shape_sphere(mem, 16);
  for (uint32_t i = 0; i < flat.vertices; i++) {
    vec3 p = vec3_abs(flat.positions[i]);
    flat.positions[i] = vec3_scale(flat.positions[i], 1 / (p.x + p.y + p.z));
  }
  pour(l, s, flat, ZERO, vec3_all(0.3f), rays);
  for (uint32_t i = 0; i < flat.vertices; i++) {
    float peak = vec3_peak(vec3_abs(flat.positions[i]));
    flat.positions[i] = vec3_scale(flat.positions[i], 1 / peak);
  }
  pour(l, s, flat, ZERO, vec3_all(0.9f), rays);
}

// Spheres stretched 1e7 times along an axis, flattened as much, and stretched
// along a diagonal, where floats allow 1e5.
static void needles(losses *l, stress *s, arena *mem, size_t rays) {
  vec3 thin = {1, 1, 1e7f}, flat = {1, 1e-7f, 1};
  shape of = shape_moved(shape_sphere(mem, 20), "needle", thin, ZERO);
  pour(l, s, of, ZERO, vec3_scale(thin, 0.4f), rays);
  of = shape_moved(shape_sphere(mem, 20), "disc", flat, ZERO);
  pour(l, s, of, ZERO, vec3_scale(flat, 0.4f), rays);
  of = shape_sphere(mem, 20);
  for (uint32_t i = 0; i < of.vertices; i++) {
    vec3 p = of.positions[i];
    of.positions[i] = vec3_add(p, vec3_all(1e5f * (p.x + p.y + p.z)));
  }
  pour(l, s, of, ZERO, ZERO, rays);
}

void stress_watertight(stress *s) {
  arena mem = {0};
  losses l = {{0}, {0}}, n = {{0}, {0}};
  // Ninths of 10^7 at edges and 10^7 at vertices; a long slice has 10^8.
  size_t rays = stress_count(s, 5e3, 1e7 / 9, 5e7 / 9);
  friendly(&l, s, &mem, rays);
  needles(&n, s, &mem, rays);
  stress_print(
      s, (stress_row){"leaks: rays at edges, sizes 1e-6 to 1e6, far, flat",
                      l.tried[0], l.lost[0], NO_LIMIT, NO_LIMIT,
                      "Embree's tests allow 2e-5; pbrt tries 2e5"});
  stress_print(s, (stress_row){"leaks: rays at vertices of the same",
                               l.tried[1], l.lost[1], NO_LIMIT, NO_LIMIT,
                               "3.6e-3 (Embree 3.13, robust)"});
  stress_print(s,
               (stress_row){"leaks: edges of slivers, aspect 1e7", n.tried[0],
                            n.lost[0], NO_LIMIT, NO_LIMIT, "none"});
  stress_print(s, (stress_row){"leaks: vertices of slivers", n.tried[1],
                               n.lost[1], NO_LIMIT, NO_LIMIT, "none"});
  arena_free(&mem);
}
