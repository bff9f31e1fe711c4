// kernel.c — everything that a path of chapter 9 is made of, as one piece.
//
// Compiled twice.  With KERNEL_DOUBLE every float of it is a double, and the
// functions of num.c, which count the bits of floats, are the library's.  The
// Makefile hides all names but one, so that both fit into one program.

#include "kernel.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

// One piece sees names that the pieces do not.
#pragma GCC diagnostic ignored "-Wshadow"

#ifdef KERNEL_DOUBLE
#pragma GCC diagnostic ignored "-Wdouble-promotion"
#ifdef __clang__
#pragma GCC diagnostic ignored "-Wkeyword-macro"
#endif
#define float double
#define sqrtf sqrt
#define fabsf fabs
#define floorf floor
#define fmaxf fmax
#define fminf fmin
#define copysignf copysign
#define nextafterf nextafter
#define KERNEL kernel_double
#else
#define KERNEL kernel_float
#endif

// Nothing here has textures.
#define scene_uv kernel_uv

#include "../../src/surface.c"
#include "../../src/surface_normal.c"
#include "../../src/surface_ray.c"
#include "../../src/triangle.c"
#ifndef KERNEL_DOUBLE
#include "../../src/num.c"
#else
#include "num.h"
#endif
#include "../../src/bsdf.c"
#include "../../src/bsdf_rough.c"
#include "../../src/dfg.c"
#include "../../src/env.c"
#include "../../src/matter.c"
#include "../../src/microfacet.c"
#include "../../src/path_naive.c"
#include "../../src/vertex.c"

vec2 kernel_uv(const scene *s, const hit *h) {
  (void)s;
  (void)h;
  return (vec2){0, 0};
}

#ifdef KERNEL_DOUBLE
#define TWO_PI 6.283185307179586

vec2 num_circle(float u) {
  return (vec2){cos(TWO_PI * u), sin(TWO_PI * u)};
}

float num_log2(float x) {
  return log2(x);
}

float num_exp2(float x) {
  return exp2(x);
}

float num_pow(float x, float y) {
  return pow(x, y);
}

float num_turns(float y, float x) {
  float t = atan2(y, x) / TWO_PI;
  return t < 0 ? t + 1 : t;
}

float num_acos_pi(float x) {
  return 2 * acos(x) / TWO_PI;
}
#endif

// The list of all triangles as a tracer.
static bool list_closest(const void *tree, const ray *r, hit *h) {
  const mesh *m = tree;
  ray_shear shear = ray_shear_of(r->d);
  ray left = *r;
  bool found = false;
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *v = m->position_index + 3 * t;
    if (!triangle_hit(&left, &shear, m->positions[v[0]], m->positions[v[1]],
                      m->positions[v[2]], h))
      continue;
    left.tmax = h->t;
    h->triangle = (uint32_t)t;
    found = true;
  }
  return found;
}

static bool list_any(const void *tree, const ray *r) {
  hit h;
  return list_closest(tree, r, &h);
}

// Room for the scene, whose triangles have normals of their own or none.
enum { ROOM = 2000 };
typedef struct room {
  scene s;
  material materials[5];
} room;

static void add_triangle(room *k, const vec3 p[3], bool smooth, vec3 centre,
                         uint32_t of) {
  mesh *m = &k->s.mesh;
  for (size_t i = 0; i < 3; i++) {
    size_t at = 3 * m->triangle_count + i;
    m->positions[at] = p[i];
    m->normals[at] = vec3_unit(vec3_sub(p[i], centre));
    m->position_index[at] = (uint32_t)at;
    m->normal_index[at] = smooth ? (uint32_t)at : MESH_NONE;
  }
  k->s.material_of[m->triangle_count++] = of;
}

// The parallelogram at o, front along u x v.
static void add_quad(room *k, vec3 o, vec3 u, vec3 v, uint32_t of) {
  vec3 a = vec3_add(o, u), b = vec3_add(a, v), c = vec3_add(o, v);
  add_triangle(k, (vec3[3]){o, a, b}, false, o, of);
  add_triangle(k, (vec3[3]){o, b, c}, false, o, of);
}

