// triangle.c — the trick: shear space so that the ray is the z axis.  Then
// "does the ray hit?" is "does the triangle hold the origin of the plane?",
// three 2 x 2 determinants whose signs can be had exactly.

#include "triangle.h"

// Below this a product of coordinates may be denormal and have lost digits.
#define SMALLEST_AREA (FLT_MIN * 0x1p24f)

// The corners in shear space, and the three edge functions: e[i] is twice the
// area of the triangle that the origin makes with the edge opposite corner i.
typedef struct sheared {
  float x[3], y[3], z[3];
  float e[3];
} sheared;

// v with its axes turned cyclically, so that axis kz comes last.
static inline vec3 axes_turned(vec3 v, int kz) {
  if (kz == 0) return (vec3){v.y, v.z, v.x};
  if (kz == 1) return (vec3){v.z, v.x, v.y};
  return v;
}

ray_shear ray_shear_of(vec3 d) {
  d = ray_flush(d);
  vec3 a = vec3_abs(d);
  int kz = a.x > a.y ? (a.x > a.z ? 0 : 2) : (a.y > a.z ? 1 : 2);
  vec3 t = axes_turned(d, kz);
  return (ray_shear){kz, t.x / t.z, t.y / t.z, 1 / t.z};
}

// Corner i in shear space.  The same bits whichever triangle asks: two
// triangles that share a corner share its image.
static inline void shear_corner(sheared *c, int i, vec3 p, const ray *r,
                                const ray_shear *s) {
  vec3 a = axes_turned(vec3_sub(p, r->o), s->kz);
  c->x[i] = a.x - s->sx * a.z;
  c->y[i] = a.y - s->sy * a.z;
  c->z[i] = s->sz * a.z;
}

// Whether the three values have no two opposite signs; false for NaN.
static inline bool same_sign(double u, double v, double w) {
  return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

// The edge functions in double: false unless they agree in sign and have a
// sum.  The product of two floats is exact in double, so the sign of each
// difference is the true one, and none loses its first digits.
static bool edges_in_double(const sheared *c, double e[3]) {
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    e[i] =
        (double)c->x[k] * (double)c->y[j] - (double)c->y[k] * (double)c->x[j];
  }
  double det = e[0] + e[1] + e[2];
  return same_sign(e[0], e[1], e[2]) && det != 0 && isfinite(det);
}

// The hit by doubles, for edge functions that are 0 or overflow in float.
static bool hit_in_double(const sheared *c, float t_b1_b2[3]) {
  double e[3];
  if (!edges_in_double(c, e)) return false;
  double det = e[0] + e[1] + e[2];
  double t =
      e[0] * (double)c->z[0] + e[1] * (double)c->z[1] + e[2] * (double)c->z[2];
  t_b1_b2[0] = (float)(t / det);
  t_b1_b2[1] = (float)(e[1] / det);
  t_b1_b2[2] = (float)(e[2] / det);
  return true;
}

// The largest magnitude of three.
static inline float peak_of(const float v[3]) {
  return float_max(fabsf(v[0]), float_max(fabsf(v[1]), fabsf(v[2])));
}

// A bound on the error of t as computed in float.  Source: Pharr, Jakob,
// Humphreys, section 6.8.7.
static float t_error(const sheared *c, float det) {
  const float g2 = 2 * 0x1p-24f, g3 = 3 * 0x1p-24f, g5 = 5.1f * 0x1p-24f;
  float mx = peak_of(c->x), my = peak_of(c->y), mz = peak_of(c->z);
  float dz = g3 * mz, dx = g5 * (mx + mz), dy = g5 * (my + mz);
  float de = 2 * (g2 * mx * my + dy * mx + dx * my);
  return 3 * (g3 * peak_of(c->e) * mz + de * mz + dz * peak_of(c->e)) /
         fabsf(det);
}

// Where the plane of a triangle lies: side = n.(p0 - o), 0 unless its sign is
// certain, and speed = n.d.
typedef struct plane_way {
  double side, speed;
} plane_way;

