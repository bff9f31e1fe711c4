// vessels.h — closed meshes, and rays from inside of them at points of their
// edges and at their vertices: each must hit something.

#ifndef VESSELS_H
#define VESSELS_H

#include "shapes.h"
#include "wide.h"

// A closed mesh, star-shaped about its centre.
typedef struct vessel {
  shape s;
  vec3 centre, room;  // rays start at centre +- room
} vessel;

// The first are friendly, the others slivers.
enum { VESSELS = 9, VESSELS_FRIENDLY = 6 };

// Spheres of three sizes, about the origin and far away, where floats lie
// 0.0625 apart; an octahedron and a cube, whose faces lie in faces of boxes,
// the corners of its grid exact.
static inline void vessels_friendly(vessel *out, arena *mem) {
  const float sizes[] = {1, 1e-6f, 1e6f};
  const vec3 zero = {0, 0, 0}, far = {1e6f, -1e6f, 1e6f};
  for (int i = 0; i < 3; i++) {
    float r = sizes[i];
    shape ball = shape_moved(shape_sphere(mem, 40), "ball", vec3_all(r), zero);
    out[i] = (vessel){ball, zero, vec3_all(0.5f * r)};
  }
  shape ball = shape_moved(shape_sphere(mem, 12), "far", vec3_all(100), far);
  out[3] = (vessel){ball, far, vec3_all(40)};
  shape octahedron = shape_sphere(mem, 16), cube = shape_sphere(mem, 16);
  octahedron.name = "octahedron";
  cube.name = "cube";
  for (uint32_t i = 0; i < cube.vertices; i++) {
    vec3 *p = &octahedron.positions[i], a = vec3_abs(*p);
    *p = vec3_scale(*p, 1 / (a.x + a.y + a.z));
    cube.positions[i] = vec3_scale(*p, 1 / vec3_peak(vec3_abs(*p)));
  }
  out[4] = (vessel){octahedron, zero, vec3_all(0.3f)};
  out[5] = (vessel){cube, zero, vec3_all(0.9f)};
}

// Spheres stretched 1e7 times along an axis, flattened as much, and stretched
// along a diagonal, where floats allow 1e5.
static inline void vessels_slivers(vessel *out, arena *mem) {
  const vec3 thin = {1, 1, 1e7f}, flat = {1, 1e-7f, 1}, zero = {0, 0, 0};
  shape s = shape_moved(shape_sphere(mem, 20), "needle", thin, zero);
  out[0] = (vessel){s, zero, vec3_scale(thin, 0.4f)};
  s = shape_moved(shape_sphere(mem, 20), "disc", flat, zero);
  out[1] = (vessel){s, zero, vec3_scale(flat, 0.4f)};
  s = shape_sphere(mem, 20);
  s.name = "diagonal needle";
  for (uint32_t i = 0; i < s.vertices; i++) {
    vec3 p = s.positions[i];
    s.positions[i] = vec3_add(p, vec3_all(1e5f * (p.x + p.y + p.z)));
  }
  out[2] = (vessel){s, zero, zero};
}

static inline void vessels_all(vessel out[VESSELS], arena *mem) {
  vessels_friendly(out, mem);
  vessels_slivers(out + VESSELS_FRIENDLY, mem);
}

// What is poured: rays a batch, and the trees that are asked.
enum { VESSEL_BATCH = 8192 };
typedef struct vessel_flow {
  const vessel *v;
  bvh binary;
  wide_tree wide;
  tracer many;  // of the wide tree
  uint64_t seed;
  bool both;        // ask the binary tree, too
  uint32_t *leaks;  // of each batch: even ones aim at edges, odd at vertices
} vessel_flow;

// A vertex, or a point of an edge, rounded to floats.
static inline vec3 vessel_aim(const shape *s, bool vertex, uint64_t *state) {
  uint32_t t = (uint32_t)(shape_random(state) * (float)s->triangles);
  uint32_t side = (uint32_t)(shape_random(state) * 3);
  const uint32_t *v = s->index + 3 * (size_t)(t < s->triangles ? t : 0);
  vec3 a = s->positions[v[side % 3]], b = s->positions[v[(side + 1) % 3]];
  return vertex ? a : vec3_lerp(a, b, shape_random(state));
}

static inline void vessel_try(void *context, size_t item, int worker) {
  (void)worker;
  vessel_flow *f = context;
  const vessel *v = f->v;
  uint64_t state = f->seed + UINT64_C(0x9e3779b97f4a7c15) * (item + 1);
  ray rays[VESSEL_BATCH];
  hit hits[VESSEL_BATCH];
  for (int i = 0; i < VESSEL_BATCH; i++) {
    vec3 o = vec3_add(v->centre, vec3_mul(v->room, shape_point(&state)));
    rays[i] = ray_from(o, vec3_sub(vessel_aim(&v->s, item % 2, &state), o));
  }
  f->many.closest_many(&f->wide, rays, NULL, hits, VESSEL_BATCH);
  f->leaks[item] = 0;
  for (int i = 0; i < VESSEL_BATCH; i++) {
    hit h;
    bool lost = hits[i].triangle == HIT_NONE;
    if (f->both) lost = lost || !bvh_closest(&f->binary, &rays[i], &h);
    f->leaks[item] += lost;
  }
}

// Rays tried and lost, at edges and at vertices.
typedef struct vessel_losses {
  double tried[2], lost[2];
} vessel_losses;

// Pour at least that many rays at edges and as many at vertices, and add what
// came of it to sum.
static inline void vessel_pour(vessel_losses *sum, const vessel *v, size_t rays,
                               uint64_t seed, bool both, pool *threads) {
  arena mem = {0};
  const shape *s = &v->s;
  size_t batches = 2 * (rays / VESSEL_BATCH + 1);
  vessel_flow f = {.v = v, .seed = seed, .both = both};
  f.leaks = ARENA_NEW(&mem, uint32_t, batches);
  bvh_build(&f.binary, s->positions, s->index, s->triangles, BVH_SAH, &mem,
            threads);
  wide_tree_build(&f.wide, &f.binary, &mem, threads);
  f.many = wide_tracer(&f.wide);
  sum->lost[0] += f.binary.dropped;  // a hole
  pool_run(threads, batches, vessel_try, &f);
  for (size_t i = 0; i < batches; i++) {
    sum->tried[i % 2] += VESSEL_BATCH;
    sum->lost[i % 2] += f.leaks[i];
  }
  arena_free(&mem);
}

#endif
