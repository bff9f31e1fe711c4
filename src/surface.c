// surface.c — the trick: the barycentric point is computed in double, so the
// only error that counts is its last rounding to float; and the ray test
// decides in double on which side of a facet a ray starts.  An origin only has
// to be on the right side, by however little, at any scale.

#include "surface.h"

#include <float.h>

// A point or a vector between the exact floats of the mesh and the rounded
// ones of the surface.
typedef struct point64 {
  double x, y, z;
} point64;

// The hit triangle: corners, weights (their sum is 1), unit normals at the
// corners, and a vector along the normal of the facet, of any length.
typedef struct hit_facet {
  vec3 p[3], n[3];
  double b[3];
  point64 normal;
  bool smooth;  // some corner has a normal of its own
} hit_facet;

static point64 point64_of(vec3 a) {
  return (point64){(double)a.x, (double)a.y, (double)a.z};
}

// a + s b.
static point64 point64_mad(point64 a, double s, point64 b) {
  return (point64){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static double point64_dot(point64 a, point64 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

static vec3 point64_round(point64 a) {
  return (vec3){(float)a.x, (float)a.y, (float)a.z};
}

// The normal by the winding.  In float the cross product of a needle is noise
// and that of a tiny triangle underflows; in double neither happens.
static point64 winding_normal(const vec3 p[3]) {
  point64 o = point64_of(p[0]);
  point64 a = point64_mad(point64_of(p[1]), -1, o);
  point64 b = point64_mad(point64_of(p[2]), -1, o);
  return (point64){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z,
                   a.x * b.y - a.y * b.x};
}

// Unit; +z for the zero vector.
static vec3 point64_unit(point64 a) {
  double length = sqrt(point64_dot(a, a));
  if (!(length > 0)) return (vec3){0, 0, 1};
  return point64_round(point64_mad((point64){0, 0, 0}, 1 / length, a));
}

// The unit normals that the file or the smoothing groups give the corners,
// ng where there is none.  When they point away from ng's side as a whole
// they are turned round: the winding decides.
static void corner_normals(hit_facet *f, const mesh *m, uint32_t triangle,
                           vec3 ng) {
  float side = 0;
  for (int i = 0; i < 3; i++) {
    f->n[i] = ng;
    uint32_t k = m->normal_index == NULL
                     ? MESH_NONE
                     : m->normal_index[3 * (size_t)triangle + (size_t)i];
    if (k == MESH_NONE) continue;
    vec3 n = vec3_unit(m->normals[k]);
    if (!(fabsf(vec3_dot(n, n) - 1) < 0.01f)) continue;  // 0, infinite or NaN
    f->n[i] = n;
    f->smooth = true;
    side += vec3_dot(n, ng);
  }
  if (!(side < 0)) return;
  for (int i = 0; i < 3; i++)
    if (f->n[i].x != ng.x || f->n[i].y != ng.y || f->n[i].z != ng.z)
      f->n[i] = vec3_neg(f->n[i]);
}

// Half a unit in the last place of p, and what the sum in double may have
// lost before.
static float rounding_error(float p, float p0, float p1, float p2) {
  float sum = fabsf(p0) + fabsf(p1) + fabsf(p2);
  return fabsf(p) * 0x1.00001p-24f + sum * 0x1p-50f + FLT_TRUE_MIN;
}

// Taken from corner 0, so that the point is in the triangle's plane whatever
// the rounding of b1 and b2.
static point64 facet_point(const hit_facet *f) {
  point64 o = point64_of(f->p[0]);
  point64 a = point64_mad(point64_of(f->p[1]), -1, o);
  point64 b = point64_mad(point64_of(f->p[2]), -1, o);
  return point64_mad(point64_mad(o, f->b[1], a), f->b[2], b);
}

// Steps inwards are this many p_errors long: farther than an origin can be out
// sideways, by the rounding of p, by that of the origin, and by its way off
// the facet where the next facet leans in.
#define INWARD_STEPS 4

// From p towards the middle of the triangle.
static vec3 inward_step(const hit_facet *f, point64 p, vec3 p_error) {
  point64 middle = {0, 0, 0};
  for (int i = 0; i < 3; i++)
    middle = point64_mad(middle, 1.0 / 3, point64_of(f->p[i]));
  point64 way = point64_mad(middle, -1, p);
  double length = sqrt(point64_dot(way, way));
  double step = INWARD_STEPS * (double)(p_error.x + p_error.y + p_error.z);
  double share = step < length ? step / length : 1;
  return point64_round(point64_mad((point64){0, 0, 0}, share, way));
}

// How far the smooth surface is from the facet at p: each corner's tangent
// plane where it is above p, weighted.  side is +1 for the side that the
// normals are on.
static point64 smooth_lift(const hit_facet *f, point64 p, double side) {
  point64 lift = {0, 0, 0};
  if (!f->smooth) return lift;
  for (int i = 0; i < 3; i++) {
    point64 n = point64_of(f->n[i]);
    point64 to_corner = point64_mad(point64_of(f->p[i]), -1, p);
    double height = side * point64_dot(to_corner, n);
    if (height > 0) lift = point64_mad(lift, side * f->b[i] * height, n);
  }
  bool below = !(side * point64_dot(lift, f->normal) > 0);
  return below ? (point64){0, 0, 0} : lift;
}

static vec3 corner_blend(const vec3 a[3], const double b[3]) {
  vec3 sum = vec3_scale(a[0], (float)b[0]);
  sum = vec3_mad(sum, (float)b[1], a[1]);
  return vec3_mad(sum, (float)b[2], a[2]);
}

static hit_facet facet_at(const mesh *m, const hit *h) {
  hit_facet f = {
      .b = {1 - (double)h->b1 - (double)h->b2, (double)h->b1, (double)h->b2}};
  for (size_t i = 0; i < 3; i++)
    f.p[i] = m->positions[m->position_index[3 * (size_t)h->triangle + i]];
  f.normal = winding_normal(f.p);
  return f;
}

static vec3 color_at(const mesh *m, const hit *h) {
  if (m->colors == NULL) return vec3_all(1);
  const double b[3] = {1 - (double)h->b1 - (double)h->b2, (double)h->b1,
                       (double)h->b2};
  vec3 c[3];
  for (size_t i = 0; i < 3; i++)
    c[i] = m->colors[m->position_index[3 * (size_t)h->triangle + i]];
  return corner_blend(c, b);
}

void surface_paint(surface *at, const scene *s, const hit *h) {
  at->uv = scene_uv(s, h);
  at->color = color_at(&s->mesh, h);
  at->material = NULL;
  if (s->material_of != NULL)
    at->material = &s->materials[s->material_of[h->triangle]];
}

surface surface_at(const scene *s, const hit *h, vec3 d) {
  hit_facet f = facet_at(&s->mesh, h);
  surface at = {.triangle = h->triangle, .ng = point64_unit(f.normal)};
  corner_normals(&f, &s->mesh, h->triangle, at.ng);
  at.smooth = f.smooth;
  at.front = point64_dot(f.normal, point64_of(d)) <= 0;
  at.ns = at.ng;
  if (f.smooth) at.ns = surface_lean(corner_blend(f.n, f.b), at.ng);

  point64 p = facet_point(&f);
  at.p = point64_round(p);
  at.p_smooth =
      point64_round(point64_mad(p, 1, smooth_lift(&f, p, at.front ? 1 : -1)));
  at.p_error = (vec3){rounding_error(at.p.x, f.p[0].x, f.p[1].x, f.p[2].x),
                      rounding_error(at.p.y, f.p[0].y, f.p[1].y, f.p[2].y),
                      rounding_error(at.p.z, f.p[0].z, f.p[1].z, f.p[2].z)};

  at.inward = inward_step(&f, p, at.p_error);
  surface_paint(&at, s, h);
  return at;
}