// In double precision.  Source: the bound, 8 eps times the permanent of the
// determinant, follows Shewchuk 1997.
static plane_way way_to_plane(const ray *r, const vec3 p[3]) {
  double ax = (double)p[0].x - (double)r->o.x,
         bx = (double)p[1].x - (double)p[0].x;
  double ay = (double)p[0].y - (double)r->o.y,
         by = (double)p[1].y - (double)p[0].y;
  double az = (double)p[0].z - (double)r->o.z,
         bz = (double)p[1].z - (double)p[0].z;
  double cx = (double)p[2].x - (double)p[0].x,
         cy = (double)p[2].y - (double)p[0].y;
  double cz = (double)p[2].z - (double)p[0].z;
  double nx = by * cz - bz * cy, ny = bz * cx - bx * cz, nz = bx * cy - by * cx;
  double side = nx * ax + ny * ay + nz * az;
  double bound = 8 * 0x1p-53 *
                 ((fabs(by * cz) + fabs(bz * cy)) * fabs(ax) +
                  (fabs(bz * cx) + fabs(bx * cz)) * fabs(ay) +
                  (fabs(bx * cy) + fabs(by * cx)) * fabs(az));
  double speed =
      nx * (double)r->d.x + ny * (double)r->d.y + nz * (double)r->d.z;
  return (plane_way){fabs(side) > bound ? side : 0, speed};
}

// t again, for one that its error bound cannot tell from 0: n.(p0 - o) / n.d
// in double precision, kept within t +- error, and exactly 0 when the ray
// starts in the plane of the triangle.
static float t_near_zero(const ray *r, const vec3 p[3], float t, float error) {
  plane_way w = way_to_plane(r, p);
  if (w.side == 0) return 0;
  return float_min(float_max((float)(w.side / w.speed), t - error), t + error);
}

bool triangle_ahead(const ray *r, const vec3 p[3]) {
  plane_way w = way_to_plane(r, p);
  bool away = w.side > 0 ? w.speed < 0 : w.speed > 0;
  return w.side != 0 && !away;
}

bool triangle_hit(const ray *r, const ray_shear *s, vec3 p0, vec3 p1, vec3 p2,
                  hit *h) {
  sheared c;
  shear_corner(&c, 0, p0, r, s);
  shear_corner(&c, 1, p1, r, s);
  shear_corner(&c, 2, p2, r, s);
  c.e[0] = c.x[2] * c.y[1] - c.y[2] * c.x[1];
  c.e[1] = c.x[0] * c.y[2] - c.y[0] * c.x[2];
  c.e[2] = c.x[1] * c.y[0] - c.y[1] * c.x[0];
  float u = c.e[0], v = c.e[1], w = c.e[2];
  // Two edge functions of opposite sign are a miss, whatever the third.
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
  float det = u + v + w, t_b1_b2[3];
  // NaN is not sure either: all comparisons with it are false.
  bool sure = fabsf(u) > 0 && fabsf(v) > 0 && fabsf(w) > 0 &&
              fabsf(det) > SMALLEST_AREA && fabsf(det) < INFINITY;
  if (sure) {
    t_b1_b2[0] = (u * c.z[0] + v * c.z[1] + w * c.z[2]) / det;
    t_b1_b2[1] = v / det;
    t_b1_b2[2] = w / det;
  } else if (!hit_in_double(&c, t_b1_b2)) {
    return false;
  }
  float t = t_b1_b2[0], error = t_error(&c, det);
  if (!(fabsf(t) > error)) t = t_near_zero(r, (vec3[3]){p0, p1, p2}, t, error);
  if (!(t > 0 && t >= r->tmin && t <= r->tmax && t < INFINITY)) return false;
  h->t = t;
  h->b1 = t_b1_b2[1];
  h->b2 = t_b1_b2[2];
  return true;
}

bool triangle_weights(const ray *r, const ray_shear *s, const vec3 p[3],
                      double w[3]) {
  sheared c;
  for (int i = 0; i < 3; i++)
    shear_corner(&c, i, p[i], r, s);
  if (!edges_in_double(&c, w)) return false;
  double det = w[0] + w[1] + w[2];
  for (int i = 0; i < 3; i++)
    w[i] /= det;
  return true;
}