// An octahedron whose faces are cut into 4 x 4 and pushed out.
static void add_ball(room *k, vec3 centre, float radius, uint32_t of) {
  enum { N = 4 };
  for (int f = 0; f < 8; f++) {
    float sx = f & 1 ? -1 : 1, sy = f & 2 ? -1 : 1, sz = f & 4 ? -1 : 1;
    bool turned = sx * sy * sz < 0;
    for (int i = 0; i < N; i++)
      for (int j = 0; j < N - i; j++)
        for (int half = 0; half < 2 && j + half < N - i; half++) {
          vec3 p[3];
          for (int c = 0; c < 3; c++) {
            int x = i + (half ? c != 0 : c == 1), y = j;
            y += half ? c != 1 && c != 2 ? 1 : c == 1 ? 0 : 1 : c == 2;
            vec3 q = {sx * (float)x, sy * (float)y, sz * (float)(N - x - y)};
            p[turned ? 2 - c : c] = vec3_mad(centre, radius, vec3_unit(q));
          }
          add_triangle(k, p, true, centre, of);
        }
  }
}

static material material_of(material_kind kind, float kd, float ks) {
  return (material){.name = "",
                    .kind = kind,
                    .kd = {kd, kd, kd},
                    .ks = {ks, ks, ks},
                    .ns = 30,
                    .roughness = 0.4f,
                    .metallic = 1,
                    .d = 1,
                    .ni = 1.5f};
}

// A box with a lamp and four balls: rough metal, mirror, glass, glossy.
static void furnish(room *k, arena *mem) {
  mesh *m = &k->s.mesh;
  m->positions = ARENA_NEW(mem, vec3, 3 * ROOM);
  m->normals = ARENA_NEW(mem, vec3, 3 * ROOM);
  m->position_index = ARENA_NEW(mem, uint32_t, 3 * ROOM);
  m->normal_index = ARENA_NEW(mem, uint32_t, 3 * ROOM);
  k->s.material_of = ARENA_NEW(mem, uint32_t, ROOM);
  k->s.materials = k->materials;
  k->s.material_count = 5;
  k->materials[0] = material_of(MATERIAL_BLINN_PHONG, 0.6f, 0);
  k->materials[1] = material_of(MATERIAL_METAL_ROUGH, 0.8f, 0);
  k->materials[2] = material_of(MATERIAL_MIRROR, 0, 0.9f);
  k->materials[3] = material_of(MATERIAL_GLASS, 1, 1);
  k->materials[4] = material_of(MATERIAL_BLINN_PHONG, 0.3f, 0.4f);
  vec3 x = {5, 0, 0}, y = {0, 3, 0}, z = {0, 0, 7}, o = {-2.5f, 0, -2};
  add_quad(k, o, z, x, 0);
  add_quad(k, vec3_add(o, y), x, z, 0);
  add_quad(k, o, x, y, 0);
  add_quad(k, vec3_add(o, z), y, x, 0);
  add_quad(k, o, y, z, 0);
  add_quad(k, vec3_add(o, x), z, y, 0);
  for (uint32_t i = 0; i < 4; i++)
    add_ball(k, (vec3){1.2f * (float)i - 1.8f, 0.5f, 0}, 0.5f, 1 + i);
  m->position_count = m->normal_count = 3 * m->triangle_count;

  k->s.env = (env){.kind = ENV_NONE, .scale = 1};
}

void KERNEL(const kernel_request *q, double *out) {
  arena mem = {0};
  room *k = ARENA_NEW(&mem, room, 1);
  furnish(k, &mem);
  material lamp = k->materials[0];
  lamp.ke = vec3_all(3);
  material *all = ARENA_NEW(&mem, material, 6);
  memcpy(all, k->materials, sizeof k->materials);
  all[5] = lamp;
  k->s.materials = all;
  k->s.material_count = 6;
  k->s.material_of[2] = 5;
  path_world w = {.scene = &k->s, .max_depth = q->max_depth};
  w.tracer = (tracer){&k->s.mesh, list_closest, list_any, NULL, NULL};
  w.dfg = matter_table(&k->s, PBR_GGX, &mem, NULL);
  path_stats stats = {0};
  for (size_t i = 0; i < q->n; i++) {
    rng r = rng_of(q->seed, q->first + i, 0);
    float u = rng_next(&r) - 0.5f, v = rng_next(&r) - 0.5f;
    ray at =
        ray_from((vec3){0, 1.5f, 4.5f}, vec3_unit((vec3){u, v - 0.2f, -1}));
    out[i] = (double)path_naive_radiance(&w, at, &r, &stats).x;
  }
  arena_free(&mem);
}
