// vec.h — points, directions and colours as three floats.
//
// Every function is pure and inline.

#ifndef VEC_H
#define VEC_H

#include "scalar.h"

#include <math.h>
#include <stdbool.h>

#define PI 3.14159265f

// Three floats: a point or direction in world units, or linear RGB.
typedef struct vec3 {
  float x, y, z;
} vec3;

// Two floats: a point of the texture plane or of the image plane.
typedef struct vec2 {
  float x, y;
} vec2;

// The vector whose three components are s.
static inline vec3 vec3_all(float s) {
  return (vec3){s, s, s};
}

static inline vec3 vec3_add(vec3 a, vec3 b) {
  return (vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline vec3 vec3_sub(vec3 a, vec3 b) {
  return (vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

// Componentwise product: light of colour b seen through a filter a.
static inline vec3 vec3_mul(vec3 a, vec3 b) {
  return (vec3){a.x * b.x, a.y * b.y, a.z * b.z};
}

static inline vec3 vec3_scale(vec3 a, float s) {
  return (vec3){a.x * s, a.y * s, a.z * s};
}

static inline vec3 vec3_neg(vec3 a) {
  return (vec3){-a.x, -a.y, -a.z};
}

// a + s b, the step along a ray.
static inline vec3 vec3_mad(vec3 a, float s, vec3 b) {
  return (vec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

// (1 - t) a + t b.
static inline vec3 vec3_lerp(vec3 a, vec3 b, float t) {
  return vec3_add(vec3_scale(a, 1 - t), vec3_scale(b, t));
}

static inline float vec3_dot(vec3 a, vec3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline vec3 vec3_cross(vec3 a, vec3 b) {
  return (vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z,
                a.x * b.y - a.y * b.x};
}

static inline float vec3_length(vec3 a) {
  return sqrtf(vec3_dot(a, a));
}

// vec3_unit of a vector whose square leaves the range of a float: scaled first,
// so that neither 1e-30 nor 1e30 loses its direction.
static inline vec3 vec3_unit_scaled(vec3 a) {
  float m = float_max(fabsf(a.x), float_max(fabsf(a.y), fabsf(a.z)));
  if (!(m > 0) || isinf(m)) return a;
  vec3 s = {a.x / m, a.y / m, a.z / m};
  return vec3_scale(s, 1 / vec3_length(s));
}

// a / |a|, or a itself when its length is 0 or not finite.
static inline vec3 vec3_unit(vec3 a) {
  float square = vec3_dot(a, a);
  if (square > 0x1p-90f && square < 0x1p120f)
    return vec3_scale(a, 1 / sqrtf(square));
  return vec3_unit_scaled(a);
}

static inline vec3 vec3_min(vec3 a, vec3 b) {
  return (vec3){float_min(a.x, b.x), float_min(a.y, b.y), float_min(a.z, b.z)};
}

static inline vec3 vec3_max(vec3 a, vec3 b) {
  return (vec3){float_max(a.x, b.x), float_max(a.y, b.y), float_max(a.z, b.z)};
}

static inline vec3 vec3_abs(vec3 a) {
  return (vec3){fabsf(a.x), fabsf(a.y), fabsf(a.z)};
}

// Component 0, 1 or 2.
static inline float vec3_axis(vec3 a, int axis) {
  return axis == 0 ? a.x : axis == 1 ? a.y : a.z;
}

// The largest component.
static inline float vec3_peak(vec3 a) {
  return float_max(a.x, float_max(a.y, a.z));
}

// Whether every component is finite.
static inline bool vec3_finite(vec3 a) {
  return isfinite(a.x) && isfinite(a.y) && isfinite(a.z);
}

#endif
