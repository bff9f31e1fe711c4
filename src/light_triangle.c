// light_triangle.c

#include "light_triangle.h"

#include "num.h"

bool light_triangle_of(light_triangle *out, vec3 a, vec3 b, vec3 c) {
  light_triangle t = {.a = a, .ab = vec3_sub(b, a), .ac = vec3_sub(c, a)};
  vec3 cross = vec3_cross(t.ab, t.ac);
  float twice = vec3_length(cross);
  t.area = 0.5f * twice;
  t.n = vec3_unit(cross);
  t.middle = vec3_mad(vec3_mad(a, 1.0f / 3, t.ab), 1.0f / 3, t.ac);
  float r = vec3_length(vec3_sub(a, t.middle));
  r = float_max(r, vec3_length(vec3_sub(b, t.middle)));
  t.radius = float_max(r, vec3_length(vec3_sub(c, t.middle)));
  *out = t;
  float n2 = vec3_dot(t.n, t.n);
  return t.area > 0 && isfinite(t.area) && isfinite(t.radius) &&
         fabsf(n2 - 1) < 1e-3f;
}

float light_triangle_height(const light_triangle *t, vec3 p) {
  float height = vec3_dot(t->n, vec3_sub(p, t->a));
  return height > LIGHT_LEAST_HEIGHT * t->radius ? height : 0;
}

static bool is_far(const light_triangle *t, vec3 p) {
  vec3 d = vec3_sub(t->middle, p);
  return vec3_dot(d, d) >
         LIGHT_FAR_RADII * LIGHT_FAR_RADII * t->radius * t->radius;
}

static float area_pdf(const light_triangle *t, vec3 d, float height) {
  float d2 = vec3_dot(d, d);
  return d2 * sqrtf(d2) / (t->area * height);
}

// The triangle as seen from a point: unit directions to the corners, the
// distances, and the solid angle with the terms of its tangent.
typedef struct view {
  vec3 to[3];
  float far[3];
  float volume, pairs, one_pair;
  float angle;
} view;

// tan(angle / 2) = |a . (b x c)| / (1 + a.b + b.c + c.a) for unit a, b, c.  The
// volume comes from height and area, which lose no digits where the triangle
// is small.  Source: Van Oosterom and Strackee 1983.
static view view_of(const light_triangle *t, vec3 p, float height) {
  view v;
  vec3 a = vec3_sub(t->a, p);
  vec3 d[3] = {a, vec3_add(a, t->ab), vec3_add(a, t->ac)};
  for (int i = 0; i < 3; i++) {
    v.far[i] = vec3_length(d[i]);
    v.to[i] = vec3_scale(d[i], 1 / v.far[i]);
  }
  v.volume = 2 * t->area * height / (v.far[0] * v.far[1] * v.far[2]);
  v.pairs = vec3_dot(v.to[0], v.to[2]) + vec3_dot(v.to[1], v.to[2]);
  v.one_pair = 1 + vec3_dot(v.to[0], v.to[1]);
  v.angle = 4 * PI * num_turns(v.volume, v.pairs + v.one_pair);
  return v;
}

// Uniform in solid angle: move corner c along the edge from a until a share u1
// of the angle is left, then go from b towards it.  Sets k to the weights of
// the unit directions to the corners.  What is moved may lie opposite of b when
// p is on the triangle, but for rounding.  Source: Peters 2021, "BRDF
// Importance Sampling for Polygonal Lights", section 4 (after Arvo 1995).
static void sample_angle(const view *v, float u1, float u2, float k[3]) {
  vec2 half = num_circle(0.25f / PI * v->angle * u1);
  float ka = v->volume * half.x - v->pairs * half.y;
  float kc = v->one_pair * half.y;
  vec3 way = vec3_mad(vec3_scale(v->to[0], ka), kc, v->to[2]);
  float turn = 2 * vec3_dot(v->to[0], way) / vec3_dot(way, way);
  ka = turn * ka - 1;
  kc = turn * kc;
  vec3 moved = vec3_mad(vec3_scale(v->to[0], ka), kc, v->to[2]);
  vec3 step = vec3_sub(v->to[1], moved);
  float drop = 0.5f * vec3_dot(step, step);  // 1 - b . moved
  float low = u2 * drop;                     // 1 - b . result
  float share = sqrtf(u2 * (2 - low) / float_max(2 - drop, 1e-6f));
  k[0] = share * ka;
  k[1] = 1 - low - share * (1 - drop);
  k[2] = share * kc;
}

// Uniform in area.  Source: Heitz 2019, "A Low-Distortion Map Between Triangle
// and Square".
static void sample_area(float u1, float u2, float k[3]) {
  if (u2 > u1) {
    u1 *= 0.5f;
    u2 -= u1;
  } else {
    u2 *= 0.5f;
    u1 -= u2;
  }
  k[0] = 1 - u1 - u2;
  k[1] = u1;
  k[2] = u2;
}

bool light_triangle_sample(const light_triangle *t, vec3 p, float u1, float u2,
                           light_point *out) {
  float k[3], height = light_triangle_height(t, p), angle = 0;
  if (!(height > 0)) return false;
  if (is_far(t, p))
    sample_area(u1, u2, k);
  else {
    view v = view_of(t, p, height);
    sample_angle(&v, u1, u2, k);
    for (int i = 0; i < 3; i++)
      k[i] = float_max(k[i], 0) / v.far[i];
    angle = v.angle;
  }
  float sum = k[0] + k[1] + k[2];
  light_point q = {.b = k[1] / sum, .c = k[2] / sum};
  q.at = vec3_mad(vec3_mad(t->a, q.b, t->ab), q.c, t->ac);
  vec3 d = vec3_sub(q.at, p);
  q.wi = vec3_unit(d);
  q.pdf = angle > 0 ? 1 / angle : area_pdf(t, d, height);
  *out = q;
  return q.pdf > 0 && isfinite(q.pdf) && vec3_finite(q.at);
}

float light_triangle_pdf(const light_triangle *t, vec3 p, vec3 q) {
  float height = light_triangle_height(t, p);
  if (!(height > 0)) return 0;
  if (is_far(t, p)) {
    float pdf = area_pdf(t, vec3_sub(q, p), height);
    return isfinite(pdf) ? pdf : 0;
  }
  float angle = view_of(t, p, height).angle;
  return angle > 0 ? 1 / angle : 0;
}
