// rays_make.c — the rays that tracers are measured with.
//
// Made in double precision, from random numbers that depend on the kind and
// the ray's index alone.

#include "rays.h"

#include "num.h"

#include <stdint.h>

// The sets' sizes unless the caller says otherwise, the side of a tile of
// primary rays, and the ao rays of one hit.
enum { RAYS_SIZE = 1024, RAYS_LIMIT = 1 << 20, TILE_SIDE = 16, AO_RAYS = 16 };

// A vector in double precision, for places and directions before rounding.
typedef struct dvec {
  double x, y, z;
} dvec;

static dvec dvec_of(vec3 v) {
  return (dvec){(double)v.x, (double)v.y, (double)v.z};
}

static dvec dvec_mad(dvec a, double s, dvec b) {
  return (dvec){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static double dvec_dot(dvec a, dvec b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

static dvec dvec_cross(dvec a, dvec b) {
  return (dvec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z,
                a.x * b.y - a.y * b.x};
}

static dvec dvec_unit(dvec a) {
  double s = 1 / sqrt(dvec_dot(a, a));
  return (dvec){s * a.x, s * a.y, s * a.z};
}

// Number k of stream s: the finaliser of MurmurHash3 (Appleby, public domain)
// over both.
static uint64_t hash_of(uint64_t s, uint64_t k) {
  uint64_t z = k * UINT64_C(0x9e3779b97f4a7c15) + s + 1;
  for (int round = 0; round < 2; round++) {
    z = (z ^ (z >> 33)) * UINT64_C(0xff51afd7ed558ccd);
    z = (z ^ (z >> 33)) * UINT64_C(0xc4ceb9fe1a85ec53);
  }
  return z ^ (z >> 33);
}

// The same as a number in [0, 1).
static double uniform(uint64_t s, uint64_t k) {
  return (double)(hash_of(s, k) >> 11) * 0x1p-53;
}

// The streams: one a purpose.
enum { STREAM_PIXEL = 1, STREAM_AO, STREAM_BOUNCE, STREAM_SHUFFLE, STREAM_BOX };

// A ray from o along d, of unit length after rounding but for a few ulps.
static ray ray_of_doubles(dvec o, dvec d, float tmax) {
  d = dvec_unit(d);
  return (ray){{(float)o.x, (float)o.y, (float)o.z},
               {(float)d.x, (float)d.y, (float)d.z},
               0,
               tmax};
}

// The box of the mesh: its low corner, its extent, its diagonal.
typedef struct ray_frame {
  dvec lo, extent;
  double diagonal;
} ray_frame;

static bool frame_of(ray_frame *f, const mesh *m) {
  vec3 lo, hi;
  mesh_bounds(m, &lo, &hi);
  if (!(lo.x <= hi.x)) return false;
  f->lo = dvec_of(lo);
  f->extent = dvec_mad(dvec_of(hi), -1, f->lo);
  f->diagonal = sqrt(dvec_dot(f->extent, f->extent));
  return true;
}

// The camera looks at the middle of the box from 0.75 r / tan(fov / 2) along
// (0.4, 0.3, 1), r half the diagonal, fov 40 degrees, +y up.
static void primary_rays(ray_set *out, const ray_frame *f, int size) {
  const double tan_half = 0.36397023426620234;
  dvec look = dvec_mad(f->lo, 0.5, f->extent);
  dvec back = dvec_unit((dvec){0.4, 0.3, 1});
  dvec eye = dvec_mad(look, 0.375 * f->diagonal / tan_half, back);
  dvec right = dvec_unit(dvec_cross((dvec){0, 1, 0}, back));
  dvec up = dvec_cross(back, right);
  uint64_t side = (uint64_t)size, tiles = (side + TILE_SIDE - 1) / TILE_SIDE;
  for (uint64_t tile = 0; tile < tiles * tiles; tile++) {
    for (uint64_t i = 0; i < TILE_SIDE * TILE_SIDE; i++) {
      uint64_t px = tile % tiles * TILE_SIDE + i % TILE_SIDE;
      uint64_t py = tile / tiles * TILE_SIDE + i / TILE_SIDE;
      if (px >= side || py >= side) continue;
      uint64_t k = 2 * (py * side + px);
      double x = ((double)px + uniform(STREAM_PIXEL, k)) / size * 2 - 1;
      double y = 1 - ((double)py + uniform(STREAM_PIXEL, k + 1)) / size * 2;
      dvec d = dvec_mad((dvec){0, 0, 0}, -1, back);
      d = dvec_mad(dvec_mad(d, x * tan_half, right), y * tan_half, up);
      out->rays[out->count++] = ray_of_doubles(eye, d, INFINITY);
    }
  }
}

// Between two uniform points of the box.
static void random_rays(ray_set *out, const ray_frame *f, size_t n) {
  for (size_t i = 0; i < n; i++) {
    dvec p[2];
    for (size_t k = 0; k < 2; k++) {
      double u[3];
      for (size_t j = 0; j < 3; j++)
        u[j] = uniform(STREAM_BOX, 6 * i + 3 * k + j);
      p[k] = (dvec){f->lo.x + u[0] * f->extent.x, f->lo.y + u[1] * f->extent.y,
                    f->lo.z + u[2] * f->extent.z};
    }
    dvec d = dvec_mad(p[1], -1, p[0]);
    if (!(dvec_dot(d, d) > 0)) d = (dvec){1, 0, 0};
    out->rays[out->count++] = ray_of_doubles(p[0], d, INFINITY);
  }
}

// A point where secondary rays start, and the normal on the side they go.
typedef struct ray_start {
  dvec p, n;
} ray_start;

// Where ray r hit the mesh, moved 1e-5 diagonals off the triangle towards the
// ray's origin; false when it missed or the triangle has no normal.
static bool start_of_hit(ray_start *s, const ray *r, const hit *h,
                         const ray_source *from, double diagonal) {
  if (h->triangle == HIT_NONE) return false;
  const uint32_t *v = from->m->position_index + 3 * (size_t)h->triangle;
  const vec3 *p = from->m->positions;
  dvec a = dvec_of(p[v[0]]), d = dvec_of(r->d);
  dvec n = dvec_cross(dvec_mad(dvec_of(p[v[1]]), -1, a),
                      dvec_mad(dvec_of(p[v[2]]), -1, a));
  if (!(dvec_dot(n, n) > 0)) return false;
  n = dvec_unit(n);
  s->n = dvec_dot(n, d) > 0 ? dvec_mad((dvec){0, 0, 0}, -1, n) : n;
  s->p = dvec_mad(dvec_of(r->o), (double)h->t, d);
  s->p = dvec_mad(s->p, 1e-5 * diagonal, s->n);
  return true;
}

// A direction about n with density cos / pi, from numbers k and k + 1 of a
// stream.
static dvec cosine_direction(dvec n, uint64_t stream, uint64_t k) {
  double r2 = uniform(stream, k), r = sqrt(r2);
  vec2 c = num_circle((float)uniform(stream, k + 1));
  dvec other = fabs(n.x) > 0.5 ? (dvec){0, 1, 0} : (dvec){1, 0, 0};
  dvec t = dvec_unit(dvec_cross(n, other)), b = dvec_cross(n, t);
  dvec d = dvec_mad((dvec){0, 0, 0}, r * (double)c.x, t);
  return dvec_mad(dvec_mad(d, r * (double)c.y, b), sqrt(1 - r2), n);
}

// `each` rays from every stride-th start, stride the smallest that keeps to
// the limit.
static void secondary_rays(ray_set *out, const ray_start *starts, size_t n,
                           size_t each, size_t limit) {
  uint64_t stream = each > 1 ? STREAM_AO : STREAM_BOUNCE;
  size_t stride = (n * each + limit - 1) / limit;
  for (size_t i = 0; i<n; i += stride> 0 ? stride : 1) {
    for (size_t k = 0; k < each; k++) {
      dvec d = cosine_direction(starts[i].n, stream, 2 * (i * each + k));
      out->rays[out->count++] = ray_of_doubles(starts[i].p, d, INFINITY);
    }
  }
}

// Fisher and Yates, so that neighbours in the set are strangers in the mesh.
static void shuffle_rays(ray_set *s) {
  for (size_t i = s->count; i > 1; i--) {
    size_t j = (size_t)(hash_of(STREAM_SHUFFLE, i) % i);
    ray r = s->rays[i - 1];
    s->rays[i - 1] = s->rays[j];
    s->rays[j] = r;
  }
}

// The kinds that start where primary rays end.
static void rays_from_hits(ray_set *out, ray_kind kind, const ray_source *from,
                           const ray_frame *f, const ray_set *primary) {
  arena scratch = {0};
  size_t n = 0, limit = from->limit > 0 ? from->limit : RAYS_LIMIT;
  hit *hits = ARENA_NEW(&scratch, hit, primary->count);
  ray_start *starts = ARENA_NEW(&scratch, ray_start, primary->count);
  rays_trace(hits, primary, from->tree, from->threads, 0);
  for (size_t i = 0; i < primary->count; i++)
    n += start_of_hit(&starts[n], &primary->rays[i], &hits[i], from,
                      f->diagonal);
  secondary_rays(out, starts, n, kind == RAYS_BOUNCE ? 1 : AO_RAYS, limit);
  out->any = kind != RAYS_BOUNCE;
  if (kind == RAYS_BOUNCE) shuffle_rays(out);
  for (size_t i = 0; kind == RAYS_AOD && i < out->count; i++)
    out->rays[i].tmax = (float)(0.1 * f->diagonal);
  arena_free(&scratch);
}

void rays_generate(ray_set *out, ray_kind kind, const ray_source *from,
                   arena *mem) {
  ray_frame f;
  *out = (ray_set){0};
  if (!frame_of(&f, from->m)) return;
  size_t limit = from->limit > 0 ? from->limit : RAYS_LIMIT;
  int size = from->size > 0 ? from->size : RAYS_SIZE;
  size_t pixels = (size_t)size * (size_t)size;
  if (kind == RAYS_PRIMARY) {
    out->rays = ARENA_NEW(mem, ray, pixels);
    primary_rays(out, &f, size);
  } else if (kind == RAYS_RANDOM) {
    out->rays = ARENA_NEW(mem, ray, limit);
    random_rays(out, &f, limit);
  } else {
    arena scratch = {0};
    ray_set primary = {.rays = ARENA_NEW(&scratch, ray, pixels)};
    primary_rays(&primary, &f, size);
    size_t each = kind == RAYS_BOUNCE ? 1 : AO_RAYS;
    out->rays = ARENA_NEW(mem, ray, limit + each);
    rays_from_hits(out, kind, from, &f, &primary);
    arena_free(&scratch);
  }
}
